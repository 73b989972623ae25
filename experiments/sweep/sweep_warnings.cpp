#include "experiments/sweep/sweep_warnings.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "experiments/base/child_process.h"
#include "experiments/plan/plan_file.h"

namespace caustics::experiments {

namespace {

/// "a.json b.json"
std::string sweep_words(const PlanFile& plan) {
    std::string words;
    for (const std::string& sweep : plan.sweeps) words += (words.empty() ? "" : " ") + sweep;
    return words;
}

/// How to get a table of both, where the plan before is one of other sweep files.
std::string earlier_sweep(const SweepPlan& plan, const SweepOptions& options) {
    try {
        const PlanFile before = read_plan_of(options.folder);
        const PlanFile now = plan_file(plan);
        if (before.sweeps == now.sweeps) return {};
        return fmt::format(" (the plan before was of {}; name both for one table)",
                           sweep_words(before));
    } catch (const InputError&) {
        return {};
    }
}

template <typename SomeMethod>
bool is_alike(const SomeMethod& one, const SomeMethod& other) {
    return one.name == other.name && one.name != "none";
}

/// Trials by the reference's method and seed: they may be made of its very light paths, which then err alike.
std::string shared_paths(const SweepPlan& plan) {
    for (const Trial& trial : plan.trials) {
        if (!trial.chosen || !trial.reference) continue;
        const RunRequest& own = trial.request;
        const RunRequest& reference = trial.reference->request;
        if (own.seed != reference.seed) continue;
        const bool in_indirect =
            own.indirect && reference.indirect && is_alike(*own.indirect, *reference.indirect);
        if (in_indirect || is_alike(own.method, reference.method))
            return fmt::format(
                "warning: trials of {} with seed {} share light paths with their reference and "
                "look "
                "better than they are: give \"reference\" a \"seed\" that no trial has",
                in_indirect ? own.indirect->name : own.method.name, reference.seed);
    }
    return {};
}

bool shares_processors(const SweepOptions& options, const SweepStatus& status) {
    if (options.trials.jobs == 1) return false;
    const std::size_t processors = own_processors().size();
    return std::ranges::any_of(status.todo, [&](const Trial* trial) {
        const int wanted = options.trials.jobs * options.trials.threads_of(*trial);
        return static_cast<std::size_t>(wanted) > processors;
    });
}

}  // namespace

std::vector<std::string> sweep_warnings(const SweepPlan& plan, const SweepOptions& options,
                                        const SweepStatus& status, std::size_t others) {
    std::vector<std::string> lines;
    if (others > 0)
        lines.push_back(fmt::format(
            "warning: {} holds {} trials that {} does not name, by other sweeps or by other "
            "scenes: records.csv leaves them out{}",
            options.folder.string(), others, sweep_words(plan_file(plan)),
            earlier_sweep(plan, options)));
    const std::string code = status.code_warning();
    if (!code.empty() && !options.force) lines.push_back("warning: " + code);
    const std::string times = status.times_warning(options);
    if (!times.empty() && !options.force) lines.push_back("warning: " + times);
    if (plan.duplicates > 0)
        lines.push_back(fmt::format(
            "note: the sweep names {} trials more than once; each is run once", plan.duplicates));
    const std::size_t failed = status.count("failed") + status.count("timeout");
    if (failed > 0 && !options.rerun_failed && !options.force)
        lines.push_back(fmt::format(
            "note: {} trials failed or took too long before (--rerun failed runs them again)",
            failed));
    if (std::string shared = shared_paths(plan); !shared.empty())
        lines.push_back(std::move(shared));
    if (shares_processors(options, status))
        lines.push_back(fmt::format(
            "warning: {} trials at a time share {} processors: their times are no measurement",
            options.trials.jobs, own_processors().size()));
    return lines;
}

}  // namespace caustics::experiments
