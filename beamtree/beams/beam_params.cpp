#include "beamtree/beams/beam_params.h"

namespace caustics {

void read_beam_params(const JsonNode& node, BeamParams& params) {
    if (const auto polygons = node.find("polygons"))
        params.polygons = polygons->as_choice({"triangles", "quads"}) == 0 ? PolygonKind::triangle
                                                                           : PolygonKind::quad;
    if (const auto samples = node.find("light_samples"))
        params.light_samples = static_cast<int>(samples->as_integer_in(1, 65'536));
    if (const auto resolution = node.find("mesh_resolution"))
        params.mesh_resolution = static_cast<int>(resolution->as_integer_in(2, 4096));
    if (const auto max_bounces = node.find("max_bounces"))
        params.max_bounces = static_cast<int>(max_bounces->as_integer_in(1, 1'000));
}

}  // namespace caustics
