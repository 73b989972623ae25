#include "photonmap/estimate/density_filter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "estimate_map.h"
#include "tests/support/statistics.h"

namespace caustics::photonmap {
namespace {

using Estimator = PhotonMapParams::Estimator;
using test::EstimateMap;
using test::floor_point;

constexpr FilterKind kinds[] = {FilterKind::none, FilterKind::cone, FilterKind::gaussian,
                                FilterKind::epanechnikov};

/// The integral over u from 0 to 1.
template <typename Function>
double integral(const Function& f) {
    constexpr int steps = 100'000;
    double sum = 0;
    for (int i = 0; i < steps; ++i) sum += f((i + 0.5) / steps) / steps;
    return sum;
}

double polynomial_at(const FilterPolynomial& filter, double u) {
    const double x = filter.of_distance ? std::sqrt(u) : u;
    double value = 0;
    for (std::size_t n = filter.degree + 1; n-- > 0;)
        value = value * x + static_cast<double>(filter.coefficient[n]);
    return value;
}

TEST(DensityFilter, WeightsHaveAMeanOfOneOverTheDisc) {
    for (const FilterKind kind : kinds) {
        SCOPED_TRACE(name(kind));
        EXPECT_NEAR(integral([&](double u) { return DensityFilter{kind}.weight(u); }), 1, 1e-7);
        const FilterPolynomial polynomial = DensityFilter{kind}.polynomial();
        EXPECT_NEAR(integral([&](double u) { return polynomial_at(polynomial, u); }), 1, 1e-6);
    }
}

TEST(DensityFilter, AreThoseOfTheirSources) {
    EXPECT_NEAR(DensityFilter{FilterKind::cone}.weight(0.25), (1 - 0.5 / 1.1) / (1 - 2 / 3.3),
                1e-12);
    const double jensen = 0.918 * (1 - (1 - std::exp(-1.953 * 0.3 / 2)) / (1 - std::exp(-1.953)));
    EXPECT_NEAR(DensityFilter{FilterKind::gaussian}.weight(0.3), jensen / 0.5311, 2e-4);
    EXPECT_NEAR(DensityFilter{FilterKind::epanechnikov}.weight(0.25), 1.5, 1e-12);
}

TEST(DensityFilter, TakeTheNumbersOfTheLiterature) {
    for (const double k : {1.0, 2.5}) {
        const DensityFilter cone{.kind = FilterKind::cone, .k = k};
        EXPECT_NEAR(cone.weight(0.36), (1 - 0.6 / k) / (1 - 2 / (3 * k)), 1e-12);
        EXPECT_NEAR(integral([&](double u) { return polynomial_at(cone.polynomial(), u); }), 1,
                    1e-6);
    }
    for (const double beta : {0.1, 1.0, 3.0, 8.0}) {
        const DensityFilter even{.kind = FilterKind::gaussian, .beta = beta};
        const FilterPolynomial polynomial = even.polynomial();
        const DensityFilter printed{.kind = FilterKind::gaussian, .beta = beta, .alpha = 0.918};
        EXPECT_NEAR(integral([&](double u) { return even.weight(u); }), 1, 1e-7);
        for (const double u : {0.0, 0.2, 0.7, 1.0}) {
            EXPECT_NEAR(polynomial_at(polynomial, u), even.weight(u), beta > 3 ? 1e-5 : 1e-6)
                << beta;
            EXPECT_NEAR(printed.weight(u),
                        0.918 * (1 - (1 - std::exp(-beta * u / 2)) / (1 - std::exp(-beta))), 1e-12);
        }
    }
    const DensityFilter jensen{.kind = FilterKind::gaussian, .alpha = 0.918};
    EXPECT_NEAR(integral([&](double u) { return jensen.weight(u); }), 0.531, 1e-3);
}

TEST(DensityFilter, KernelsAreTheFormulaAndTheSameBitsOnEveryInstructionSet) {
    constexpr std::size_t count = 1'003;
    std::vector<float> squared_distance(count + 16);
    for (std::size_t i = 0; i < count; ++i)
        squared_distance[i] = 7 * static_cast<float>(i) / (count - 1);
    const GatheredPhotons photons{
        .squared_distance = squared_distance.data(), .count = count, .farthest = count - 1};
    for (const FilterKind kind : kinds) {
        std::vector<float> plain(count + 16), weight(count + 16);
        Shading(Isa::plain).weigh(DensityFilter{kind}.polynomial(), photons, 7, plain.data());
        for (const Isa isa : supported_isas()) {
            Shading(isa).weigh(DensityFilter{kind}.polynomial(), photons, 7, weight.data());
            for (std::size_t i = 0; i < count; ++i) {
                ASSERT_EQ(weight[i], plain[i]) << name(kind) << " " << name(isa) << " " << i;
                const double u = static_cast<double>(squared_distance[i]) / 7;
                ASSERT_NEAR(static_cast<double>(weight[i]), DensityFilter{kind}.weight(u), 1e-6);
            }
        }
    }
}

/// Photons on the unit square, and points so far apart that their answers hardly depend on
/// each other.
class UniformField : public testing::Test {
protected:
    static constexpr std::size_t photons = 1'000'000;
    static constexpr int side = 180;

