#include <gtest/gtest.h>

#include "core/reference/light_trace.h"
#include "core/render/renderer.h"
#include "photonmap/photon_map.h"
#include "tests/support/build_scene.h"
#include "tests/support/caustic_sum.h"
#include "tests/support/statistics.h"

namespace caustics {
namespace {

using photonmap::KernelKind;
using photonmap::PhotonMapParams;

/// A pool so deep that its light folds, in parallel light from above.
SceneDesc folded_pool() {
    SceneDesc desc;
    Shape water;
    water.name = "water";
    water.primitive = Primitive::heightfield;
    water.field.half_size = Vec2d::Constant(2);
    water.field.waves = {{0.03, {9, -12}, 0.7}};
    water.to_world = Eigen::Translation3d(0, 0, 0.9);
    water.bsdf = support::glass(1.33F);
    desc.shapes = {support::horizontal("floor", 0, 1.5, true, support::diffuse(0.5F)), water};
    desc.lights = {support::directional_light({0.1, -0.05, -1}, 1)};
    desc.camera = support::camera({0, 0, 0.8}, {0.05, 0.1, 0}, {0, 1, 0}, 65, 32, 32);
    return desc;
}

Film traced(const Scene& scene) {
    RunOptions options;
    options.samples_per_pixel = 4;
    return render(scene, *build(scene, LightTraceParams{.paths = 4'000'000}, options), options)
        .film;
}

/// The pictures' sums over the traced one's.
support::Moments shares(const Scene& scene, const PhotonMapParams& params, const Film& truth) {
    support::Moments found;
    RunOptions options;
    options.samples_per_pixel = 4;
    for (options.seed = 1; options.seed <= 25; ++options.seed)
        found.add(support::share_of_traced(
            render(scene, *build(scene, params, options), options).film, truth));
    return found;
}

// The N nearest of a dark point reach the bright folds, and the picture has too much light; discs of the photons' own
// keep it.
TEST(PhotonSum, OfAFoldedPoolIsThatOfLightTracing) {
    const Scene scene(folded_pool());
    const Film truth = traced(scene);
    for (const std::uint64_t photons : {40'000U, 120'000U}) {
        const support::Moments own = shares(scene, {.photons = photons}, truth);
        EXPECT_NEAR(own.mean(), 1, 0.01) << photons;
        EXPECT_LT(own.standard_error(), 0.004);
        const support::Moments at_points =
            shares(scene, {.photons = photons, .pixel_footprint = false}, truth);
        EXPECT_NEAR(at_points.mean(), 1, 0.01) << photons;
    }
    const PhotonMapParams nearest{.photons = 40'000, .kernel = KernelKind::point};
    EXPECT_GT(shares(scene, nearest, truth).mean(), 1.03);
}

}  // namespace
}  // namespace caustics
