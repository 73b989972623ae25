#pragma once

#include <string>
#include <vector>

#include "beamtree/beam_tracing.h"
#include "beamtree/flux_balance.h"
#include "core/json_reader.h"

namespace caustics {

/// What both methods that work with beams need from them.
struct BeamRequest {
    std::string method;  ///< for messages
    int light_samples = 16;
    int mesh_resolution = 64;
    int max_bounces = 16;
    PolygonKind polygons = PolygonKind::triangle;
};

/// The parameter `polygons` of both methods, where it is given: triangles or quads.
void read_polygons(const JsonNode& node, PolygonKind& polygons);

/// The beams of a scene, all lights and casters.
struct TracedScene {
    std::vector<CasterMesh> casters;
    std::vector<BeamSet> sets;
    FluxBalance balance;

    std::uint64_t beam_count() const;
    std::uint64_t bytes() const;  ///< of the beams
    /// polygons, beams and what was left out; how normals and meshes were come by.
    void add_to(BuildReport& report) const;
    /// The mesh of a shape.
    const CasterMesh& caster(std::uint32_t shape) const;
};

/// Phase "beams". Throws UnsupportedScene where more than half of the flux goes on to another
/// specular surface, unless the request's max_bounces is 1.
TracedScene trace_scene(const Scene& scene, const BeamRequest& request, const RunOptions& options);

}  // namespace caustics
