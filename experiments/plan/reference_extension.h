#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "core/render/film.h"
#include "core/scene/scene_reader.h"
#include "experiments/run/render_and_score.h"

namespace caustics::experiments {

/// A kept reference that differs from a wanted one only in having fewer samples.
struct SmallerReference {
    std::filesystem::path file;
    Film film;
    std::uint64_t samples = 0;  ///< the value of its method's SampleCount::parameter
};

/// The samples that a reference method is asked for; empty for methods that have no such number.
std::optional<std::uint64_t> samples_of(const Method& method);

/// The one of most samples among the EXR files of some folders, if there is any: the same scene, method,
/// other parameters, film, camera samples, seed and reference_version().
std::optional<SmallerReference> find_smaller(const std::vector<std::filesystem::path>& folders,
                                             const RunRequest& wanted, const SceneFile& scene,
                                             int version);

/// What is left to render: the same with the missing samples, and a seed of its own.
RunRequest remainder(const RunRequest& wanted, const SmallerReference& begun);

/// Both as one picture: the mean weighted by samples, its standard error from theirs.
Film joined(const RunRequest& wanted, const SmallerReference& begun, const Film& rest);

}  // namespace caustics::experiments
