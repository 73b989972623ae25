#include "experiments/report/trial_rows.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/hash.h"
#include "experiments/base/csv.h"
#include "experiments/base/file_io.h"
#include "experiments/plan/record.h"

namespace caustics::experiments {

namespace {

namespace fs = std::filesystem;

/// The content of a file of that checksum; empty when it is not that, or not there.
std::string content_of(const fs::path& file, const std::string& checksum) {
    if (!fs::is_regular_file(file)) return {};
    std::string content = read_whole_file(file);
    return hex(fnv1a(content)) == checksum ? content : std::string();
}

}  // namespace

TrialRows::TrialRows(const fs::path& folder, const TrialStore& store)
    : store_(store), index_(read_table_index(folder)), columns_of_all_(record_columns({})) {
    csv_ = content_of(folder / "records.csv", index_.csv);
    const bool has_lines = !content_of(folder / "records.jsonl", index_.jsonl).empty();
    std::string_view header = csv_;
    columns_ = take_csv_line(header);
    if (csv_.empty() || !has_lines || !has_rows_of_index()) index_ = {};
    for (const TableIndex::Row& row : index_.rows) rows_.emplace(row.trial, &row);
}

/// Whether each line that the index names is there, whole, and of its trial, under the columns of all.
bool TrialRows::has_rows_of_index() const {
    const auto differ = std::ranges::mismatch(columns_of_all_, columns_);
    if (differ.in1 != columns_of_all_.end()) return false;
    return std::ranges::all_of(index_.rows, [&](const TableIndex::Row& row) {
        const bool begins =
            row.offset > 0 && row.offset < csv_.size() && csv_[row.offset - 1] == '\n';
        if (!begins) return false;
        std::string_view line = std::string_view(csv_).substr(row.offset);
        const std::vector<std::string> cells = take_csv_line(line);
        return cells.size() == columns_.size() && cells[0] == row.trial;
    });
}

TableRow TrialRows::row_at(std::size_t offset) const {
    std::string_view line = std::string_view(csv_).substr(offset);
    return {columns_, take_csv_line(line)};
}

std::optional<TableRow> TrialRows::row(const std::string& trial) const {
    const auto known = rows_.find(trial);
    const bool holds = known != rows_.end() && !known->second->record.empty() &&
                       known->second->record == file_stamp(store_.record_of(trial));
    if (holds) return row_at(known->second->offset);
    const std::optional<nlohmann::json> record = store_.record(trial);
    if (!record) return {};
    return TableRow(columns_of_all_, csv_cells(record_row(*record, columns_of_all_)));
}

bool TrialRows::are_the_table_of(const PlanFile& plan) const {
    if (!index_.complete || columns_ != record_columns(plan.swept)) return false;
    auto row = index_.rows.begin();
    for (const PlanFile::Entry& trial : plan.trials) {
        const std::string stamp = file_stamp(store_.record_of(trial.id));
        if (stamp.empty()) continue;
        if (row == index_.rows.end() || row->trial != trial.id || row->record != stamp)
            return false;
        ++row;
    }
    return row == index_.rows.end();
}

void TrialRows::visit_table(const std::function<void(const TableRow&)>& visit) const {
    for (const TableIndex::Row& row : index_.rows) visit(row_at(row.offset));
}

}  // namespace caustics::experiments
