#include "experiments/plan/record.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "experiments/base/csv.h"

namespace caustics {

namespace {

using nlohmann::json;

/// What a value of a record is, where it is there and not null.
enum class Kind { number, count, text, any };

struct Column {
    const char* name;
    const char* pointer;  ///< into record.json
    Kind kind = Kind::number;
};

constexpr Column columns_of_all[] = {
    {"trial", "/trial", Kind::text},
    {"status", "/status", Kind::text},
    {"scene", "/scene/name", Kind::text},
    {"method", "/method/name", Kind::text},
    {"seed", "/seed", Kind::count},
    {"repeat", "/repeat", Kind::count},
    {"threads", "/threads", Kind::count},
    {"isa", "/isa", Kind::text},
    {"photons_emitted", "/counters/photons_emitted"},
    {"photons_stored", "/counters/photons_stored"},
    {"nearest", "/method/parameters/nearest", Kind::any},
    {"alpha", "/swept/alpha", Kind::any},
    {"mesh_resolution", "/swept/mesh_resolution", Kind::any},
    {"polygons", "/scene/polygons"},
    {"beams", "/counters/beams"},
    {"cone_point_tests", "/counters/cone_point_tests"},
    {"beam_point_tests", "/counters/beam_point_tests"},
    {"beam_point_hits", "/counters/beam_point_hits"},
    {"map_bytes", "/memory/map_bytes"},
    {"rss_start_bytes", "/memory/rss_start_bytes"},
    {"peak_rss_bytes", "/memory/peak_rss_bytes"},
    {"parse_s", "/seconds/parse/wall"},
    {"precompute_s", "/seconds/precompute/wall"},
    {"balance_s", "/seconds/balance/wall"},
    {"render_s", "/seconds/render/wall"},
    {"total_s", "/seconds/total/wall"},
    {"cpu_s", "/seconds/total/cpu"},
    {"rmse", "/metrics/rmse"},
    {"relmse", "/metrics/relmse"},
    {"bias", "/metrics/bias"},
    {"variance", "/variance"},
    {"mean_ratio", "/metrics/mean_ratio"},
    {"leak_energy", "/metrics/leak_energy"},
    {"beauty_rmse", "/beauty_rmse"},
    {"unreached_fraction", "/unreached_fraction"},
    {"reference", "/reference/name", Kind::text},
    {"reference_stderr", "/reference/stderr"},
    {"config_hash", "/config_hash", Kind::text},
    {"code_version", "/code_version", Kind::text},
    {"mask_rmse", "/mask_metrics/rmse"},
    {"mask_relmse", "/mask_metrics/relmse"},
    {"mask_mean_ratio", "/mask_metrics/mean_ratio"},
    {"mask_fraction", "/mask_fraction"},
    {"flip", "/flip"},  // which tools/flip_column.py adds
    {"parse_cpu_s", "/seconds/parse/cpu"},
    {"precompute_cpu_s", "/seconds/precompute/cpu"},
    {"balance_cpu_s", "/seconds/balance/cpu"},
    {"render_cpu_s", "/seconds/render/cpu"},
    {"reference_mean", "/reference/mean"},
    {"spp", "/spp", Kind::count},
    {"trees", "/counters/trees"},
    {"trees_binned", "/method/resolved/trees_binned"},
    {"nodes", "/counters/nodes"},
    {"tree_height", "/counters/height"},
    {"casters_with_face_normals", "/method/resolved/casters_with_face_normals"},
    {"flux_share_captured", "/method/resolved/flux_share_captured"},
    {"camera_rays", "/counters/camera_rays"},
    {"gathers", "/counters/gathers"},
    {"gathered_photons", "/counters/gathered_photons"},
    {"used_photons", "/counters/used_photons"},
    {"photons_aimed", "/counters/photons_aimed"},
    {"photons_reflected", "/counters/photons_reflected"},
    {"photons_refracted", "/counters/photons_refracted"},
    {"photons_connected", "/counters/photons_connected"},
    {"empty_gathers", "/counters/empty_gathers"},
    {"receiver_points", "/counters/receiver_points"},
    {"lit_points", "/counters/lit_points"},
    {"picture_hash", "/picture_hash", Kind::text},
    {"elapsed_s", "/elapsed_s"},
    {"finished", "/finished", Kind::text},
    {"host", "/machine/host", Kind::text},
    {"cpu", "/machine/cpu", Kind::text},
    {"load_average", "/load/average"},
    {"other_cores", "/load/other_cores"},
    {"jobs", "/limits/jobs"},
    {"timeout_s", "/limits/timeout_s"},
    {"memory_limit_bytes", "/limits/memory_bytes"},
    {"why_empty", "/why_empty", Kind::text},
    {"message", "/message", Kind::text},
};

constexpr const char* kept_statuses[] = {"done", "failed", "timeout", "unsupported"};

/// Where the columns of every trial are found in a record; built once, for tables are long.
const std::map<std::string, json::json_pointer>& places() {
    static const std::map<std::string, json::json_pointer> all = [] {
        std::map<std::string, json::json_pointer> made;
        for (const Column& column : columns_of_all) made.emplace(column.name, column.pointer);
        return made;
    }();
    return all;
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

std::string cell(const json& value) {
    if (value.is_null()) return {};
    if (value.is_string()) return value.get<std::string>();
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
    for (const Column& column : columns_of_all) {
        const json::json_pointer& place = places().at(column.name);
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
    return std::ranges::any_of(columns_of_all,
                               [&](const Column& column) { return name == column.name; });
}

bool is_swept_column(const std::string& name) {
    return name == "alpha" || name == "mesh_resolution";
}

std::vector<std::string> record_columns(const std::vector<std::string>& swept) {
    std::vector<std::string> names;
    for (const Column& column : columns_of_all) names.emplace_back(column.name);
    for (const std::string& name : swept)
        if (std::ranges::count(names, name) == 0) names.push_back(name);
    return names;
}

std::vector<json> record_row(const json& record, const std::vector<std::string>& columns) {
    std::vector<json> row;
    for (const std::string& name : columns) {
        const auto known = places().find(name);
        const json::json_pointer place =
            known == places().end() ? json::json_pointer("/swept/" + name) : known->second;
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

}  // namespace caustics
