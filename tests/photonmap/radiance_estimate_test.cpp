#include "photonmap/radiance_estimate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "photon_sets.h"

namespace caustics {
namespace {

using Estimator = PhotonMapParams::Estimator;
using test::photon_at;

const Bsdf white{Diffuse{Spectrum(Spectrum::Ones())}};

ReceiverPoint point_at(const Vec3& x) {
    ReceiverPoint point;
    point.position = x;
    point.geometric_normal = point.shading_normal = point.wo = Vec3::UnitZ();
    point.uv = Vec2::Zero();
    point.bsdf = &white;
    return point;
}

/// A balanced map and the estimate over it.
class Map {
public:
    Map(const std::vector<Photon>& photons, const RadianceEstimate::Settings& settings)
        : tree_(build_tree(TreeKind::balanced, test::store_of(photons), widest_isa())),
          settings_(settings),
          estimate_(settings, widest_isa()) {}

    Spectrum radiance(const ReceiverPoint& point) const {
        return evaluated(point, &RadianceEstimate::radiance);
    }
    Spectrum irradiance(const ReceiverPoint& point) const {
        return evaluated(point, &RadianceEstimate::irradiance);
    }
    std::size_t count(const ReceiverPoint& point) const {
        std::size_t count = 0;
        GatherScratch scratch;
        tree_->gather({&point, 1}, settings_.limits, scratch,
                      [&](std::size_t, const GatheredPhotons& found) { count = found.count; });
        return count;
    }

private:
    using Value = Spectrum (RadianceEstimate::*)(const ReceiverPoint&,
                                                 const GatheredPhotons&) const;
    Spectrum evaluated(const ReceiverPoint& point, Value value) const {
        Spectrum result;
        GatherScratch scratch;
        tree_->gather({&point, 1}, settings_.limits, scratch,
                      [&](std::size_t, const GatheredPhotons& found) {
                          result = (estimate_.*value)(point, found);
                      });
        return result;
    }

    std::unique_ptr<const PhotonTree> tree_;
    RadianceEstimate::Settings settings_;
    RadianceEstimate estimate_;
};

/// `count` photons at random on the unit square.
std::vector<Photon> uniform_square(std::size_t count, std::uint64_t seed) {
    Rng rng(seed, Stage::test, 0);
    std::vector<Photon> photons;
    for (std::size_t i = 0; i < count; ++i) {
        const float x = rng.next(), y = rng.next();
        photons.push_back(photon_at({x, y, 0}));
    }
    return photons;
}

struct Statistics {
    double mean = 0;
    double deviation = 0;
};

/// Irradiance at a grid of points whose discs do not overlap, over its true value.
Statistics relative_irradiance(const RadianceEstimate::Settings& settings) {
    constexpr std::size_t count = 200'000;
    constexpr int grid = 25;
    const std::vector<Photon> photons = uniform_square(count, 21);
    const Map estimate(photons, settings);
    double sum = 0, squares = 0;
    for (int i = 0; i < grid * grid; ++i) {
        const float x = (static_cast<float>(i % grid) + 0.5F) / grid;
        const float y = (static_cast<float>(i / grid) + 0.5F) / grid;
        const double value =
            static_cast<double>(estimate.irradiance(point_at({x, y, 0}))[1]) / count;
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
        const Map estimate(photons, {.limits = {.nearest = 3, .max_radius = 2},
                                     .estimator = estimator,
                                     .flux_unit = Spectrum(1, 2, 3)});
        const Spectrum value = estimate.irradiance(point_at({0, 0, 0}));
        EXPECT_EQ(estimate.count(point_at({0, 0, 0})), 2U);
        EXPECT_NEAR(value[0], 2 / (4 * pi), 1e-6);
        EXPECT_NEAR(value[2], 6 / (4 * pi), 1e-6);
        EXPECT_EQ(estimate.count(point_at({-9, 0, 0})), 0U);
        EXPECT_TRUE(is_black(estimate.irradiance(point_at({-9, 0, 0}))));
    }
}

TEST(RadianceEstimate, AnEmptyMapIsBlack) {
    const Map estimate({}, {});
    EXPECT_TRUE(is_black(estimate.radiance(point_at({0, 0, 0}))));
}

TEST(RadianceEstimate, LambertIsIrradianceOverPi) {
    const std::vector<Photon> photons = uniform_square(1'000, 22);
    const Map estimate(photons, {});
    const ReceiverPoint point = point_at({0.5F, 0.5F, 0});
    const Spectrum irradiance = estimate.irradiance(point);
    const Spectrum radiance = estimate.radiance(point);
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
    const Map estimate(photons,
                       {.limits = {.nearest = 5, .max_radius = 1}, .estimator = Estimator::raw});
    // From above photons 1, 3, 5, 7, 9 are the nearest five; from below 0, 2, 4, 6, 8.
    ReceiverPoint point = point_at({0, 0, 0});
    EXPECT_NEAR(estimate.irradiance(point)[0], 5 / (pi * 0.0081F), 0.05);
    point.geometric_normal = -Vec3::UnitZ();
    EXPECT_NEAR(estimate.irradiance(point)[0], 5 / (pi * 0.0064F), 0.05);
}

TEST(RadianceEstimate, IsLinearInTheFlux) {
    const std::vector<Photon> photons = uniform_square(1'000, 23);
    const ReceiverPoint point = point_at({0.3F, 0.6F, 0});
    const Map once(photons, {});
    const Map thrice(photons, {.limits = {}, .flux_unit = Spectrum::Constant(3)});
    EXPECT_NEAR(thrice.radiance(point)[0] / once.radiance(point)[0], 3, 1e-6);
}

TEST(RadianceEstimate, CoincidentPhotonsGiveALargeFiniteValue) {
    for (const Vec3& x : {Vec3(0, 0, 0), Vec3(1, 2, 0)}) {
        std::vector<Photon> photons(30, photon_at(x));
        for (const Estimator estimator : {Estimator::unbiased, Estimator::raw}) {
            const Map estimate(
                photons, {.limits = {.nearest = 10, .max_radius = 1}, .estimator = estimator});
            const Spectrum value = estimate.irradiance(point_at(x));
            EXPECT_TRUE(is_finite(value));
            EXPECT_GT(value[0], 1e9F);
        }
    }
}

}  // namespace
}  // namespace caustics
