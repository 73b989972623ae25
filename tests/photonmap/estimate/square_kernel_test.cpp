#include "photonmap/estimate/square_kernel.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/math/plane_axes.h"
#include "tests/photonmap/estimate_map.h"
#include "tests/support/statistics.h"

namespace caustics::photonmap {
namespace {

using test::EstimateMap;
using test::floor_point;

constexpr FilterKind kinds[] = {FilterKind::none, FilterKind::cone, FilterKind::gaussian,
                                FilterKind::epanechnikov};

/// The integral of f from a to b.
template <typename Function>
double integral(double a, double b, const Function& f) {
    constexpr int steps = 2'000;
    double sum = 0;
    for (int i = 0; i < steps; ++i) sum += f(a + (b - a) * (i + 0.5) / steps);
    return sum * (b - a) / steps;
}

/// The integral of f from 0 to the places of an even grid up to `end`.
template <typename Function>
std::vector<double> running_integral(double end, const Function& f) {
    constexpr int steps = 5'000;
    std::vector<double> sums{0};
    for (int i = 0; i < steps; ++i)
        sums.push_back(sums.back() + f(end * (i + 0.5) / steps) * end / steps);
    return sums;
}

double at(const std::vector<double>& table, double place) {
    const double x = place * static_cast<double>(table.size() - 1);
    const auto before = std::min(static_cast<std::size_t>(x), table.size() - 2);
    return table[before] + (x - static_cast<double>(before)) * (table[before + 1] - table[before]);
}

/// The filter's weight along an axis, with the integral 1 over [-1, 1], from its formula.
class Profile {
public:
    explicit Profile(FilterKind kind)
        : sums_(running_integral(1,
                                 [kind](double z) { return DensityFilter{kind}.weight(z * z); })) {}

