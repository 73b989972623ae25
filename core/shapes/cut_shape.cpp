#include "core/shapes/cut_shape.h"

#include "core/exact_shapes/shape_keys.h"

#include <cmath>

#include "core/geometry/cut_solid.h"
#include "core/shapes/lathe_shape.h"

namespace caustics::scene_file {
namespace {

CutRing read_ring(const JsonNode& node) {
    CutRing ring;
    ring.count = static_cast<int>(node.at("count").as_integer_in(1, CutSolid::most_planes));
    ring.angle = node.at("angle").as_number_in(-90, 90);
    ring.distance = node.at("distance").as_number_in(-unlimited, unlimited);
    if (const auto phase = node.find("phase")) ring.phase = phase->as_number_in(-1000, 1000);
    node.finish();
    return ring;
}

HalfSpace read_plane(const JsonNode& node) {
    const std::vector<double> numbers = node.as_numbers(4);
    const Vec3d normal(numbers[0], numbers[1], numbers[2]);
    const double length = normal.stableNorm();
    if (!(length > 0)) node.fail("the normal must not be zero");
    const HalfSpace plane{normal / length, numbers[3] / length};
    if (!(std::abs(plane.distance) <= unlimited)) node.fail("is out of range (to 1e+30)");
    return plane;
}

LatheProfile read_inner(const JsonNode& node) {
    const LatheProfile profile = read_profile(node);
    node.finish();
    return profile;
}

}  // namespace

TriangleMesh read_cut(const JsonNode& node, const std::optional<JsonNode>& resolution) {
    CutSolid solid;
    if (const auto rings = node.find("rings"))
        for (const JsonNode& ring : rings->as_array())
            for (const HalfSpace& plane : half_spaces(read_ring(ring)))
                solid.planes.push_back(plane);
    if (const auto planes = node.find("planes"))
        for (const JsonNode& plane : planes->as_array()) solid.planes.push_back(read_plane(plane));
    if (const auto height = node.find("height"))
        solid.height = height->as_number_in(-unlimited, unlimited);
    if (const auto inner = node.find("inner")) solid.inner = read_inner(*inner);
    if (resolution) {
        if (!solid.inner) resolution->fail("only a bowl's `inner` surface has sectors");
        solid.inner_sectors = static_cast<int>(resolution->as_integer_in(3, 4096));
    }
    return load_for(node, [&] { return tessellate_cut(solid); });
}

Objects cut_keys() {
    KeyText inner{.key = "inner",
                  .meaning = "Of a bowl: a smooth inside, from the rim at the height to the axis.",
                  .type = "object",
                  .usual = "none"};
    return {
        {"cut",
         "A shape, a mesh: a gem or a cut bowl with flat facets, what is common to at most 200 "
         "half-spaces.",
         joined(turned_keys("Sectors of the inside."),
                {{.key = "rings",
                  .meaning = "Facets round z.",
                  .type = "list of rings",
                  .usual = "none"},
                 {.key = "planes",
                  .meaning = "Facets that look to (nx, ny, nz), d over its length from the origin.",
                  .unit = "m",
                  .type = "list of [nx, ny, nz, d]",
                  .usual = "none"},
                 number("height", "Cuts the top off at this z.", "m", "none", "-1e+30 to 1e+30"),
                 inner})},
        {"ring",
         "An element of rings.",
         {whole("count", "Of the ring's facets.", "", "", "1 to 200"),
          number("angle", "Elevation of what the facets look to: 0 outwards, 90 up, -90 down.",
                 "degrees", "", "-90 to 90"),
          number("distance", "Of the facets' planes from the origin.", "m", "", "-1e+30 to 1e+30"),
          number("phase", "Turns the ring, by facets; at 0 the first looks to +x.", "facets", "0",
                 "-1000 to 1000")}},
        {"inner", "In a cut.", profile_keys()}};
}

}  // namespace caustics::scene_file
