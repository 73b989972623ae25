#include "experiments/report/table_index.h"

#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "experiments/base/bounded_json.h"
#include "experiments/base/environment.h"
#include "experiments/base/file_io.h"

namespace caustics::experiments {

namespace {

using nlohmann::json;

constexpr const char* file_name = ".table";

json index_to_json(const TableIndex& index) {
    json rows = json::array();
    for (const TableIndex::Row& row : index.rows)
        rows.push_back({row.trial, row.record, row.offset});
    json variances = json::object();
    for (const auto& [cell, variance] : index.variances)
        variances[cell] = {variance.pictures, variance.mean ? json(*variance.mean) : json()};
    return {{"code_version", code_version()},
            {"complete", index.complete},
            {"csv", index.csv},
            {"jsonl", index.jsonl},
            {"rows", std::move(rows)},
            {"variances", std::move(variances)}};
}

TableIndex index_from_json(const json& file) {
    TableIndex index;
    for (const json& row : file.at("rows"))
        index.rows.push_back({row.at(0).get<std::string>(), row.at(1).get<std::string>(),
                              row.at(2).get<std::size_t>()});
    for (const auto& [cell, variance] : file.at("variances").items()) {
        CellVariance& known = index.variances[cell];
        known.pictures = variance.at(0).get<std::string>();
        if (!variance.at(1).is_null()) known.mean = variance.at(1).get<double>();
    }
    file.at("complete").get_to(index.complete);
    file.at("csv").get_to(index.csv);
    file.at("jsonl").get_to(index.jsonl);
    return index;
}

}  // namespace

void write_table_index(const TableIndex& index, const std::filesystem::path& folder) {
    write_atomic_file(folder / file_name, index_to_json(index).dump() + "\n");
}

TableIndex read_table_index(const std::filesystem::path& folder) {
    if (!std::filesystem::is_regular_file(folder / file_name)) return {};
    try {
        const json file = parse_bounded(read_whole_file(folder / file_name));
        // Other code may make other rows of the same records.
        if (file.at("code_version") == code_version()) return index_from_json(file);
    } catch (const json::exception&) {
    } catch (const InputError&) {}
    return {};
}

}  // namespace caustics::experiments
