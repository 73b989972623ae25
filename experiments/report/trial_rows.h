#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "experiments/plan/plan_file.h"
#include "experiments/plan/trial_store.h"
#include "experiments/report/table_index.h"
#include "experiments/report/table_row.h"

namespace caustics::experiments {

/// What the records of a folder's trials say, as rows: taken from the table that an earlier run
/// left where the record is still the file its row was made from, else read from the record. A
/// table that is not the one its index describes is not used.
class TrialRows {
public:
    TrialRows(const std::filesystem::path& folder, const TrialStore& store);
    TrialRows(const TrialRows&) = delete;
    TrialRows& operator=(const TrialRows&) = delete;

    /// The row of a finished trial, with the columns of every trial (`variance` only where the
    /// table has it). Throws InputError when its record is broken.
    std::optional<TableRow> row(const std::string& trial) const;

    /// Whether the tables there are those of a plan, with nothing to add or to change.
    bool are_the_table_of(const PlanFile& plan) const;
    /// Every row of the table as it is there.
    void visit_table(const std::function<void(const TableRow&)>& visit) const;
    /// What the table's cells are known to vary by.
    const CellVariances& variances() const { return index_.variances; }

private:
    TableRow row_at(std::size_t offset) const;
    bool has_rows_of_index() const;

    const TrialStore& store_;
    TableIndex index_;
    std::string csv_;
    std::vector<std::string> columns_;                    ///< of the table
    std::vector<std::string> columns_of_all_;             ///< of a row from a record
    std::map<std::string, const TableIndex::Row*> rows_;  ///< by trial
};

}  // namespace caustics::experiments
