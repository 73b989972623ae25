#pragma once

#include "beamtree/beams/caster_mesh.h"
#include "beamtree/beams/light_sample.h"

namespace caustics::beamtree {

/// What both methods that work with beams ask of them.
struct BeamParams {
    PolygonKind polygons = PolygonKind::triangle;
    int light_samples = 16;    ///< for each area light
    int mesh_resolution = 64;  ///< of exact casters; meshes are taken as they are
    int max_bounces = 16;      ///< specular events between light and receiver
    int wavelengths = 16;      ///< that white light is divided into where glass disperses it
    Dispersion dispersion = Dispersion::bins;
};

}  // namespace caustics::beamtree
