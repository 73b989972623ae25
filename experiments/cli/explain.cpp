#include "experiments/cli/explain.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "experiments/base/child_process.h"
#include "experiments/base/environment.h"
#include "experiments/base/shell_word.h"
#include "experiments/plan/plan_file.h"
#include "experiments/plan/trial_store.h"
#include "experiments/run/render_and_score.h"

namespace caustics::experiments {

namespace {

using nlohmann::json;
namespace fs = std::filesystem;

/// A remark for the shell to skip, on one line.
std::string remark(std::string text) {
    std::ranges::replace_if(text, [](char c) { return (c >= 0 && c < ' ') || c == '\x7f'; }, ' ');
    return "# " + text + "\n";
}

/// The trial named by its id, or by the beginning or the hash at the end of one.
std::string find_trial(const PlanFile& plan, const std::string& name, const fs::path& folder) {
    std::vector<std::string> found;
    for (const PlanFile::Entry& trial : plan.trials) {
        if (trial.id == name) return name;
        if (trial.id.starts_with(name) || trial.id.ends_with("-" + name)) found.push_back(trial.id);
    }
    if (found.size() == 1) return found[0];
    if (found.empty())
        throw InputError(fmt::format("{}: no trial \"{}\" (sweep --list names them; say {})",
                                     folder.string(), name,
                                     plan.trials.empty() ? "-" : plan.trials[0].id));
    const bool are_all = found.size() <= 3;
    if (!are_all) found.resize(3);
    throw InputError(fmt::format("{}: several trials begin with \"{}\": {}{}", folder.string(),
                                 name, fmt::join(found, ", "), are_all ? "" : ", ..."));
}

/// A file named relative to where the sweep was started, seen from here.
fs::path from_here(const fs::path& file, const PlanFile& plan) {
    const fs::path absolute = plan.started_in / file;
    std::error_code gone;
    const fs::path near = fs::proximate(absolute, gone);
    return !gone && near.string().size() < absolute.string().size() ? near : absolute;
}

/// The command line with this program in place of its bare name.
std::string this_program(const std::string& command_line) {
    constexpr std::string_view bare = "causticbench";
    std::error_code unknown;
    const fs::path program = fs::read_symlink("/proc/self/exe", unknown);
    if (unknown) return command_line;
    const fs::path near = fs::proximate(program, unknown);
    const fs::path named = unknown ? program : near.has_parent_path() ? near : "." / near;
    return shell_path(named) + command_line.substr(bare.size());
}

bool is_instruction_set(const std::string& text) {
    constexpr Isa all[] = {Isa::plain, Isa::avx2, Isa::avx512};  // this machine need not have it
    return std::ranges::any_of(all, [&](Isa isa) { return text == name(isa); });
}

bool is_hash(const std::string& text) {
    return text.size() == hex(0).size() &&
           text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

int small_count(const json& record, const char* key) {
    const auto count = record.at(key).get<std::uint64_t>();
    if (count > std::numeric_limits<int>::max())
        throw InputError(fmt::format("/{}: {} is too large", key, count));
    return static_cast<int>(count);
}

/// " --threads 1 --isa avx2"
std::string machine_options(const json& record) {
    const std::string isa = record.at("isa").get<std::string>();
    if (!is_instruction_set(isa)) throw InputError("/isa: names no instruction set");
    return fmt::format(" --threads {} --isa {}", small_count(record, "threads"), isa);
}

/// "picture HASH", or nothing where there is no picture.
std::string picture_remark(const json& record) {
    const std::string hash = record.value("picture_hash", "");
    if (hash.empty()) return {};
    if (!is_hash(hash)) throw InputError("/picture_hash: is no hash");
    return remark("picture " + hash);
}

/// The parameters of a trial's method; files that it read, which the record lists with the prefix, seen from here.
JsonNode parameters_of(const json& record, const char* method, const std::string& prefix,
                       const PlanFile& plan) {
    json parameters = record.at(method).at("parameters");
    for (auto& [key, value] : parameters.items())
        if (record.at("method").contains("files") &&
            record.at("method").at("files").contains(prefix + key))
            value = from_here(value.get<std::string>(), plan).string();
    return JsonNode::parse_text(parameters.dump(), method);
}

RunRequest request_of(const json& record, const PlanFile& plan) {
    RunRequest request;
    request.scene_file = from_here(record.at("scene").at("file").get<std::string>(), plan);
    if (record.at("scene").contains("set"))
        for (const auto& [pointer, value] : record.at("scene").at("set").items())
            request.overrides.emplace_back(pointer, value.get<std::string>());
    request.method = parse_method(record.at("method").at("name").get<std::string>(),
                                  parameters_of(record, "method", "", plan));
    if (!request.method.configured->files_written().empty())
        throw InputError("/method/parameters: names a file to write, which no trial does");
    if (record.contains("indirect"))
        request.indirect = parse_indirect(record.at("indirect").at("name").get<std::string>(),
                                          parameters_of(record, "indirect", "indirect_", plan));
    if (request.indirect && !request.indirect->configured->files_written().empty())
        throw InputError("/indirect/parameters: names a file to write, which no trial does");
    request.seed = record.at("seed").get<std::uint64_t>();
    request.samples_per_pixel = small_count(record, "spp");
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

/// Empty when the files that the methods read are those of the trial.
std::string files_warning(const RunRequest& request, const json& record) {
    try {
        const json now = files_read(request.method, request.indirect);
        if (now == record.at("method").value("files", json::object())) return {};
        return "a file that its method reads has changed since";
    } catch (const InputError& error) {
        return error.what();
    }
}

std::string reference_remark(const json& reference) {
    return remark(fmt::format("the reference: {} {}, --spp {} --seed {}",
                              reference.at("name").get<std::string>(),
                              reference.at("parameters").dump(), reference.at("spp").dump(),
                              reference.at("seed").dump()));
}

std::string explanation(const json& record, const std::string& id, const PlanFile& plan,
                        const fs::path& folder) {
    std::string text = remark(id + ": " + record.at("status").get<std::string>());
    if (record.contains("message")) text += remark(record.at("message").get<std::string>());
    text += picture_remark(record);
    const std::string code = record.at("code_version").get<std::string>();
    text += remark("code " + code +
                   (code == code_version() ? "" : ", this program is " + code_version()));
    const RunRequest request = request_of(record, plan);
    for (const std::string& warning :
         {scene_warning(request, record), files_warning(request, record)})
        if (!warning.empty()) text += remark("the command below gives another picture: " + warning);
    const std::string machine = machine_options(record);
    text += this_program(command("render", request)) + machine + fmt::format(" -o {}.exr\n", id);
    std::string sweeps;
    for (const std::string& sweep : plan.sweeps) sweeps += " " + shell_path(from_here(sweep, plan));
    text += remark("once more into the table, with times and errors:");
    text += remark(this_program("causticbench") +
                   fmt::format(" sweep{} -o {} --filter trial={} --force{}", sweeps,
                               shell_path(folder), id, machine));
    return record.contains("reference") ? text + reference_remark(record.at("reference")) : text;
}

}  // namespace

std::string explain(const fs::path& folder, const std::string& trial) {
    const PlanFile plan = read_plan_of(folder);
    const std::string id = find_trial(plan, trial, folder);
    const TrialStore store(folder);
    const std::optional<json> record = store.record(id);
    if (!record) throw InputError(fmt::format("{}: {} has not run yet", folder.string(), id));
    const auto broken = [&](const std::exception& error) {
        return InputError(
            fmt::format("{}: broken record ({})", store.record_of(id).string(), error.what()));
    };
    try {
        return explanation(*record, id, plan, folder);
    } catch (const json::exception& error) {
        throw broken(error);
    } catch (const InputError& error) {
        throw broken(error);
    }
}

}  // namespace caustics::experiments
