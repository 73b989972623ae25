#include "experiments/plan_file.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "experiments/files.h"

namespace caustics {

namespace {

using nlohmann::json;

constexpr int plan_version = 1;

std::filesystem::path name_in(const std::filesystem::path& folder) { return folder / "plan.json"; }

}  // namespace

PlanFile plan_file(const SweepPlan& plan) {
    PlanFile file;
    for (const Trial& trial : plan.trials)
        file.trials.push_back({trial.id, trial.cell, trial.request.seed, trial.chosen});
    file.swept = plan.swept;
    for (const std::filesystem::path& sweep : plan.files) file.sweeps.push_back(sweep.string());
    file.filters = plan.filters;
    file.started_in = std::filesystem::current_path();
    return file;
}

void write_plan(const PlanFile& plan, const std::filesystem::path& folder) {
    json trials = json::array();
    for (const PlanFile::Entry& trial : plan.trials)
        trials.push_back({{"trial", trial.id},
                          {"cell", trial.cell},
                          {"seed", trial.seed},
                          {"chosen", trial.chosen}});
    const json file = {{"version", plan_version}, {"sweeps", plan.sweeps},
                       {"filters", plan.filters}, {"started_in", plan.started_in.string()},
                       {"swept", plan.swept},     {"trials", std::move(trials)}};
    write_whole_file(name_in(folder), file.dump(1) + "\n");
}

PlanFile read_plan_of(const std::filesystem::path& folder) {
    const std::filesystem::path name = name_in(folder);
    if (!std::filesystem::is_regular_file(name))
        throw InputError(
            fmt::format("{}: no results of a sweep (plan.json is not there)", folder.string()));
    try {
        const json file = json::parse(read_whole_file(name));
        if (file.at("version") != plan_version)
            throw InputError(fmt::format("{}: version {}, this program reads {}", name.string(),
                                         file.at("version").dump(), plan_version));
        PlanFile plan;
        for (const json& trial : file.at("trials"))
            plan.trials.push_back(
                {trial.at("trial").get<std::string>(), trial.at("cell").get<std::string>(),
                 trial.at("seed").get<std::uint64_t>(), trial.at("chosen").get<bool>()});
        file.at("swept").get_to(plan.swept);
        file.at("sweeps").get_to(plan.sweeps);
        file.at("filters").get_to(plan.filters);
        plan.started_in = file.at("started_in").get<std::string>();
        return plan;
    } catch (const json::exception& error) {
        throw InputError(fmt::format("{}: broken ({})", name.string(), error.what()));
    }
}

}  // namespace caustics
