#include <gtest/gtest.h>

#include "core/reference/light_trace.h"
#include "core/render/renderer.h"
#include "core/scene/scene_reader.h"
#include "photonmap/photon_map.h"
#include "tests/support/caustic_sum.h"
#include "tests/support/statistics.h"

namespace caustics {
namespace {

class PhotonSumOfRealScenes : public testing::TestWithParam<const char*> {};

TEST_P(PhotonSumOfRealScenes, IsThatOfLightTracing) {
    const auto file = std::filesystem::path(CAUSTICS_SHARED_DIR) / "cases" / GetParam();
    const Scene scene(load_scene(file).desc);
    RunOptions options;
    options.samples_per_pixel = 4;
    const Film truth =
        render(scene, *build(scene, LightTraceParams{.paths = 4'000'000}, options), options).film;
    support::Moments found;
    for (options.seed = 1; options.seed <= 25; ++options.seed) {
        const photonmap::PhotonMapParams params{.photons = 40'000};
        found.add(support::share_of_traced(
            render(scene, *build(scene, params, options), options).film, truth));
    }
    EXPECT_NEAR(found.mean(), 1, 0.01);
    EXPECT_LT(found.standard_error(), 0.004);
}

INSTANTIATE_TEST_SUITE_P(Cases, PhotonSumOfRealScenes,
                         testing::Values("light/fold_pool_picture.json", "field/rock_glass.json",
                                         "field/teapot_glass.json"));

}  // namespace
}  // namespace caustics