    double below(double z) const {
        return std::copysign(at(sums_, std::min(std::abs(z), 1.0)) / (2 * sums_.back()), z);
    }
    /// Of a photon's kernel at x, of half width h, the share on a square of half side s.
    double share(double x, double s, double h) const {
        return below((x + s) / h) - below((x - s) / h);
    }

private:
    std::vector<double> sums_;
};

RadianceEstimate::Settings averaged(GatherLimits limits, FilterKind kind, double side) {
    limits.positions = true;
    limits.margin = static_cast<float>(RadianceEstimate::margin_of(side));
    return {.limits = limits, .filter = {.kind = kind}, .footprint = side};
}

/// How a kernel of a fixed radius lies.
SquareKernel::Reach reach_of(FilterKind kind, double side, double radius) {
    return SquareKernel({.kind = kind}, side, 1).reach(radius);
}

TEST(SquareKernel, WeighsByItsFormulaAndTheSameBitsOnEveryInstructionSet) {
    constexpr std::size_t count = 501;
    std::vector<float> x(count + 16), y(count + 16), z(count + 16), plain(count + 16),
        weight(count + 16);
    for (std::size_t i = 0; i < count; ++i) {
        x[i] = 5 + 0.008F * (static_cast<float>(i) - 250);
        y[i] = 3 + 0.3F * std::sin(static_cast<float>(i));
        z[i] = static_cast<float>(i);
    }
    const GatheredPhotons photons{.count = count, .position = {x.data(), y.data(), z.data()}};
    const ReceiverPoint point = floor_point({5, 3, 0});
    for (const FilterKind kind : kinds) {
        const SquareKernel kernel({.kind = kind}, 1.2, 1);
        const SquareKernel::Reach reach = kernel.reach(1);
        EXPECT_EQ(reach.half, 0.6);
        EXPECT_LE(reach.reach, std::sqrt(0.5));
        Shading(Isa::plain).weigh_on_square(kernel, reach, point, photons, plain.data());
        for (const Isa isa : supported_isas()) {
            Shading(isa).weigh_on_square(kernel, reach, point, photons, weight.data());
            for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(weight[i], plain[i]) << name(isa);
        }
        const Profile profile(kind);
        for (std::size_t i = 0; i < count; i += 10)
            ASSERT_NEAR(static_cast<double>(plain[i]),
                        profile.share(static_cast<double>(x[i]) - 5, 0.6, reach.reach) *
                            profile.share(static_cast<double>(y[i]) - 3, 0.6, reach.reach),
                        3e-6)
                << name(kind) << " " << i;
    }
}

TEST(SquareKernel, WeighsOnATiltedPlaneAsOnALevelOne) {
    constexpr std::size_t count = 200;
    const SquareKernel kernel({.kind = FilterKind::cone}, 1.2, 1);
    std::vector<std::vector<float>> found;
    for (const Vec3d& normal : {Vec3d(0, 0, 1), Vec3d(0.48, 0.64, 0.6), Vec3d(0.6, 0, -0.8)}) {
        const PlaneAxes axes(normal);
        const Vec3 centre(5, 3, 1);
        std::array<std::vector<float>, 3> at;
        for (std::vector<float>& each : at) each.resize(count + 16);
        for (std::size_t i = 0; i < count; ++i) {
            const double turn = static_cast<double>(i);
            const Vec3d off =
                0.01 * turn / 2 * (std::cos(turn) * axes.right + std::sin(turn) * axes.forward);
            for (std::size_t c = 0; c < 3; ++c)
                at[c][i] = (centre + off.cast<float>())[static_cast<Eigen::Index>(c)];
        }
        const GatheredPhotons photons{.count = count,
                                      .position = {at[0].data(), at[1].data(), at[2].data()}};
        ReceiverPoint point = floor_point(centre);
        point.geometric_normal = normal.cast<float>();
        found.emplace_back(count + 16);
        Shading(Isa::plain)
            .weigh_on_square(kernel, kernel.reach(1), point, photons, found.back().data());
    }
    for (std::size_t i = 0; i < count; ++i) {
        EXPECT_NEAR(found[1][i], found[0][i], 1e-4F) << i;
        EXPECT_NEAR(found[2][i], found[0][i], 1e-4F) << i;
    }
    EXPECT_GT(found[0][1], 0.1F);
    EXPECT_LT(found[0][count - 1], found[0][1] / 2);
}

// g'(a) by differences of what the disc holds of the weights' integral.
TEST(SquareKernel, TheRimWeighsWhatALargerDiscGains) {
    for (const FilterKind kind : kinds)
        for (const double share : {1.0, 0.3}) {
            const SquareKernel kernel({.kind = kind}, 1, share);
            const Profile profile(kind);
            const auto held = [&](double r) {
                const double h = kernel.reach(r).reach;
                const auto t = [&](double x) { return profile.share(x, 0.5, h); };
                const std::vector<double> column = running_integral(r, t);
                return 4 * integral(0, 1, [&](double x) {
                           const double angle = x * pi_d / 2;
                           return t(r * std::sin(angle)) * at(column, std::cos(angle)) * r *
                                  std::cos(angle) * pi_d / 2;
                       });
            };
            for (const double r : {0.05, 0.3, 0.5, 0.6, 0.8, 1.3, 3.0, 10.0}) {
                const double step = 0.002 * r;
                const double gained = (held(r + step) - held(r - step)) / (4 * pi_d * r * step);
                EXPECT_NEAR(kernel.reach(r).rim, gained, 4e-3) << name(kind) << " " << r;
            }
        }
}

/// Photons on the unit square, and points so far apart that their answers hardly depend on each other.
class SquareField : public testing::Test {
protected:
    static constexpr std::size_t photons = 250'000;
    static constexpr int side = 90;

    static void SetUpTestSuite() {
        map_ = std::make_unique<EstimateMap>(test::uniform_field(photons, 71));
    }
    static void TearDownTestSuite() { map_.reset(); }

    static support::Moments relative_irradiance(const RadianceEstimate::Settings& settings) {
        support::Moments moments;
        for (const Spectrum& value : map_->irradiance(settings, test::square_grid(side)))
            moments.add(static_cast<double>(value[0]) / photons);
        return moments;
    }
    static float radius_of(double count) {
        return static_cast<float>(std::sqrt(count / (pi_d * photons)));
    }
    /// Of a square that holds so many photons on average.
    static double side_of(double count) { return std::sqrt(count / photons); }

