#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/plan/reference_request.h"

namespace caustics::experiments {

/// One element of the product of a sweep file's lists. Scene values are set in the order of their
/// pointers, so that a whole object is set before a value in it.
struct Trial {
    std::string id;           ///< readable words, then the configuration's hash
    std::string config_hash;  ///< of scene, method, parameters, seed, samples, repeat, reference
    std::string cell;         ///< the same without seed and repeat: trials that average
    RunRequest request;
    int repeat = 1;
    int threads = 1;
    bool chosen = true;  ///< by the filters
    std::string scene_name;
    std::string scene_hash;
    std::map<std::string, std::string> method_files;  ///< files_read() of the method
    /// Swept keys with their values as text: scene values under their names, method parameters
    /// under theirs.
    std::vector<std::pair<std::string, std::string>> swept;
    std::optional<ReferenceRequest> reference;
};

/// All trials of some sweep files, each once, in the order of the files.
struct SweepPlan {
    std::vector<std::filesystem::path> files;
    std::vector<std::string> filters;  ///< "key=value" that trials were chosen by
    std::vector<Trial> trials;
    std::vector<std::string> swept;  ///< the swept keys of all files
    std::size_t duplicates = 0;      ///< trials named more than once
};

/// The folder beside the sweep files' own in which references may be kept for all of them.
std::filesystem::path kept_references(const std::filesystem::path& sweep_file);

/// Does some work and returns what it answered: at once, or in a process of its own.
using Isolation = std::function<std::string(const std::function<std::string()>& work)>;

/// Reads sweep files and everything they name: scenes under every combination of values, methods
/// with their parameters, references. Throws InputError for what does not fit, and
/// UnsupportedScene for a reference that cannot serve a scene, before anything runs. Scenes are
/// loaded through `isolation`, because loading them may start threads.
SweepPlan read_plan(
    const std::vector<std::filesystem::path>& files,
    const Isolation& isolation = [](const auto& work) { return work(); });

}  // namespace caustics::experiments
