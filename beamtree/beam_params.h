#pragma once

#include "beamtree/caster_mesh.h"
#include "core/json_reader.h"

namespace caustics {

/// What both methods that work with beams ask of them.
struct BeamParams {
    PolygonKind polygons = PolygonKind::triangle;
    int light_samples = 16;    ///< for each area light
    int mesh_resolution = 64;  ///< of exact casters; meshes are taken as they are
    /// Specular events that light paths may have. 1 asks for just those that beams can give. From 2
    /// on, a scene where more than half of the flux goes on to a second event is refused, and
    /// the report tells the share where it is less.
    int max_bounces = 16;
};

/// Those that are given: `polygons`, `light_samples`, `mesh_resolution`, `max_bounces`.
void read_beam_params(const JsonNode& node, BeamParams& params);

}  // namespace caustics
