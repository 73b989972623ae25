#include "photonmap/photons/photon_source.h"

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/scene/transport_hash.h"
#include "photonmap/photons/global_photons.h"

namespace caustics::photonmap {

namespace {

std::uint64_t transport_of(const PhotonOrigin& origin, const Scene& scene) {
    return origin.whole_paths ? whole_transport_hash(scene) : transport_hash(scene);
}

SavedPhotons loaded(const Scene& scene, const std::filesystem::path& file, bool whole_paths,
                    const RunOptions& options) {
    options.phase("load");
    SavedPhotons saved = load_photon_map(file);
    if (saved.origin.whole_paths != whole_paths)
        throw InputError(file.string() +
                         (whole_paths ? ": is a map of caustics alone, which photonmap loads; "
                                        "globalphotonmap needs one that it saved"
                                      : ": is a map of all surfaces, which globalphotonmap "
                                        "loads; photonmap needs one that it saved"));
    require_transport(saved.origin, scene, file);
    return saved;
}

/// Loaded, or traced and perhaps saved.
template <typename Params, typename Trace>
SavedPhotons source(const Scene& scene, const Params& params, PhotonOrigin origin,
                    const RunOptions& options, const Trace& trace) {
    if (!params.load.empty()) return loaded(scene, params.load, origin.whole_paths, options);
    // Tried now, rather than after the tracing.
    if (!params.save.empty()) {
        require_writable_place(params.save);
        const AtomicFile trial(params.save);
    }
    options.phase("trace");
    origin.seed = options.seed;
    origin.max_bounces = params.max_bounces;
    origin.command = options.origin;
    SavedPhotons photons{trace(), std::move(origin)};
    if (params.save.empty()) return photons;
    options.phase("save");
    photons.origin.transport = transport_of(photons.origin, scene);
    save_photon_map(photons.photons, photons.origin, params.save);
    return photons;
}

}  // namespace

void require_transport(const PhotonOrigin& origin, const Scene& scene,
                       const std::filesystem::path& file) {
    const std::uint64_t transport = transport_of(origin, scene);
    if (origin.transport == transport) return;
    throw InputError(file.string() + ": the photons are those of another scene: " +
                     (origin.whole_paths ? "lights, surfaces or geometry differ"
                                         : "lights, casters or geometry differ") +
                     " (transport digest " + hex(origin.transport) + ", the scene's is " +
                     hex(transport) + "); only camera" +
                     (origin.whole_paths ? " and film may change"
                                         : ", film and what receivers reflect may change"));
}

SavedPhotons photon_source(const Scene& scene, const PhotonMapParams& params,
                           const RunOptions& options, AskYield ask) {
    return source(scene, params, {.emission = params.emission, .interaction = params.interaction},
                  options, [&] { return trace_scene(scene, params, options, ask); });
}

SavedPhotons photon_source(const Scene& scene, const GlobalMapParams& params,
                           const RunOptions& options) {
    return source(scene, params, {.whole_paths = true, .diffuse_bounces = params.diffuse_bounces},
                  options, [&] { return trace_global(scene, params, options); });
}

}  // namespace caustics::photonmap
