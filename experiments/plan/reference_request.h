#pragma once

#include <filesystem>
#include <string>

#include "experiments/run/render_and_score.h"

namespace caustics::experiments {

/// What the trials of a scene are judged by.
struct ReferenceRequest {
    RunRequest request;
    std::string key;  ///< hash of scene, method, parameters, samples, seed, film and format
    std::filesystem::path kept_folder;  ///< where references may be kept beside the sweep files
};

}  // namespace caustics::experiments