    static void SetUpTestSuite() {
        map_ = std::make_unique<EstimateMap>(test::uniform_field(photons, 41));
    }
    static void TearDownTestSuite() { map_.reset(); }

    static support::Moments relative_irradiance(const RadianceEstimate::Settings& settings) {
        support::Moments moments;
        for (const Spectrum& value : map_->irradiance(settings, test::square_grid(side)))
            moments.add(static_cast<double>(value[0]) / photons);
        return moments;
    }
    /// Of a disc that holds so many photons on average.
    static float radius_of(double count) {
        return static_cast<float>(std::sqrt(count / (pi_d * photons)));
    }

    static std::unique_ptr<EstimateMap> map_;
};
std::unique_ptr<EstimateMap> UniformField::map_;

TEST_F(UniformField, EveryFilterMeansTheTruth) {
    const std::pair<const char*, GatherLimits> limits[] = {
        {"the 20 nearest", {20, 1}},
        {"a radius", {GatherLimits::all, radius_of(20)}},
        {"the 20 nearest where half of the points find fewer", {20, radius_of(19.5)}}};
    for (const FilterKind kind : kinds)
        for (const auto& [what, limit] : limits) {
            const auto moments = relative_irradiance({.limits = limit, .filter = {.kind = kind}});
            EXPECT_NEAR(moments.mean(), 1, 0.005) << name(kind) << ", " << what;
            EXPECT_NEAR(moments.mean(), 1, 4 * moments.standard_error());
        }
}

TEST_F(UniformField, RawReadsHighByTheWeightAtTheRim) {
    const GatherLimits limits{10, 1};
    const double plain = relative_irradiance({.limits = limits}).mean();
    for (const FilterKind kind : kinds) {
        RadianceEstimate::Settings settings{.limits = limits, .filter = {.kind = kind}};
        const double unbiased = relative_irradiance(settings).mean();
        settings.estimator = Estimator::raw;
        EXPECT_NEAR(relative_irradiance(settings).mean() - unbiased,
                    plain * DensityFilter{kind}.weight(1) / 9, 2e-6)
            << name(kind);
    }
}

TEST_F(UniformField, FiltersScatterByTheirMeanSquareWeight) {
    // At a fixed radius with n photons on average the variance is that of a Poisson number times
    // the mean square weight.
    for (const FilterKind kind : kinds) {
        const auto moments = relative_irradiance(
            {.limits = {GatherLimits::all, radius_of(25)}, .filter = {.kind = kind}});
        const double square =
            integral([&](double u) { return std::pow(DensityFilter{kind}.weight(u), 2); });
        EXPECT_NEAR(moments.deviation() / std::sqrt(square / 25), 1, 0.03) << name(kind);
    }
}

/// The share of a disc's weight beyond a straight line at `distance` radii from its centre.
double share_beyond(FilterKind kind, double distance) {
    const auto ring = [&](double u) {
        const double r = std::sqrt(u);
        const double angle =
            r <= std::abs(distance) ? (distance > 0 ? 0 : pi_d) : std::acos(distance / r);
        return DensityFilter{kind}.weight(u) * angle / pi_d;
    };
    return integral(ring);
}

TEST(DensityFilter, SmearsAStraightEdgeAsItsProfileSays) {
    // Light on [0, 1] x [0, 1] and darkness to its left; what is left of the step at points on both
    // sides of it, averaged along the edge.
    constexpr float radius = 0.02F;
    constexpr std::size_t photons = 400'000;
    const EstimateMap map(test::uniform_field(photons, 42));
    for (const FilterKind kind : kinds) {
        const RadianceEstimate::Settings settings{.limits = {GatherLimits::all, radius},
                                                  .filter = {.kind = kind}};
        for (const float offset : {-0.75F, -0.5F, -0.25F, 0.0F, 0.25F, 0.5F}) {
            std::vector<ReceiverPoint> points;
            for (int i = 0; i < 200; ++i)
                points.push_back(
                    floor_point({offset * radius, 0.02F + 0.96F * static_cast<float>(i) / 199, 0}));
            double mean = 0;
            for (const Spectrum& value : map.irradiance(settings, points))
                mean += static_cast<double>(value[0]) / photons / 200;
            EXPECT_NEAR(mean, share_beyond(kind, -static_cast<double>(offset)), 0.015)
                << name(kind) << " at " << offset;
        }
    }
}

TEST(DensityFilter, KeepsAnEdgeSharperThanNoFilterAtTheSameRadius) {
    const double uniform = share_beyond(FilterKind::none, 0.4);
    for (const FilterKind kind : {FilterKind::cone, FilterKind::gaussian, FilterKind::epanechnikov})
        EXPECT_LT(share_beyond(kind, 0.4), 0.85 * uniform) << name(kind);
}

}  // namespace
}  // namespace caustics::photonmap
