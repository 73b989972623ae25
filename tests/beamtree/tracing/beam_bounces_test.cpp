#include "beamtree/tracing/beam_bounces.h"

#include <gtest/gtest.h>

#include "beamtree/beam_tree.h"
#include "tests/support/build_scene.h"

namespace caustics::beamtree {
namespace {

// A speck within a ball of glass, so near its surface that it lies outside of the triangles between the places where the
// corners' light leaves: the light that goes on from all corners falls on it nonetheless.
TEST(BeamBounces, LightWhatLiesBetweenTrianglesAndTheSurface) {
    for (const double side : {-1.0, 1.0}) {
        SceneDesc desc;
        desc.shapes = {
            support::sphere("ball", {0, 0, 0}, 1, support::glass(1.5F)),
            support::horizontal("speck", side * 0.9998, 0.002, side < 0, support::diffuse(0.5F))};
        desc.lights = {support::directional_light({0.14, 0.03, side}, 1)};
        const Scene scene(std::move(desc));
        BeamTreeParams params;
        params.max_bounces = 2;
        params.mesh_resolution = 16;
        const ReceiverPoint point =
            support::probe(scene, 1, {0, 0, side * 0.9998}, {0, 0, -side}, 0);
        const auto found = support::irradiance(*build(scene, params, {}), {point});
        EXPECT_GT(found[0].value.mean(), 0.5F) << side;
    }
}

}  // namespace
}  // namespace caustics::beamtree
