#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "core/render/film.h"
#include "core/scene/scene_reader.h"
#include "experiments/plan/reference_request.h"

namespace caustics::experiments {

/// Of the scene's reference pictures; part of their keys. 2 where the eye is in a medium that absorbs:
/// pictures of version 1 leave out what it takes from the first leg of what the eye sees. 3 where a medium absorbs
/// and there are mirrors, or lamps in it: earlier pictures forget the medium behind a mirror and before a lamp. 4 where
/// Phong's law of 1975 is: light paths took it from the wrong side.
int reference_version(const Scene& scene);

/// Hash of everything a reference picture depends on: scene (film and sampler included), method,
/// parameters in force, samples a pixel, seed, reference_version().
std::string reference_key(const RunRequest& request, const SceneFile& scene, int version);

/// A picture that trials are judged by: layers caustic, R G B (beauty), stderr.Y (root mean square
/// over the channels) and, where they apply, indirect, indirect_stderr.Y and unreached.
struct Reference {
    /// A layer over reached pixels and channels.
    struct Light {
        double mean = 0;
        std::optional<double> standard_error = {};  ///< sqrt(mean s^2) / mean(r)
    };
    std::string key;
    Film film;
    Light caustic;
    std::optional<Light> indirect;  ///< none in a reference without that layer
};

/// What is done about references that are there: used; rendered anew; or used, and one that differs only in
/// having fewer samples taken as the beginning of one that is not there (reference_extension.h).
enum class ReferencePolicy { keep, rebuild, extend };

/// References as files KEY.exr: looked for in the folder kept beside the sweep files, then in the
/// sweep's own, else rendered and written there.
class ReferenceCache {
public:
    ReferenceCache(std::filesystem::path own_folder, ReferencePolicy policy)
        : own_folder_(std::move(own_folder)), policy_(policy) {}

    /// Whether pictures that are there are rendered once more.
    bool makes_anew() const { return policy_ == ReferencePolicy::rebuild; }
    /// Whether it has to be rendered before get().
    bool must_render(const ReferenceRequest& request) const;
    /// Renders it and writes its file. `options` brings threads and progress.
    void render(const ReferenceRequest& request, const RunOptions& options) const;
    /// Takes note that it was rendered, for `rebuild`; here or in another process.
    void note_rendered(const ReferenceRequest& request) {
        rendered_.insert(request.key);
        last_.reset();
    }
    /// Reads it; the last one stays in memory. Throws InputError.
    std::shared_ptr<const Reference> get(const ReferenceRequest& request);

private:
    std::filesystem::path file_of(const ReferenceRequest& request) const;

    std::filesystem::path own_folder_;
    ReferencePolicy policy_;
    std::set<std::string> rendered_;
    std::shared_ptr<const Reference> last_;
};

}  // namespace caustics::experiments
