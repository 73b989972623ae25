#include "photonmap/estimate/max_radius.h"

#include <gtest/gtest.h>

#include <cmath>

#include "photon_sets.h"

namespace caustics::photonmap {
namespace {

using test::photon_at;

const Box scene_bounds(Vec3(-2, -2, 0), Vec3(2, 2, 0));

std::vector<Photon> uniform_square(std::size_t count) {
    Rng rng(31, Stage::test, 0);
    std::vector<Photon> photons;
    for (std::size_t i = 0; i < count; ++i) {
        const float x = rng.next(), y = rng.next();
        photons.push_back(photon_at({x, y, 0}));
    }
    return photons;
}

TEST(DefaultMaxRadius, IsThriceThatOfNPhotonsSpreadEvenly) {
    for (const std::size_t count : {1'000U, 50'000U}) {
        const double area = 0.98 * 0.98;
        const double expected = 3 * std::sqrt(50 * area / (pi_d * static_cast<double>(count)));
        EXPECT_NEAR(default_max_radius(uniform_square(count), scene_bounds, 50) / expected, 1,
                    0.02);
    }
}

TEST(DefaultMaxRadius, HardlyHeedsStrays) {
    std::vector<Photon> photons = uniform_square(10'000);
    const double before = default_max_radius(photons, scene_bounds, 50);
    for (std::size_t i = 0; i < 10'000; i += 200) photons[i] = photon_at({1e3F, 1e3F, 1e3F});
    EXPECT_NEAR(default_max_radius(photons, scene_bounds, 50) / before, 1, 0.02);
}

TEST(DefaultMaxRadius, FallsBackOnTheSceneWherePhotonsSpanNoArea) {
    const std::vector<Photon> coincident(100, photon_at({1, 1, 0}));
    EXPECT_DOUBLE_EQ(default_max_radius(coincident, scene_bounds, 25),
                     3 * std::sqrt(25 * 16 / (pi_d * 100)));
    EXPECT_DOUBLE_EQ(default_max_radius({}, scene_bounds, 25), 3 * std::sqrt(25 * 16 / pi_d));
}

}  // namespace
}  // namespace caustics::photonmap
