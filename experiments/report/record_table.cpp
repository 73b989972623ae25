#include "experiments/report/record_table.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/base/atomic_file.h"
#include "core/base/hash.h"
#include "core/base/interrupt.h"
#include "experiments/base/csv.h"
#include "experiments/base/file_io.h"
#include "experiments/plan/record.h"
#include "experiments/report/cell_variance.h"
#include "experiments/report/table_index.h"
#include "experiments/report/trial_rows.h"

namespace caustics::experiments {

namespace {

using nlohmann::json;

/// A file that is whole or absent, and the checksum of what is in it.
class SummedFile {
public:
    explicit SummedFile(const std::filesystem::path& file) : file_(file) {}
    void write(const std::string& text) {
        file_.write(text);
        sum_ = fnv1a(text, sum_);
        size_ += text.size();
    }
    std::size_t size() const { return size_; }
    std::string commit() {
        file_.commit();
        return hex(sum_);
    }

private:
    AtomicFile file_;
    std::uint64_t sum_ = fnv1a("");
    std::size_t size_ = 0;
};

DonePictures done_pictures(const TrialRows& rows, const PlanFile& plan) {
    DonePictures done;
    for (const PlanFile::Entry& trial : plan.trials) {
        const std::optional<TableRow> row = rows.row(trial.id);
        if (!row || row->text("status") != "done") continue;
        // "method:key"
        const std::string& reference = row->text("reference");
        done[trial.id] = {row->text("picture_hash"), reference.substr(reference.find(':') + 1)};
    }
    return done;
}

/// Takes out the cells whose pictures cannot be read, so that the next table tries again. A line on
/// them, if there are any.
std::vector<std::string> cells_without(CellVariances& variances) {
    std::string first;
    const std::size_t count = std::erase_if(variances, [&](const auto& cell) {
        if (first.empty()) first = cell.second.unreadable;
        return !cell.second.unreadable.empty();
    });
    if (count == 0) return {};
    return {
        fmt::format("the variance of {} cell{} stays empty, whose pictures are not all there: {}",
                    count, count == 1 ? "" : "s", first)};
}

/// The record that a row is to be made of; its stamp is of the file before it was read.
struct RecordNow {
    std::string stamp;
    std::optional<json> record;
};

RecordNow record_now(const TrialStore& store, const std::string& trial,
                     const std::map<std::string, json>& unfinished) {
    const auto left_nothing = unfinished.find(trial);
    if (left_nothing != unfinished.end()) return {"", left_nothing->second};
    std::string stamp = file_stamp(store.record_of(trial));
    return {stamp, store.record(trial)};
}

}  // namespace

std::vector<std::string> write_records(const std::filesystem::path& folder, const TrialStore& store,
                                       const PlanFile& plan,
                                       const std::map<std::string, json>& unfinished,
                                       const std::function<void(const TableRow& row)>& visit) {
    const TrialRows rows(folder, store);
    if (unfinished.empty() && rows.are_the_table_of(plan)) {
        rows.visit_table(visit);
        return {};
    }

    TableIndex index;
    index.variances = cell_variances(plan, folder, done_pictures(rows, plan), rows.variances());
    std::vector<std::string> lacks = cells_without(index.variances);
    index.complete = unfinished.empty() && lacks.empty() && !interrupt_requested();
    const std::vector<std::string> columns = record_columns(plan.swept);
    SummedFile table(folder / "records.csv");
    SummedFile lines(folder / "records.jsonl");
    table.write(csv_line(columns));
    for (const PlanFile::Entry& trial : plan.trials) {
        RecordNow now = record_now(store, trial.id, unfinished);
        if (!now.record) continue;
        const auto of_cell = index.variances.find(trial.cell);
        if (of_cell != index.variances.end() && of_cell->second.mean &&
            now.record->at("status") == "done")
            (*now.record)["variance"] = *of_cell->second.mean;
        index.rows.push_back({trial.id, now.stamp, table.size()});
        const std::vector<json> row = record_row(*now.record, columns);
        const std::vector<std::string> cells = csv_cells(row);
        table.write(csv_line(cells));
        lines.write(json_line(row, columns));
        visit({columns, cells});
    }
    index.csv = table.commit();
    index.jsonl = lines.commit();
    write_table_index(index, folder);
    return lacks;
}

}  // namespace caustics::experiments
