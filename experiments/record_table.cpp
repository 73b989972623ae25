#include "experiments/record_table.h"

#include <nlohmann/json.hpp>

#include "core/whole_file.h"
#include "experiments/cell_variance.h"
#include "experiments/csv.h"
#include "experiments/record.h"

namespace caustics {

namespace {

using nlohmann::json;

bool is_done(const json& record) { return record.value("status", "") == "done"; }

DoneTrials done_trials(const JobStore& store, const PlanFile& plan) {
    DoneTrials done;
    for (const PlanFile::Entry& trial : plan.trials) {
        const std::optional<json> record = store.record(trial.id);
        if (record && is_done(*record)) done[trial.id] = record->value("finished", "");
    }
    return done;
}

}  // namespace

void write_records(const std::filesystem::path& folder, const JobStore& store, const PlanFile& plan,
                   const std::map<std::string, json>& unfinished,
                   const std::function<void(const json& record)>& visit) {
    const std::filesystem::path lines_file = folder / "records.jsonl";
    const std::map<std::string, double> variance =
        cell_variances(plan, store, done_trials(store, plan), lines_file);
    const std::vector<std::string> columns = record_columns(plan.swept);
    WholeFile table(folder / "records.csv");
    WholeFile lines(lines_file);
    table.write(csv_line(columns));
    for (const PlanFile::Entry& trial : plan.trials) {
        std::optional<json> record = store.record(trial.id);
        const auto left_nothing = unfinished.find(trial.id);
        if (left_nothing != unfinished.end()) record = left_nothing->second;
        if (!record) continue;
        const auto of_cell = variance.find(trial.cell);
        if (of_cell != variance.end() && is_done(*record)) (*record)["variance"] = of_cell->second;
        const std::vector<json> row = record_row(*record, columns);
        table.write(csv_line(row));
        lines.write(json_line(row, columns));
        visit(*record);
    }
    table.commit();
    lines.commit();
}

}  // namespace caustics
