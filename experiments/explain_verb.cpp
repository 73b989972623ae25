#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "experiments/child_process.h"
#include "experiments/environment.h"
#include "experiments/files.h"
#include "experiments/job_store.h"
#include "experiments/plan_file.h"
#include "experiments/run.h"
#include "experiments/verbs.h"

namespace caustics {

namespace {

using nlohmann::json;
namespace fs = std::filesystem;

/// The trial named by its id, or by the beginning or the hash at the end of one.
std::string find_trial(const PlanFile& plan, const std::string& name, const std::string& folder) {
    std::vector<std::string> found;
    for (const PlanFile::Entry& trial : plan.trials) {
        if (trial.id == name) return name;
        if (trial.id.starts_with(name) || trial.id.ends_with("-" + name)) found.push_back(trial.id);
    }
    if (found.size() == 1) return found[0];
    if (found.empty())
        throw InputError(fmt::format("{}: no trial \"{}\" (sweep --list names them; say {})",
                                     folder, name, plan.trials.empty() ? "-" : plan.trials[0].id));
    if (found.size() > 3) found.resize(3);
    throw InputError(fmt::format("{}: several trials begin with \"{}\": {}, ...", folder, name,
                                 fmt::join(found, ", ")));
}

/// A file named relative to where the sweep was started, seen from here.
fs::path from_here(const fs::path& file, const PlanFile& plan) {
    const fs::path absolute = plan.started_in / file;
    const fs::path near = fs::proximate(absolute);
    return near.string().size() < absolute.string().size() ? near : absolute;
}

/// The command line with this program in place of its bare name.
std::string this_program(const std::string& command_line) {
    constexpr std::string_view bare = "causticbench";
    const fs::path program = fs::read_symlink("/proc/self/exe");
    return shell_word(fs::proximate(program).string()) + command_line.substr(bare.size());
}

RunRequest request_of(const json& record, const PlanFile& plan) {
    RunRequest request;
    request.scene_file = from_here(record.at("scene").at("file").get<std::string>(), plan);
    if (record.at("scene").contains("set"))
        for (const auto& [pointer, value] : record.at("scene").at("set").items())
            request.overrides.emplace_back(pointer, value.get<std::string>());
    const json& method = record.at("method");
    request.method =
        parse_method(method.at("name").get<std::string>(),
                     JsonNode::parse_text(method.at("parameters").dump(), "record.json"));
    request.seed = record.at("seed").get<std::uint64_t>();
    request.samples_per_pixel = record.at("spp").get<int>();
    return request;
}

/// Empty when the scene is still what the trial saw.
std::string scene_warning(const RunRequest& request, const json& record) {
    try {
        const std::string hash = run_in_child([&](const ChildProcess::Tell&) {
            return load_scene(request.scene_file, request.overrides).hash;
        });
        if (hash == record.at("scene").at("hash").get<std::string>()) return {};
        return fmt::format("{} has changed since", request.scene_file.string());
    } catch (const InputError& error) {
        return error.what();
    }
}

std::string explain(const std::string& folder, const std::string& name) {
    const PlanFile plan = read_plan_of(folder);
    const std::string id = find_trial(plan, name, folder);
    const std::optional<json> record = JobStore(folder).record(id);
    if (!record) throw InputError(fmt::format("{}: {} has not run yet", folder, id));
    const RunRequest request = request_of(*record, plan);
    std::string text = fmt::format("# {}: {}\n", id, record->at("status").get<std::string>());
    const auto tell = [&](const std::string& line) { text += "# " + line + "\n"; };
    if (record->contains("message")) tell(record->at("message").get<std::string>());
    if (record->contains("picture_hash"))
        tell(fmt::format("picture {}", record->at("picture_hash").get<std::string>()));
    const std::string code = record->at("code_version").get<std::string>();
    tell("code " + code + (code == code_version() ? "" : ", this program is " + code_version()));
    if (const std::string warning = scene_warning(request, *record); !warning.empty())
        tell("the command below gives another picture: " + warning);
    const std::string machine = fmt::format(" --threads {} --isa {}", record->at("threads").dump(),
                                            record->at("isa").get<std::string>());
    text += this_program(command("render", request)) + machine + fmt::format(" -o {}.exr\n", id);
    std::string sweeps;
    for (const std::string& sweep : plan.sweeps)
        sweeps += " " + shell_word(from_here(sweep, plan).string());
    tell("once more into the table, with times and errors:");
    tell(this_program("causticbench") + fmt::format(" sweep{} -o {} --filter trial={} --force{}",
                                                    sweeps, shell_word(folder), id, machine));
    if (!record->contains("reference")) return text;
    const json& reference = record->at("reference");
    tell(fmt::format("the reference: {} {}, --spp {} --seed {}",
                     reference.at("name").get<std::string>(), reference.at("parameters").dump(),
                     reference.at("spp").dump(), reference.at("seed").dump()));
    return text;
}

}  // namespace

Verb add_explain(CLI::App& app) {
    struct Flags {
        std::string folder;
        std::string trial;
    };
    auto flags = std::make_shared<Flags>();
    CLI::App* const verb =
        app.add_subcommand("explain", "Print the command that makes a trial's picture again");
    verb->add_option("DIR", flags->folder, "Folder of the results")->required();
    verb->add_option("TRIAL", flags->trial, "Its name, the beginning of it, or its config_hash")
        ->required();
    verb->footer(
        "Prints lines for a shell: remarks begin with #.\nExample:\n  causticbench explain out "
        "ring-photonmap-s1-0123456789abcdef");
    return {verb, [flags] {
                write_stdout(explain(flags->folder, flags->trial));
                return 0;
            }};
}

}  // namespace caustics
