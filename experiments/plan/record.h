#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "experiments/picture/metrics.h"

namespace caustics::experiments {

/// Of record.json; part of every trial's identity.
inline constexpr int record_version = 1;

/// Metrics by name; null where a formula has no value.
nlohmann::json to_json(const Metrics& metrics);

/// What makes a kept record no record, "/seed: expected ..."; empty when every value that tables show
/// is of its kind and the status is one that is kept.
std::string flaw_of(const nlohmann::json& record);

/// Whether records.csv has a column of that name of its own.
bool is_record_column(const std::string& name);
/// Whether a swept scene value may fill that column (alpha, mesh_resolution).
bool is_swept_column(const std::string& name);

/// The column of a swept key: of a method's parameter whose name is that of another column of every trial (`spp` of
/// `pathtrace`, `polygons` of `beamtree`) "method_KEY".
std::string column_of_swept(const std::string& key);

/// The columns of records.csv: those of every trial, then those of the swept keys that are not among them.
std::vector<std::string> record_columns(const std::vector<std::string>& swept);

/// One row: the values of a record under those columns; null = not applicable.
std::vector<nlohmann::json> record_row(const nlohmann::json& record,
                                       const std::vector<std::string>& columns);
/// The row as cells of records.csv (null = empty; an apostrophe goes before text that a spreadsheet would take
/// for a formula) and as a line of records.jsonl (an object with
/// all columns).
std::vector<std::string> csv_cells(const std::vector<nlohmann::json>& row);
std::string json_line(const std::vector<nlohmann::json>& row,
                      const std::vector<std::string>& columns);

}  // namespace caustics::experiments
