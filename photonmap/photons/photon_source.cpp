#include "photonmap/photons/photon_source.h"

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/scene/transport_hash.h"
#include "photonmap/photons/scene_photons.h"

namespace caustics::photonmap {

namespace {

SavedPhotons traced(const Scene& scene, const PhotonMapParams& params, const RunOptions& options) {
    options.phase("trace");
    PhotonOrigin origin{.seed = options.seed,
                        .emission = params.emission,
                        .interaction = params.interaction,
                        .max_bounces = params.max_bounces,
                        .command = options.origin};
    return {trace_scene(scene, params, options), std::move(origin)};
}

SavedPhotons loaded(const Scene& scene, const PhotonMapParams& params, const RunOptions& options) {
    options.phase("load");
    SavedPhotons saved = load_photon_map(params.load);
    require_transport(saved.origin, scene, params.load);
    return saved;
}

}  // namespace

void require_transport(const PhotonOrigin& origin, const Scene& scene,
                       const std::filesystem::path& file) {
    const std::uint64_t transport = transport_hash(scene);
    if (origin.transport == transport) return;
    throw InputError(file.string() +
                     ": the photons are those of another scene: lights, casters or geometry differ "
                     "(transport digest " +
                     hex(origin.transport) + ", the scene's is " + hex(transport) +
                     "); only camera, film and what receivers reflect may change");
}

SavedPhotons photon_source(const Scene& scene, const PhotonMapParams& params,
                           const RunOptions& options) {
    if (!params.load.empty()) return loaded(scene, params, options);
    // Tried now, rather than after the tracing.
    if (!params.save.empty()) AtomicFile trial(params.save);
    SavedPhotons photons = traced(scene, params, options);
    if (params.save.empty()) return photons;
    options.phase("save");
    photons.origin.transport = transport_hash(scene);
    save_photon_map(photons.photons, photons.origin, params.save);
    return photons;
}

}  // namespace caustics::photonmap
