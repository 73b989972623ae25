#pragma once

#include <cstdint>

#include "beamtree/beams/caster_mesh.h"
#include "beamtree/beams/light_sample.h"
#include "core/light_path/bounce_limit.h"

namespace caustics::beamtree {

/// What both methods that work with beams ask of them.
struct BeamParams {
    PolygonKind polygons = PolygonKind::triangle;
    int light_samples = 16;    ///< for each area light
    int mesh_resolution = 64;  ///< of exact casters; meshes are taken as they are
    int max_bounces =
        preset_bounces;  ///< specular events between light and receiver: levels of beams cost too much for more
    double prune = 1e-3;  ///< least light of a beam to be followed, of the first events' mean
    std::int64_t max_beams = 1'000'000;  ///< of several events
    int wavelengths = 16;  ///< that white light is divided into where glass disperses it
    Dispersion dispersion = Dispersion::bins;
    /// Only a sample of the polygons is traced, to tell whether beams can serve the scene: no parameter.
    bool sampled = false;
    /// The polygons that are traced, of all, for a trial of what they cost: no parameter.
    double polygon_share = 1;
};

}  // namespace caustics::beamtree
