#include "photonmap/estimate/radiance_estimate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "estimate_map.h"

namespace caustics::photonmap {
namespace {

using Estimator = PhotonMapParams::Estimator;
using test::floor_point;
using test::photon_at;
using Settings = RadianceEstimate::Settings;

struct Statistics {
    double mean = 0;
    double deviation = 0;
};

/// Irradiance at a grid of points whose discs do not overlap, over its true value.
Statistics relative_irradiance(const RadianceEstimate::Settings& settings) {
    constexpr std::size_t count = 200'000;
    constexpr int grid = 25;
    const test::EstimateMap map(test::uniform_field(count, 21));
    double sum = 0, squares = 0;
    for (const Spectrum& irradiance : map.irradiance(settings, test::square_grid(grid))) {
        const double value = static_cast<double>(irradiance[1]) / count;
        sum += value;
        squares += value * value;
    }
    const double n = grid * grid;
    return {sum / n, std::sqrt((squares - sum * sum / n) / (n - 1))};
}

TEST(RadianceEstimate, UnbiasedMeansTheTruthAndScattersAsItShould) {
    const Statistics s = relative_irradiance({.limits = {.nearest = 50, .max_radius = 1}});
    EXPECT_NEAR(s.deviation * std::sqrt(48), 1, 0.2);
    EXPECT_NEAR(s.mean, 1, 4 * s.deviation / 25);
}

// [J96 (4)] as printed.
TEST(RadianceEstimate, RawReadsHighByNOverNMinus1) {
    const Statistics unbiased = relative_irradiance({.limits = {.nearest = 10, .max_radius = 1}});
    const Statistics raw = relative_irradiance(
        {.limits = {.nearest = 10, .max_radius = 1}, .estimator = Estimator::raw});
    EXPECT_NEAR(raw.mean / unbiased.mean, 10.0 / 9.0, 1e-6);
    EXPECT_NEAR(unbiased.mean, 1, 4 * unbiased.deviation / 25);
}

TEST(RadianceEstimate, UnbiasedStaysSoWhereTheMaximumRadiusCutsIn) {
    // On average 20 photons lie within the maximum radius: about half of the queries find fewer
    // than N.
    const auto radius = static_cast<float>(std::sqrt(20 / (pi_d * 200'000)));
    const Statistics s = relative_irradiance({.limits = {.nearest = 20, .max_radius = radius}});
    EXPECT_NEAR(s.mean, 1, 4 * s.deviation / 25);
}

TEST(RadianceEstimate, FewerThanNSumOverTheMaximumDisc) {
    std::vector<Photon> photons{photon_at({0.1F, 0, 0}), photon_at({0, 0.2F, 0}),
                                photon_at({3, 0, 0})};
    for (const Estimator estimator : {Estimator::unbiased, Estimator::raw}) {
        const test::EstimateMap map(photons);
        const Settings settings{.limits = {.nearest = 3, .max_radius = 2},
                                .estimator = estimator,
                                .flux_unit = Spectrum(1, 2, 3)};
        const Spectrum value = map.irradiance(settings, floor_point({0, 0, 0}));
        EXPECT_EQ(map.count(settings, floor_point({0, 0, 0})), 2U);
        EXPECT_NEAR(value[0], 2 / (4 * pi), 1e-6);
        EXPECT_NEAR(value[2], 6 / (4 * pi), 1e-6);
        EXPECT_EQ(map.count(settings, floor_point({-9, 0, 0})), 0U);
        EXPECT_TRUE(is_black(map.irradiance(settings, floor_point({-9, 0, 0}))));
    }
}

TEST(RadianceEstimate, AnEmptyMapIsBlack) {
    EXPECT_TRUE(is_black(test::EstimateMap({}).radiance({}, floor_point({0, 0, 0}))));
}

// [J96 (1)] of a constant f_r: the flux [J96 (2)] over the disc's area [J96 (3)].
TEST(RadianceEstimate, LambertIsIrradianceOverPi) {
    const test::EstimateMap map(test::uniform_field(1'000, 22));
    const ReceiverPoint point = floor_point({0.5F, 0.5F, 0});
    const Spectrum irradiance = map.irradiance({}, point);
    const Spectrum radiance = map.radiance({}, point);
    EXPECT_NEAR(radiance[0] * pi / irradiance[0], 1, 1e-6);
}

TEST(RadianceEstimate, PhotonsFromBehindDoNotCount) {
    std::vector<Photon> photons;
    const DirectionCode down = encode_direction(-Vec3::UnitZ());
    for (int i = 0; i < 20; ++i) {
        Photon photon = photon_at({0.01F * static_cast<float>(i), 0, 0});
        if (i % 2 == 0) {
            photon.theta = down.theta;
            photon.phi = down.phi;
        }
        photons.push_back(photon);
    }
    const test::EstimateMap map(photons);
    const Settings settings{.limits = {.nearest = 5, .max_radius = 1}, .estimator = Estimator::raw};
    // From above photons 1, 3, 5, 7, 9 are the nearest five; from below 0, 2, 4, 6, 8.
    ReceiverPoint point = floor_point({0, 0, 0});
    EXPECT_NEAR(map.irradiance(settings, point)[0], 5 / (pi * 0.0081F), 0.05);
    point.geometric_normal = -Vec3::UnitZ();
    EXPECT_NEAR(map.irradiance(settings, point)[0], 5 / (pi * 0.0064F), 0.05);
}

TEST(RadianceEstimate, IsLinearInTheFlux) {
    const test::EstimateMap map(test::uniform_field(1'000, 23));
    const ReceiverPoint point = floor_point({0.3F, 0.6F, 0});
    const Settings thrice{.limits = {}, .flux_unit = Spectrum::Constant(3)};
    EXPECT_NEAR(map.radiance(thrice, point)[0] / map.radiance({}, point)[0], 3, 1e-6);
}

TEST(RadianceEstimate, CoincidentPhotonsGiveALargeFiniteValue) {
    for (const Vec3& x : {Vec3(0, 0, 0), Vec3(1, 2, 0)}) {
        const test::EstimateMap map(std::vector<Photon>(30, photon_at(x)));
        for (const FilterKind filter : {FilterKind::none, FilterKind::cone, FilterKind::gaussian})
            for (const Estimator estimator : {Estimator::unbiased, Estimator::raw}) {
                const Settings settings{.limits = {.nearest = 10, .max_radius = 1},
                                        .estimator = estimator,
                                        .filter = {filter}};
                const Spectrum value = map.irradiance(settings, floor_point(x));
                EXPECT_TRUE(is_finite(value));
                EXPECT_GT(value[0], 1e9F);
            }
    }
}

}  // namespace
}  // namespace caustics::photonmap
