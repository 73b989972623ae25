#include "experiments/plan/reference_extension.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "experiments/base/bounded_json.h"

namespace caustics::experiments {

namespace {

using json = nlohmann::json;

/// The parameter that says how many samples there are; empty for methods without.
const std::string& samples_name(const Method& method) { return method.facts().samples.parameter; }

Method with_samples(const Method& method, std::uint64_t samples) {
    json parameters = describe(method);
    parameters[samples_name(method)] = samples;
    std::vector<std::string> assignments;
    for (const auto& [key, value] : parameters.items())
        assignments.push_back(key + "=" + value.dump());
    return parse_method(method.name, parameters_node(assignments));
}

json without_samples(json parameters, const Method& method) {
    parameters.erase(samples_name(method));
    return parameters;
}

/// Samples that a picture was made of, or as many a pixel: each camera sample is given as many, rounded up.
double weight(const RunRequest& request, std::uint64_t samples) {
    if (!request.method.facts().samples.of_a_pixel) return static_cast<double>(samples);
    const auto each = static_cast<std::uint64_t>(request.samples_per_pixel);
    return static_cast<double>((samples + each - 1) / each * each);
}

std::string said(const Film& film, const char* name) {
    const auto found = film.metadata.find(name);
    return found == film.metadata.end() ? "" : found->second;
}

bool belongs_to(const Film& film, const RunRequest& wanted, const SceneFile& scene, int version) {
    const json theirs = parse_bounded_or_discard(said(film, "parameters"));
    return theirs.is_object() && said(film, "indirect").empty() &&
           theirs.value(samples_name(wanted.method), json()).is_number_unsigned() &&
           said(film, "reference_version") == (version > 1 ? fmt::format("{}", version) : "") &&
           said(film, "scene_hash") == scene.hash && said(film, "method") == wanted.method.name &&
           said(film, "seed") == fmt::format("{}", wanted.seed) &&
           said(film, "spp") == fmt::format("{}", wanted.samples_per_pixel) &&
           film.width() == scene.desc.camera.width && film.height() == scene.desc.camera.height &&
           film.has_layer("caustic") && film.find("stderr.Y") != nullptr &&
           without_samples(theirs, wanted.method) ==
               without_samples(describe(wanted.method), wanted.method);
}

/// Empty for a file that is no picture: the trials that need that reference will say so.
std::optional<Film> readable(const std::filesystem::path& file) {
    try {
        return read_exr(file);
    } catch (const InputError&) {
        return {};
    }
}

}  // namespace

std::optional<std::uint64_t> samples_of(const Method& method) {
    if (samples_name(method).empty()) return {};
    return describe(method).at(samples_name(method)).get<std::uint64_t>();
}

std::optional<SmallerReference> find_smaller(const std::vector<std::filesystem::path>& folders,
                                             const RunRequest& wanted, const SceneFile& scene,
                                             int version) {
    std::optional<SmallerReference> best;
    const std::optional<std::uint64_t> most = samples_of(wanted.method);
    if (!most) return best;
    for (const std::filesystem::path& folder : folders) {
        if (!std::filesystem::is_directory(folder)) continue;
        std::vector<std::filesystem::path> files;
        for (const auto& entry : std::filesystem::directory_iterator(folder))
            if (entry.path().extension() == ".exr") files.push_back(entry.path());
        std::ranges::sort(files);  // a folder has no order
        for (const std::filesystem::path& file : files) {
            std::optional<Film> film = readable(file);
            if (!film || !belongs_to(*film, wanted, scene, version)) continue;
            const auto samples = parse_bounded(said(*film, "parameters"))
                                     .at(samples_name(wanted.method))
                                     .get<std::uint64_t>();
            if (samples < *most && (!best || samples > best->samples))
                best = SmallerReference{file, std::move(*film), samples};
        }
    }
    return best;
}

RunRequest remainder(const RunRequest& wanted, const SmallerReference& begun) {
    RunRequest rest = wanted;
    rest.method = with_samples(wanted.method, *samples_of(wanted.method) - begun.samples);
    // Other random numbers than those of any part before.
    rest.seed = fnv1a(fmt::format("{} after {} samples", wanted.seed, begun.samples));
    return rest;
}

Film joined(const RunRequest& wanted, const SmallerReference& begun, const Film& rest) {
    const double a = weight(wanted, begun.samples);
    const double b = weight(wanted, *samples_of(wanted.method) - begun.samples);
    Film film(rest.width(), rest.height());
    for (const Plane& plane : rest.planes()) {
        const std::vector<float>* const first = begun.film.find(plane.channel);
        if (first == nullptr)
            throw InputError(fmt::format("{}: no channel {} (remake it with --references rebuild)",
                                         begun.file.string(), plane.channel));
        const bool is_error = plane.channel == "stderr.Y";
        std::vector<float>& mean = film.plane(plane.channel);
        for (std::size_t i = 0; i < mean.size(); ++i) {
            const double x = a * static_cast<double>((*first)[i]);
            const double y = b * static_cast<double>(plane.values[i]);
            mean[i] = static_cast<float>((is_error ? std::hypot(x, y) : x + y) / (a + b));
        }
    }
    return film;
}

}  // namespace caustics::experiments
