#include "experiments/run/cli_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "experiments/base/file_io.h"
#include "experiments/base/number_option.h"
#include "experiments/base/status_line.h"

namespace caustics::experiments {

CLI::Option* add_repeatable(CLI::App& verb, const std::string& name,
                            std::vector<std::string>& values, const std::string& help) {
    return verb.add_option(name, values, help)->type_size(1)->allow_extra_args(false);
}

void SceneOptions::add_to(CLI::App& verb) {
    verb.add_option("SCENE", file, "Scene file (JSON)")->required();
    add_repeatable(verb, "--set", sets,
                   "Change the scene: /json/pointer=value, JSON or else a string. Repeatable")
        ->type_name("/POINTER=VALUE");
}

Overrides SceneOptions::overrides() const {
    Overrides all;
    for (const std::string& set : sets) {
        const std::size_t equals = set.find('=');
        if (equals == std::string::npos || equals == 0)
            throw InputError(fmt::format("--set \"{}\": expected /json/pointer=value", set));
        const std::string pointer = set.substr(0, equals);
        for (const auto& [earlier, value] : all)
            if (earlier == pointer || earlier.starts_with(pointer + "/"))
                throw InputError(
                    fmt::format("--set \"{}\": takes the place of --set \"{}={}\"; leave that out",
                                set, earlier, value));
        all.emplace_back(pointer, set.substr(equals + 1));
    }
    return all;
}

SceneFile SceneOptions::load(PictureDepth textures) const {
    StatusLine line;
    if (line.is_on_terminal()) line.show(fmt::format("reading {} ...", file));
    return load_scene(file, overrides(), textures);
}

void MethodOptions::add_to(CLI::App& verb, bool required) {
    std::string known;
    for (const std::string& each : method_names()) known += (known.empty() ? "" : ", ") + each;
    verb.add_option("--method", name, "Caustic method: " + known)
        ->required(required)
        ->type_name("NAME");
    add_repeatable(verb, "--param", params, "Parameter of the method: key=value. Repeatable")
        ->type_name("KEY=VALUE");
}

Method MethodOptions::parse() const { return parse_method(name, parameters_node(params)); }

void IndirectOptions::add_to(CLI::App& verb) {
    verb.add_option("--indirect", name,
                    fmt::format("Method of the light between diffuse surfaces: {} (default: none)",
                                fmt::join(indirect_names(), ", ")))
        ->type_name("NAME");
    add_repeatable(verb, "--indirect-param", params,
                   "Parameter of the indirect method: key=value. Repeatable")
        ->type_name("KEY=VALUE");
}

std::optional<IndirectMethod> IndirectOptions::parse() const {
    return parse_indirect(name, parameters_node(params, "--indirect-param"));
}

void MachineFlags::add_to(CLI::App& verb, const std::string& default_threads) {
    add_number(verb, "--threads", threads, 1, most_threads,
               "Number of threads (default: " + default_threads + ")");
    std::string known;
    for (const Isa each : supported_isas())
        known += (known.empty() ? "" : ", ") + std::string(name(each));
    verb.add_option_function<std::string>(
            "--isa", [this](const std::string& wanted) { isa = isa_from_name(wanted); },
            "Instruction set of the hot loops: " + known + " (default: the last)")
        ->type_name("NAME");
}

void RunFlags::add_to(CLI::App& verb) {
    add_number<std::uint64_t>(verb, "--seed", seed, 0, std::numeric_limits<std::uint64_t>::max(),
                              "Seed of all random numbers (default 1)");
    machine.add_to(verb, "those available");
}

RunOptions RunFlags::options(int samples_per_pixel) const {
    RunOptions options;
    options.seed = seed;
    options.threads = machine.threads > 0 ? machine.threads : available_threads();
    options.isa = machine.isa;
    options.samples_per_pixel = samples_per_pixel;
    return options;
}

int samples_per_pixel(const PixelSampling& sampling, int asked, const std::string& place) {
    const int count = asked > 0 ? asked : sampling.sample_count;
    const int below = static_cast<int>(std::sqrt(count));
    if (sampling.stratified && below * below != count)
        throw InputError(fmt::format(
            "{} {}: the scene's stratified sampler takes n^2 samples a pixel, as {} or {}; a "
            "sampler of type \"independent\" takes any number",
            place, count, below * below, (below + 1) * (below + 1)));
    if (sampling.max_sample_count > 0 && (count < 2 || count > sampling.max_sample_count))
        throw InputError(
            fmt::format("{} {}: the scene's adaptive sampler starts with 2 to {} samples a pixel",
                        place, count, sampling.max_sample_count));
    return count;
}

void print_notes(const std::vector<std::string>& notes) {
    for (const std::string& note : notes) write_stderr(fmt::format("note: {}\n", note));
}

}  // namespace caustics::experiments