    static std::unique_ptr<EstimateMap> map_;
};
std::unique_ptr<EstimateMap> SquareField::map_;

TEST_F(SquareField, EveryKernelMeansTheTruth) {
    const std::pair<const char*, GatherLimits> limits[] = {
        {"the 5 nearest", {5, 1}},
        {"a radius", {GatherLimits::all, radius_of(10)}},
        {"the 10 nearest where half of the points find fewer", {10, radius_of(9.5)}}};
    for (const FilterKind kind : kinds)
        for (const double held : {1e-4, 1.0, 5.0, 30.0})
            for (const auto& [what, limit] : limits) {
                const auto moments = relative_irradiance(averaged(limit, kind, side_of(held)));
                EXPECT_NEAR(moments.mean(), 1, 4 * moments.standard_error())
                    << name(kind) << ", " << what << ", squares that hold " << held;
                EXPECT_LT(moments.standard_error(), 0.011);
            }
}

TEST_F(SquareField, EveryPassMeansTheTruth) {
    for (const double share : {0.7, 0.2}) {
        auto settings = averaged({5, 1}, FilterKind::epanechnikov, side_of(5));
        settings.share = share;
        const auto moments = relative_irradiance(settings);
        EXPECT_NEAR(moments.mean(), 1, 4 * moments.standard_error()) << share;
    }
}

// A Poisson number times the mean square weight; 1 / count where the kernel is narrow.
TEST_F(SquareField, ScattersByItsMeanSquareWeight) {
    for (const FilterKind kind : kinds)
        for (const auto& [held, around] : {std::pair{25.0, 1e-3}, {25.0, 20.0}, {2.0, 40.0}}) {
            const double s = side_of(held);
            const double r = static_cast<double>(radius_of(around));
            const auto reach = reach_of(kind, s, r);
            const Profile profile(kind);
            const double end = reach.half + reach.reach;
            const double square =
                integral(-end, end,
                         [&](double x) {
                             return std::pow(profile.share(x, reach.half, reach.reach), 2);
                         }) /
                (4 * reach.half * reach.half);
            const double variance = square * square / photons;
            const auto moments =
                relative_irradiance(averaged({GatherLimits::all, static_cast<float>(r)}, kind, s));
            EXPECT_NEAR(moments.deviation() / std::sqrt(variance), 1, 0.04)
                << name(kind) << " " << held << " " << around;
            if (around < 1) {
                EXPECT_NEAR(variance * held, 1, 0.02);
            }
        }
}

// With a kernel that is narrow against the square it is the count of the photons in it, over the area.
TEST(SquareKernel, CountsThePhotonsInTheSquare) {
    const std::vector<Photon> photons = test::uniform_field(20'000, 72);
    const EstimateMap map(photons);
    const float side = 0.05F;
    const auto settings =
        averaged({GatherLimits::all, 1e-6F}, FilterKind::none, static_cast<double>(side));
    for (const ReceiverPoint& point : test::square_grid(8)) {
        // A photon within the kernel's width of a side counts in part.
        float inside = 0, near = 0;
        for (const Photon& photon : photons) {
            const float x = std::abs(photon.position[0] - point.position.x());
            const float y = std::abs(photon.position[1] - point.position.y());
            inside += std::max(x, y) < side / 2 - 1e-6F ? 1.0F : 0.0F;
            near += std::max(x, y) < side / 2 + 1e-6F ? 1.0F : 0.0F;
        }
        const float found = map.irradiance(settings, point)[0] * side * side;
        EXPECT_GE(found, inside - 1e-4F);
        EXPECT_LE(found, near + 1e-4F);
        EXPECT_GT(inside, 20);
    }
}

// Light that grows evenly, and points whose squares and kernels lie within it.
TEST(SquareKernel, MeansTheMiddleOfALinearField) {
    constexpr std::size_t count = 250'000;
    std::vector<Photon> photons = test::uniform_field(count, 73);
    for (Photon& photon : photons) photon.position[0] = std::sqrt(photon.position[0]);
    const EstimateMap map(photons);
    for (const FilterKind kind : kinds)
        for (const double side : {0.002, 0.03})
            for (const GatherLimits& limits :
                 {GatherLimits{GatherLimits::all, 0.01F}, GatherLimits{20, 1}}) {
                std::vector<ReceiverPoint> points;
                for (int i = 0; i < 900; ++i)
                    points.push_back(floor_point({0.3F + 0.02F * static_cast<float>(i % 30),
                                                  0.05F + 0.03F * static_cast<float>(i / 30), 0}));
                support::Moments moments;
                const auto found = map.irradiance(averaged(limits, kind, side), points);
                for (std::size_t i = 0; i < points.size(); ++i)
                    moments.add(static_cast<double>(found[i][0]) /
                                (2 * count * static_cast<double>(points[i].position.x())));
                EXPECT_NEAR(moments.mean(), 1, 4 * moments.standard_error()) << name(kind) << side;
                EXPECT_LT(moments.standard_error(), 0.012);
            }
}

// Light on [0, 1] x [0, 1] and darkness to its left: what of the kernels' mean lies on the light.
TEST(SquareKernel, SmearsAStraightEdgeAsItsProfileSays) {
    constexpr std::size_t count = 200'000;
    constexpr double side = 0.02;
    const EstimateMap map(test::uniform_field(count, 74));
    for (const FilterKind kind : kinds)
        for (const double radius : {1e-5, 0.01, 0.04}) {
            const auto settings =
                averaged({GatherLimits::all, static_cast<float>(radius)}, kind, side);
            const auto reach = reach_of(kind, side, radius);
            const Profile profile(kind);
            for (const double offset : {-0.9, -0.5, 0.0, 0.3, 0.8}) {
                const double place = offset * (reach.half + reach.reach);
                support::Moments moments;
                std::vector<ReceiverPoint> points;
                for (int i = 0; i < 60; ++i)
                    points.push_back(floor_point(
                        {static_cast<float>(place), 0.05F + 0.9F * static_cast<float>(i) / 59, 0}));
                for (const Spectrum& value : map.irradiance(settings, points))
                    moments.add(static_cast<double>(value[0]) / count);
                const double lit = integral(-place, reach.half + reach.reach, [&](double x) {
                    return profile.share(x, reach.half, reach.reach) / side;
                });
                EXPECT_NEAR(moments.mean(), lit, 4 * moments.standard_error() + 1e-6)
                    << name(kind) << " " << radius << " at " << offset;
            }
        }
}

// The point's estimate by the same kernel, the outermost photon left out.
TEST(SquareKernel, BecomesThePointsEstimateAsItShrinks) {
    const std::vector<Photon> photons = test::uniform_field(2'000, 75);
    const EstimateMap map(photons);
    const auto settings = averaged({30, 1}, FilterKind::epanechnikov, 1e-7);
    for (const ReceiverPoint& point : test::square_grid(4)) {
        const auto nearest = test::linear_scan(photons, point, {30, 1});
        const double r = std::sqrt(static_cast<double>(nearest.back().squared_distance));
        const auto reach = reach_of(FilterKind::epanechnikov, 1e-7, r);
        EXPECT_EQ(reach.rim, 0);
        const auto along = [&](float at, float centre) {
            const double z = static_cast<double>(at - centre) / reach.reach;
            return std::max(0.0, 0.75 * (1 - z * z)) / reach.reach;
        };
        double sum = 0;
        for (const Photon& photon : photons)
            sum += along(photon.position[0], point.position.x()) *
                   along(photon.position[1], point.position.y());
        EXPECT_NEAR(static_cast<double>(map.irradiance(settings, point)[0]) / sum, 1, 2e-3);
    }
}

TEST(SquareKernel, GivesTheSameInEveryTree) {
    const std::vector<Photon> photons = test::uniform_field(20'000, 76);
    const auto points = test::square_grid(40);
    for (const double side : {0.002, 0.05}) {
        const auto settings = averaged({20, 0.01F}, FilterKind::cone, side);
        const auto usual = EstimateMap(photons).irradiance(settings, points);
        for (const TreeKind tree : {TreeKind::balanced, TreeKind::unbalanced, TreeKind::packed})
            for (const Isa isa : supported_isas()) {
                const auto other = EstimateMap(photons, isa, tree).irradiance(settings, points);
                for (std::size_t i = 0; i < points.size(); ++i)
                    ASSERT_NEAR(other[i][0], usual[i][0], 1e-5F * usual[i][0])
                        << name(tree) << " " << name(isa);
            }
    }
}

// f_r of each photon's own direction, weighed by its place.
TEST(SquareKernel, ServesGlossyReceivers) {
    std::vector<Photon> photons = test::uniform_field(5'000, 77);
    Rng rng(78, Stage::test, 0);
    for (Photon& photon : photons) {
        photon.theta = static_cast<std::uint8_t>(rng.next_word() % 100);
        photon.phi = static_cast<std::uint8_t>(rng.next_word());
    }
    const EstimateMap map(photons);
    const Bsdf glossy{Schlick{Spectrum(0.5F, 0.4F, 0.3F), 0.2F}};
    const double side = 0.1;
    const auto settings = averaged({GatherLimits::all, 0.02F}, FilterKind::none, side);
    const auto reach = reach_of(FilterKind::none, side, static_cast<double>(0.02F));
    const Profile profile(FilterKind::none);
    ReceiverPoint point = floor_point({0.5F, 0.5F, 0});
    point.bsdf = &glossy;
    point.wo = Vec3(0.6F, 0, 0.8F);
    double sum = 0;
    for (const Photon& photon : photons) {
        const double x = static_cast<double>(photon.position[0]) - 0.5;
        const double y = static_cast<double>(photon.position[1]) - 0.5;
        if (std::max(std::abs(x), std::abs(y)) > reach.half + reach.reach) continue;
        sum += profile.share(x, reach.half, reach.reach) *
               profile.share(y, reach.half, reach.reach) / (side * side) *
               static_cast<double>(evaluate(glossy, point.uv, point.shading_normal, point.wo,
                                            decode_direction(photon.theta, photon.phi))[0]);
    }
    EXPECT_NEAR(static_cast<double>(map.radiance(settings, point)[0]) / sum, 1, 1e-4);
}

}  // namespace
}  // namespace caustics::photonmap
