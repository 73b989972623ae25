#include "photonmap/estimate/adaptive_n.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/frame.h"
#include "estimate_map.h"
#include "tests/support/statistics.h"

namespace caustics::photonmap {
namespace {

using test::EstimateMap;
using test::floor_point;
using Settings = RadianceEstimate::Settings;

Settings adaptive(std::size_t nearest, float max_radius = 1) {
    return {.limits = {nearest, max_radius, true},
            .filter = {FilterKind::epanechnikov},
            .adaptive = true};
}

/// Photons round the origin of the plane z = 0 that own their arrays.
class Around {
public:
    explicit Around(const std::vector<Vec2>& places)
        : distance_(places.size() + 16),
          energy_(places.size() + 16),
          direction_(places.size() + 16),
          position_{distance_, distance_, distance_},
          count_(places.size()) {
        for (std::size_t i = 0; i < count_; ++i) {
            distance_[i] = places[i].squaredNorm();
            energy_[i] = static_cast<std::uint32_t>(i);
            position_[0][i] = places[i].x();
            position_[1][i] = places[i].y();
            if (distance_[i] > distance_[farthest_]) farthest_ = i;
        }
    }
    GatheredPhotons photons() const {
        return {.squared_distance = distance_.data(),
                .energy = energy_.data(),
                .direction = direction_.data(),
                .count = count_,
                .farthest = farthest_,
                .position = {position_[0].data(), position_[1].data(), position_[2].data()}};
    }

private:
    std::vector<float> distance_;
    std::vector<std::uint32_t> energy_;
    std::vector<std::uint16_t> direction_;
    std::vector<float> position_[3];
    std::size_t count_;
    std::size_t farthest_ = 0;
};

struct Choice {
    std::size_t count;
    double factor;
    std::vector<std::uint32_t> energies;
};

Choice choose(const std::vector<Vec2>& places, Isa isa = widest_isa()) {
    const Around around(places);
    NScratch scratch;
    const ChosenPhotons chosen =
        AdaptiveN(isa).choose(floor_point(Vec3::Zero()), around.photons(), true, scratch);
    Choice choice{chosen.photons.count, chosen.factor, {}};
    for (std::size_t i = 0; i < chosen.photons.count; ++i)
        choice.energies.push_back(chosen.photons.energy[i]);
    return choice;
}

/// The rule in words, photon by photon in double.
Choice by_the_book(std::vector<Vec2> places) {
    std::ranges::sort(places, {}, [](const Vec2& p) { return p.squaredNorm(); });
    std::vector<double> leans;
    std::vector<std::size_t> counts;
    Vec2d sum = Vec2d::Zero(), doubled = Vec2d::Zero();
    std::size_t done = 0;
    for (double next = 5; next + 0.5 < static_cast<double>(places.size()) + 1;
         next = std::max(1.3 * next, next + 1)) {
        const auto count = static_cast<std::size_t>(next + 0.5);
        if (count > places.size()) break;
        for (; done < count; ++done) {
            const Vec2d e = places[done].cast<double>().normalized();
            sum += e;
            doubled += Vec2d(e.x() * e.x() - e.y() * e.y(), 2 * e.x() * e.y());
        }
        const auto n = static_cast<double>(count);
        counts.push_back(count);
        leans.push_back(sum.norm() / n);
        if (sum.squaredNorm() <= 6 * n && doubled.squaredNorm() <= 9 * n) continue;
        const std::size_t chosen = counts.size() < 3 ? 0 : counts.size() - 3;
        return {counts[chosen], std::min(1.0, 1.5 * (1 - leans[chosen])), {}};
    }
    return {places.size(), 1, {}};
}

/// Places whose density grows from left to right by a random amount, or that fill a random half
/// plane.
std::vector<Vec2> random_places(Rng& rng) {
    const std::size_t count = rng.next_word() % 300;
    const float growth = 2 * rng.next(), edge = 2 * rng.next() - 1.5F;
    std::vector<Vec2> places;
    while (places.size() < count) {
        const float x = 2 * rng.next() - 1, y = 2 * rng.next() - 1, chance = rng.next();
        if (x > edge && chance < 0.5F + 0.5F * growth * x) places.emplace_back(x, y);
    }
    return places;
}

TEST(AdaptiveN, IsTheRuleOnEveryInstructionSetWhateverThePhotonsOrder) {
    Rng rng(51, Stage::test, 0);
    std::size_t stopped = 0;
    for (int i = 0; i < 500; ++i) {
        std::vector<Vec2> places = random_places(rng);
        const Choice expected = by_the_book(places);
        stopped += expected.count < places.size() ? 1 : 0;
        for (const Isa isa : supported_isas()) {
            const Choice choice = choose(places, isa);
            ASSERT_EQ(choice.count, expected.count) << name(isa);
            ASSERT_NEAR(choice.factor, expected.factor, 0.003 + 1e-4);
        }
        const double factor = choose(places).factor;
        std::ranges::reverse(places);
        ASSERT_EQ(choose(places).count, expected.count);
        ASSERT_EQ(choose(places).factor, factor);
    }
    EXPECT_GT(stopped, 100U);
    EXPECT_LT(stopped, 450U);
}

TEST(AdaptiveN, TakesTheNearestOfThem) {
    Rng rng(52, Stage::test, 0);
    std::vector<Vec2> places;
    for (int i = 0; i < 200; ++i) {
        const float x = rng.next(), y = rng.next();
        places.emplace_back(x - 0.2F, y - 0.5F);
    }
    const Choice choice = choose(places);
    ASSERT_LT(choice.count, 200U);
    std::ranges::sort(places, {}, [](const Vec2& p) { return p.squaredNorm(); });
    // Energies are the places in the order they come, which now is that of the distances.
    EXPECT_EQ(choose(places).energies.back(), choice.count - 1);
}

TEST(AdaptiveN, KnowsTheMeanOfItsFactor) {
    // Even directions: what the factor takes away on average the division by its mean gives back.
    Rng rng(53, Stage::test, 0);
    for (const std::size_t count : {8U, 20U, 100U}) {
        support::Moments factor;
        std::vector<Vec2> places(count);
        for (int i = 0; i < 20'000; ++i) {
            for (std::size_t k = 0; k < count; ++k) {
                const float angle = 2 * pi * rng.next();
                places[k] = static_cast<float>(k + 1) * Vec2(std::cos(angle), std::sin(angle));
            }
            factor.add(choose(places).factor);
        }
        EXPECT_NEAR(factor.mean(), 1, 0.0005) << count;
        EXPECT_NEAR(factor.mean(), 1, 4 * factor.standard_error()) << count;
    }
}

TEST(AdaptiveN, LeavesAUniformFieldUnbiased) {
    constexpr std::size_t photons = 800'000;
    constexpr int side = 90;
    const EstimateMap map(test::uniform_field(photons, 54));
    const auto fewer = static_cast<float>(std::sqrt(60 / (pi_d * photons)));
    for (const float max_radius : {1.0F, fewer})
        for (const auto estimator :
             {PhotonMapParams::Estimator::unbiased, PhotonMapParams::Estimator::raw}) {
            Settings settings = adaptive(60, max_radius);
            settings.estimator = estimator;
            support::Moments moments;
            for (const Spectrum& value : map.irradiance(settings, test::square_grid(side)))
                moments.add(static_cast<double>(value[0]) / photons);
            // The Epanechnikov filter weighs nothing at the rim, so that raw is unbiased as well.
            EXPECT_NEAR(moments.mean(), 1, 0.005) << max_radius;
            EXPECT_NEAR(moments.mean(), 1, 4 * moments.standard_error());
            // Nearly the scatter of taking 60 everywhere.
            EXPECT_LT(moments.deviation(), 1.15 * std::sqrt(4.0 / 3 / 59));
        }
}

TEST(AdaptiveN, KeepsDarknessBesideAnEdgeAndEvennessAwayFromIt) {
    // Light on [0, 1] x [0, 1], darkness to the left: the relative error of points on both sides.
    constexpr std::size_t photons = 100'000;
    const EstimateMap map(test::uniform_field(photons, 55));
    const auto error = [&](const Settings& settings, float from, float to, double truth) {
        std::vector<ReceiverPoint> points;
        for (int i = 0; i < 2'000; ++i)
            points.push_back(floor_point({from + (to - from) * static_cast<float>(i % 10) / 9,
                                          0.1F + 0.8F * static_cast<float>(i) / 2'000, 0}));
        double squares = 0;
        for (const Spectrum& value : map.irradiance(settings, points))
            squares += std::pow(static_cast<double>(value[0]) / photons - truth, 2);
        return std::sqrt(squares / 2'000);
    };
    const Settings own = adaptive(200);
    for (const std::size_t fixed : {20U, 50U}) {
        const Settings same{.limits = {fixed, 1}, .filter = {FilterKind::epanechnikov}};
        EXPECT_LT(error(own, -0.03F, -0.004F, 0), 0.4 * error(same, -0.03F, -0.004F, 0));
        EXPECT_LT(error(own, 0.06F, 0.5F, 1), 0.7 * error(same, 0.06F, 0.5F, 1));
    }
}

TEST(AdaptiveN, WorksOnAnyTreeAndAnyPlaneAlike) {
    // The same photons on a tilted plane give the same counts up to rounding.
    const std::vector<Photon> flat = test::uniform_field(3'000, 56);
    const Frame frame(Vec3(0.3F, -0.5F, 0.8F).normalized());
    std::vector<Photon> tilted = flat;
    for (Photon& photon : tilted) {
        const Vec3 at = frame.to_world(position(photon));
        std::copy_n(at.data(), 3, photon.position);
        const DirectionCode wi = encode_direction(frame.n);
        photon.theta = wi.theta;
        photon.phi = wi.phi;
    }
    const EstimateMap plane(flat), other(tilted), heap(flat, widest_isa(), TreeKind::balanced),
        grown(flat, widest_isa(), TreeKind::unbalanced);
    std::size_t alike = 0;
    const std::vector<ReceiverPoint> points = test::square_grid(12);
    for (const ReceiverPoint& point : points) {
        ReceiverPoint turned = point;
        turned.position = frame.to_world(point.position);
        turned.geometric_normal = turned.shading_normal = turned.wo = frame.n;
        const float a = plane.irradiance(adaptive(100), point)[0];
        alike += std::abs(other.irradiance(adaptive(100), turned)[0] / a - 1) < 1e-3F ? 1 : 0;
        for (const EstimateMap* const map : {&heap, &grown})
            ASSERT_NEAR(map->irradiance(adaptive(100), point)[0] / a, 1, 1e-5);
    }
    EXPECT_GE(alike, points.size() - 3);
}

}  // namespace
}  // namespace caustics::photonmap
