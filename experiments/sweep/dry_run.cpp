#include "experiments/sweep/dry_run.h"

#include <fmt/format.h>

#include <set>

#include "experiments/base/progress.h"
#include "experiments/sweep/sweep_status.h"

namespace caustics::experiments {

namespace {

namespace fs = std::filesystem;

constexpr double megabyte = 1e6;

std::string trials_text(const SweepStatus& status, const SweepOptions& options,
                        std::size_t duplicates) {
    std::string text = fmt::format("{} planned", status.share.size());
    if (options.shard.count > 1)
        text += fmt::format(" in shard {}/{}", options.shard.index, options.shard.count);
    for (const char* each : {"done", "unsupported", "failed", "timeout"})
        if (const std::size_t count = status.count(each); count > 0)
            text += fmt::format(", {} {}", count, each);
    text += fmt::format("; {} to run", status.todo.size());
    return text + (duplicates > 0 ? fmt::format(" ({} more are named twice)", duplicates) : "");
}

std::string time_text(const SweepStatus& status, const SweepOptions& options,
                      const std::optional<Cost>& cost, std::size_t references) {
    if (!cost) return "unknown: no trial has run yet (run a few by --filter)";
    return fmt::format("about {} with {} at a time{}, from {} earlier records{}",
                       clock_text(cost->seconds / options.trials.jobs), options.trials.jobs,
                       references == 0 ? "" : ", and that of the references, which is not known",
                       status.count("done"),
                       status.other_code.empty() ? "" : ", some by other code");
}

/// Free bytes where the folder is or will be.
double free_bytes(fs::path folder) {
    folder = fs::absolute(folder);
    while (!fs::exists(folder)) folder = folder.parent_path();
    return static_cast<double>(fs::space(folder).available);
}

}  // namespace

std::string list_plan(const SweepPlan& plan, const SweepOptions& options) {
    const SweepStatus status = sweep_status(plan, options, TrialStore(options.folder));
    const std::set<const Trial*> share(status.share.begin(), status.share.end());
    std::string text;
    for (const Trial& trial : plan.trials) {
        if (!share.contains(&trial)) continue;
        const auto found = status.statuses.find(trial.id);
        text += fmt::format("{:<12} {}\n", found == status.statuses.end() ? "todo" : found->second,
                            trial.id);
    }
    return text;
}

std::string dry_run(const SweepPlan& plan, const SweepOptions& options) {
    const SweepStatus status = sweep_status(plan, options, TrialStore(options.folder));
    const ReferenceCache references(options.folder / "references", options.references);
    const std::optional<Cost> cost = status.cost();
    const std::size_t to_render = status.references(references).size();
    std::string text = fmt::format(
        "trials     {}\nreferences {} to render\ntime       {}\ndisk       {}{:.1f} MB are free\n",
        trials_text(status, options, plan.duplicates), to_render,
        time_text(status, options, cost, to_render),
        cost ? fmt::format("pictures of about {:.1f} MB, ", cost->bytes / megabyte) : "",
        free_bytes(options.folder) / megabyte);
    if (!status.broken.empty())
        text += fmt::format("broken     {} records, run again\n", status.broken.size());
    if (const std::string warning = status.code_warning(); !warning.empty())
        text += fmt::format("code       {}\n", warning);
    return text;
}

}  // namespace caustics::experiments
