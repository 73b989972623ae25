#include "experiments/sweep/sweep_status.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "experiments/base/environment.h"
#include "experiments/report/trial_rows.h"

namespace caustics::experiments {

namespace {

bool must_run(const std::string& status, const SweepOptions& options) {
    const bool failed = status == "failed" || status == "timeout";
    return status.empty() || options.force || (options.rerun_failed && failed);
}

void take_note(SweepStatus& all, const Trial& trial, const TableRow& row, const TrialStore& store) {
    const std::string& version = row.text("code_version");
    if (version != code_version()) ++all.other_code[version];
    const std::string& status = all.statuses[trial.id] = row.text("status");
    const std::optional<double> seconds = row.number("elapsed_s");
    if (status != "done" || !seconds) return;
    if (const auto mean = row.number("reference_mean")) all.judged_by[trial.id] = *mean;
    if (const auto threads = row.number("threads")) all.threads.insert(static_cast<int>(*threads));
    all.isas.insert(row.text("isa"));
    std::error_code none;
    const auto bytes = std::filesystem::file_size(store.image_of(trial.id), none);
    all.costs.add(trial, {*seconds, none ? 0 : static_cast<double>(bytes)});
}

}  // namespace

std::size_t SweepStatus::count(const std::string& status) const {
    return static_cast<std::size_t>(std::ranges::count_if(share, [&](const Trial* trial) {
        const auto found = statuses.find(trial->id);
        return found != statuses.end() && found->second == status;
    }));
}

std::vector<const ReferenceRequest*> SweepStatus::references(const ReferenceCache& cache) const {
    std::vector<const ReferenceRequest*> missing;
    std::set<std::string> known;
    for (const Trial* trial : todo.empty() && cache.makes_anew() ? share : todo)
        if (trial->reference && known.insert(trial->reference->key).second &&
            cache.must_render(*trial->reference))
            missing.push_back(&*trial->reference);
    return missing;
}

std::optional<Cost> SweepStatus::cost() const {
    Cost sum;
    for (const Trial* trial : todo) {
        const std::optional<Cost> one = costs.of(*trial);
        if (!one) return {};
        sum.seconds += one->seconds;
        sum.bytes += one->bytes;
    }
    return sum;
}

std::string SweepStatus::code_warning() const {
    if (other_code.empty()) return {};
    std::vector<std::string> parts;
    for (const auto& [version, count] : other_code)
        parts.push_back(fmt::format("{} by {}", count, version));
    return fmt::format(
        "results by other code than this program's, {}: {} (--force runs them again)",
        code_version(), fmt::join(parts, ", "));
}

std::string SweepStatus::times_warning(const SweepOptions& options) const {
    if (todo.empty()) return {};
    std::set<int> counts = threads;
    for (const Trial* trial : todo) counts.insert(options.trials.threads_of(*trial));
    std::set<std::string> sets = isas;
    sets.insert(std::string(name(options.trials.isa)));
    std::string differences;
    if (!threads.empty() && counts.size() > 1 && options.trials.threads > 0)
        differences = fmt::format("{} threads", fmt::join(counts, " and "));
    if (sets.size() > 1)
        differences +=
            fmt::format("{}{}", differences.empty() ? "" : ", ", fmt::join(sets, " and "));
    if (differences.empty()) return {};
    return fmt::format(
        "trials of {} are in one table: their times do not compare, and merge refuses several "
        "instruction sets (--threads, --isa; --force runs all again)",
        differences);
}

SweepStatus sweep_status(const SweepPlan& plan, const SweepOptions& options,
                         const TrialStore& store) {
    SweepStatus all;
    const TrialRows rows(options.folder, store);
    for (const Trial& trial : plan.trials) {
        try {
            const std::optional<TableRow> row = rows.row(trial.id);
            if (row) take_note(all, trial, *row, store);
        } catch (const BrokenRecord& error) {
            all.broken[trial.id] = error.what();
        }
    }
    all.share = shard_of(run_order(plan), options.shard);
    for (const Trial* trial : all.share) {
        const auto found = all.statuses.find(trial->id);
        if (must_run(found == all.statuses.end() ? "" : found->second, options))
            all.todo.push_back(trial);
    }
    return all;
}

}  // namespace caustics::experiments
