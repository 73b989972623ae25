#include "experiments/plan/record.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "experiments/base/csv.h"
#include "experiments/base/number_option.h"
#include "experiments/plan/record_columns.h"

namespace caustics::experiments {

namespace {

using nlohmann::json;

using Kind = RecordColumn::Kind;

constexpr const char* kept_statuses[] = {"done", "failed", "timeout", "unsupported"};

/// Where the columns of every trial are found in a record; built once, for tables are long.
const std::map<std::string, json::json_pointer>& places() {
    static const std::map<std::string, json::json_pointer> all = [] {
        std::map<std::string, json::json_pointer> made;
        for (const RecordColumn& column : record_columns_of_all())
            made.emplace(column.name, column.pointer);
        return made;
    }();
    return all;
}

/// Before the name of a parameter that is another column's, too.
constexpr std::string_view of_method = "method_";

json::json_pointer place_of(const std::string& column, const json& record) {
    if (const auto known = places().find(column); known != places().end()) return known->second;
    const json::json_pointer own("/swept/" + column);
    if (record.contains(own) || !column.starts_with(of_method)) return own;
    return json::json_pointer("/swept/" + column.substr(of_method.size()));
}

bool is_of_kind(const json& value, Kind kind) {
    switch (kind) {
        case Kind::number: return value.is_number();
        case Kind::count: return value.is_number_unsigned();
        case Kind::text: return value.is_string();
        case Kind::any: break;
    }
    return true;
}

const char* name_of(Kind kind) {
    switch (kind) {
        case Kind::number: return "a number";
        case Kind::count: return "a whole number from 0 on";
        case Kind::text: return "text";
        case Kind::any: break;
    }
    return "anything";
}

/// Text that a spreadsheet takes for a formula, which may run commands and read files; or that looks like such a text after it
/// was marked.
bool is_formula(const std::string& text) {
    const std::size_t start = text.find_first_not_of('\'');
    return start != std::string::npos &&
           std::string_view("=+-@\t\r").find(text[start]) != std::string_view::npos &&
           (start > 0 || !decimal<double>(text));
}

std::string cell(const json& value) {
    if (value.is_null()) return {};
    if (value.is_string()) {
        const std::string text = value.get<std::string>();
        return is_formula(text) ? "'" + text : text;
    }
    if (value.is_number_float()) return shortest(value.get<double>());
    return value.dump();
}

}  // namespace

json to_json(const Metrics& metrics) {
    const auto or_null = [](const std::optional<double>& value) {
        return value ? json(*value) : json();
    };
    return {{"rmse", or_null(metrics.rmse)},
            {"relmse", or_null(metrics.relmse)},
            {"bias", or_null(metrics.bias)},
            {"mean_ratio", or_null(metrics.mean_ratio)},
            {"leak_energy", or_null(metrics.leak_energy)},
            {"pixels", metrics.pixels}};
}

std::string flaw_of(const json& record) {
    if (!record.is_object()) return "not a JSON object";
    for (const RecordColumn& column : record_columns_of_all()) {
        const json::json_pointer& place = places().at(column.name);
        const json::json_pointer holder = place.parent_pointer();
        if (record.contains(holder) && !record.at(holder).is_object() &&
            !record.at(holder).is_null())
            return fmt::format("{}: expected an object", holder.to_string());
        if (!record.contains(place) || record.at(place).is_null()) continue;
        if (!is_of_kind(record.at(place), column.kind))
            return fmt::format("{}: expected {}", column.pointer, name_of(column.kind));
    }
    const auto is_status = [&](const char* status) {
        return record.contains("status") && record.at("status") == json(status);
    };
    if (std::ranges::none_of(kept_statuses, is_status))
        return fmt::format("/status: expected one of {}", fmt::join(kept_statuses, ", "));
    return {};
}

bool is_record_column(const std::string& name) {
    return std::ranges::any_of(record_columns_of_all(),
                               [&](const RecordColumn& column) { return name == column.name; });
}

bool is_swept_column(const std::string& name) {
    return name == "alpha" || name == "mesh_resolution";
}

std::string column_of_swept(const std::string& key) {
    const auto known = places().find(key);
    const bool is_taken = known != places().end() && !is_swept_column(key) &&
                          known->second != json::json_pointer("/method/parameters/" + key);
    return is_taken ? std::string(of_method) + key : key;
}

std::vector<std::string> record_columns(const std::vector<std::string>& swept) {
    std::vector<std::string> names;
    for (const RecordColumn& column : record_columns_of_all()) names.emplace_back(column.name);
    for (const std::string& key : swept)
        if (std::ranges::count(names, column_of_swept(key)) == 0)
            names.push_back(column_of_swept(key));
    return names;
}

std::vector<json> record_row(const json& record, const std::vector<std::string>& columns) {
    std::vector<json> row;
    for (const std::string& name : columns) {
        const json::json_pointer place = place_of(name, record);
        row.push_back(record.contains(place) ? record.at(place) : json());
    }
    return row;
}

std::vector<std::string> csv_cells(const std::vector<json>& row) {
    std::vector<std::string> cells;
    for (const json& value : row) cells.push_back(cell(value));
    return cells;
}

std::string json_line(const std::vector<json>& row, const std::vector<std::string>& columns) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i)
        line += (i == 0 ? "{" : ",") + json(columns[i]).dump() + ":" + row[i].dump();
    return line + "}\n";
}

}  // namespace caustics::experiments
