#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/render/renderer.h"
#include "core/scene/scene_reader.h"
#include "experiments/base/stopwatch.h"
#include "experiments/run/caustic_ledger.h"
#include "experiments/run/method.h"

namespace caustics::experiments {

/// How much is found out to be told of a picture's light.
enum class Telling {
    all,
    of_few_paths,  ///< what few light paths tell, for time is short
    nothing        ///< of a trial
};

/// A picture to make: what a trial, a reference and the verb `render` have in common.
struct RunRequest {
    std::filesystem::path scene_file;
    Overrides overrides;
    Method method;
    std::uint64_t seed = 1;
    int samples_per_pixel = 1;
    std::optional<IndirectMethod> indirect = {};  ///< none: a picture without that layer
    int pixel_step = 1;                           ///< one of so many pixels is rendered (Passes)
    Telling telling = Telling::all;
};

/// The command line of a verb that makes it, with every parameter in force.
std::string command(const std::string& verb, const RunRequest& request);

/// The whole scene, its shapes taken away from the file: a copy of large meshes takes seconds, and as much memory again. The file keeps the rest.
SceneDesc take_shapes(SceneFile& file);

/// Values in a record's JSON: what the method counted and chose.
struct RunResult {
    Film film;
    BuildReport report;
    Counters counters;                     ///< of build and queries
    std::optional<std::string> why_empty;  ///< of a caustic that is black all over
    std::vector<std::string> notes;        ///< what a user should know, one line each
    std::vector<std::string> mesh_notes;   ///< those of the notes that are of meshes (mesh_notes.h)
    std::optional<CausticLedger> ledger;   ///< of a method that has a caustic
};

/// The resolved configuration as attributes of a picture: scene, method with every parameter in
/// force, what it chose by itself and what became of the light, seed, samples, code version, and the command that makes it.
/// The same request gives the same text, whatever the number of threads.
std::map<std::string, std::string> picture_metadata(const RunRequest& request,
                                                    const SceneFile& scene,
                                                    const RunResult& result);

/// Builds the method and renders, cutting the time into "precompute", "precompute/PHASE", "render"
/// and "render/PHASE" by the phases the method names. `options` brings threads and progress, and
/// hears of both stages and of the phases.
RunResult run(const Scene& scene, const RunRequest& request, RunOptions options,
              Stopwatch& stopwatch);

}  // namespace caustics::experiments
