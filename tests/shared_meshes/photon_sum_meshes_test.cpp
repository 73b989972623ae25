#include <gtest/gtest.h>

#include "core/reference/light_trace.h"
#include "core/scene/scene_reader.h"
#include "photonmap/photon_map.h"
#include "tests/support/caustic_sum.h"
#include "tests/support/statistics.h"

namespace caustics {
namespace {

class PhotonSumOfRealScenes : public testing::TestWithParam<const char*> {};

/// Mean over 16 seeds.
support::Moments photon_sums(const Scene& scene, const photonmap::PhotonMapParams& params) {
    support::Moments found;
    RunOptions options;
    options.samples_per_pixel = 4;
    for (options.seed = 1; options.seed <= 16; ++options.seed)
        found.add(support::caustic_sum(scene, *build(scene, params, options), options));
    return found;
}

TEST_P(PhotonSumOfRealScenes, IsThatOfLightTracing) {
    const auto file = std::filesystem::path(CAUSTICS_SHARED_DIR) / "cases" / GetParam();
    const Scene scene(load_scene(file).desc);
    RunOptions options;
    options.samples_per_pixel = 4;
    const double truth = support::caustic_sum(
        scene, *build(scene, LightTraceParams{.paths = 4'000'000}, options), options);
    const support::Moments found = photon_sums(scene, {.photons = 40'000});
    EXPECT_NEAR(found.mean() / truth, 1, 0.01);
    EXPECT_LT(found.standard_error() / truth, 0.004);
}

INSTANTIATE_TEST_SUITE_P(Cases, PhotonSumOfRealScenes,
                         testing::Values("light/fold_pool_picture.json", "field/rock_glass.json",
                                         "field/teapot_glass.json"));

}  // namespace
}  // namespace caustics
