#include "experiments/plan/plan_file.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "experiments/base/bounded_json.h"
#include "experiments/base/file_io.h"

namespace caustics::experiments {

namespace {

using nlohmann::json;

constexpr int plan_version = 1;

std::filesystem::path name_in(const std::filesystem::path& folder) { return folder / "plan.json"; }

bool is_made_of(const std::string& text, std::string_view letters) {
    return !text.empty() && text.find_first_not_of(letters) == std::string::npos;
}

/// Ids become names of folders, and words of commands.
void require_plain_id(const std::string& id) {
    constexpr std::size_t longest = 250;
    const bool reserved = id == "." || id == ".." || id.starts_with('-') ||
                          id.starts_with(".tmp-") || id.starts_with(".old-");
    if (!is_made_of(id, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._-") ||
        reserved || id.size() > longest)
        throw InputError("a trial's name must be a plain name of a folder, not " +
                         json(id.substr(0, longest)).dump());
}

void require_column(const std::string& name) {
    if (!is_made_of(name, "abcdefghijklmnopqrstuvwxyz0123456789_"))
        throw InputError("swept: no column is named " + json(name).dump());
}

PlanFile plan_from_json(const json& file) {
    if (file.at("version") != json(plan_version))
        throw InputError(fmt::format("version {}, this program reads {}", file.at("version").dump(),
                                     plan_version));
    PlanFile plan;
    for (const json& trial : file.at("trials")) {
        if (!trial.at("seed").is_number_unsigned())
            throw InputError("a trial's seed must be a whole number from 0 on");
        plan.trials.push_back(
            {trial.at("trial").get<std::string>(), trial.at("cell").get<std::string>(),
             trial.at("seed").get<std::uint64_t>(), trial.at("chosen").get<bool>()});
        require_plain_id(plan.trials.back().id);
    }
    file.at("swept").get_to(plan.swept);
    for (const std::string& name : plan.swept) require_column(name);
    file.at("sweeps").get_to(plan.sweeps);
    file.at("filters").get_to(plan.filters);
    plan.started_in = file.at("started_in").get<std::string>();
    return plan;
}

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
    write_atomic_file(name_in(folder), file.dump(1) + "\n");
}

PlanFile read_plan_of(const std::filesystem::path& folder) {
    const std::filesystem::path name = name_in(folder);
    if (!std::filesystem::is_regular_file(name))
        throw InputError(
            fmt::format("{}: no results of a sweep (plan.json is not there)", folder.string()));
    const auto broken = [&](const std::exception& error) {
        return InputError(fmt::format("{}: broken ({})", name.string(), error.what()));
    };
    try {
        return plan_from_json(parse_bounded(read_whole_file(name)));
    } catch (const json::exception& error) {
        throw broken(error);
    } catch (const InputError& error) {
        throw broken(error);
    }
}

}  // namespace caustics::experiments
