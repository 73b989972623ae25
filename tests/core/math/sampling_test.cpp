#include "core/math/sampling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/math/frame.h"
#include "core/math/rng.h"
#include "tests/support/statistics.h"

namespace caustics {
namespace {

constexpr int draws = 100'000;

// Checks that x, which should be uniform in [0, 1), and the azimuth of (a, b) are so together.
class UniformPairs {
public:
    void add(double x, float a, float b) {
        const double turn = std::atan2(static_cast<double>(b), static_cast<double>(a));
        const double azimuth = turn / (2 * pi_d) + 0.5;
        const auto cell = [](double u) {
            return static_cast<std::size_t>(std::clamp(u, 0.0, 0.999999) * cells);
        };
        counts_[cell(x) * cells + cell(azimuth)] += 1;
        ++total_;
    }
    double p_value() const {
        return support::chi_square_p_value(
            counts_, std::vector<double>(counts_.size(), total_ / (cells * cells)));
    }

private:
    static constexpr std::size_t cells = 20;
    std::vector<double> counts_ = std::vector<double>(cells * cells);
    double total_ = 0;
};

template <typename Draw>
double p_value_of(const Draw& draw) {
    Rng rng(3, Stage::test, 0);
    UniformPairs pairs;
    for (int i = 0; i < draws; ++i) {
        const float u0 = rng.next();
        const float u1 = rng.next();
        draw(u0, u1, pairs);
    }
    return pairs.p_value();
}

TEST(Sampling, CosineHemisphereHasACosineDensity) {
    EXPECT_GT(p_value_of([](float u0, float u1, UniformPairs& pairs) {
                  const Vec3 w = cosine_hemisphere(u0, u1);
                  ASSERT_NEAR(w.norm(), 1, 1e-6F);
                  ASSERT_GE(w.z(), 0);
                  // The distribution function of cos is cos^2.
                  pairs.add(static_cast<double>(w.z() * w.z()), w.x(), w.y());
              }),
              1e-3);
}

TEST(Sampling, DiscIsUniformByArea) {
    EXPECT_GT(p_value_of([](float u0, float u1, UniformPairs& pairs) {
                  const Vec2 p = uniform_disc(u0, u1);
                  pairs.add(static_cast<double>(p.squaredNorm()), p.x(), p.y());
              }),
              1e-3);
}

TEST(Sampling, ConcentricDiscIsUniformByArea) {
    EXPECT_GT(p_value_of([](float u0, float u1, UniformPairs& pairs) {
                  const Vec2 p = concentric_disc(u0, u1);
                  ASSERT_LE(p.norm(), 1 + 1e-6F);
                  pairs.add(static_cast<double>(p.squaredNorm()), p.x(), p.y());
              }),
              1e-3);
}

// From a narrow cone to the whole sphere.
TEST(Sampling, CapsFromADiscAreUniformBySolidAngle) {
    for (const float one_minus_cos : {1e-6F, 0.1F, 1.0F, 2.0F})
        EXPECT_GT(p_value_of([=](float u0, float u1, UniformPairs& pairs) {
                      const Vec2 disc = concentric_disc(u0, u1);
                      float cap[3];
                      map_to_cap(one_minus_cos, disc.x(), disc.y(), cap);
                      const Vec3 w(cap[0], cap[1], cap[2]);
                      ASSERT_NEAR(w.norm(), 1, 1e-6F);
                      const double across =
                          static_cast<double>(w.x()) * static_cast<double>(w.x()) +
                          static_cast<double>(w.y()) * static_cast<double>(w.y());
                      // 1 - cos without the cancellation of a narrow cone.
                      const double height =
                          w.z() > 0 ? across / (1 + std::sqrt(1 - std::min(across, 1.0)))
                                    : 1 - static_cast<double>(w.z());
                      pairs.add(height / static_cast<double>(one_minus_cos), w.x(), w.y());
                  }),
                  1e-3)
            << one_minus_cos;
}

// The rim of the disc is where a rounding carries a point outside. Both ends of [0, 1] count: a double
// below 1 may round to 1 in float.
TEST(Sampling, CapsFromTheRimOfADiscAreUnitDirections) {
    constexpr int steps = 1 << 18;
    const float below_one = std::nextafter(1.0F, 0.0F);
    for (const float one_minus_cos : {1e-6F, 0.1F, 1.0F, std::nextafter(2.0F, 0.0F), 2.0F})
        for (const float end : {0.0F, std::nextafter(0.0F, 1.0F), below_one, 1.0F})
            for (int i = 0; i <= steps; ++i) {
                const float along = static_cast<float>(i) / steps;
                for (const Vec2& u : {Vec2(end, along), Vec2(along, end)}) {
                    const Vec2 disc = concentric_disc(u.x(), u.y());
                    float cap[3];
                    map_to_cap(one_minus_cos, disc.x(), disc.y(), cap);
                    const float norm = std::hypot(cap[0], cap[1], cap[2]);
                    ASSERT_NEAR(norm, 1, 1e-6F) << one_minus_cos << ": " << u.transpose();
                }
            }
}

TEST(Sampling, MapsOfTheSquareAreFiniteToBothEnds) {
    const float below_one = std::nextafter(1.0F, 0.0F);
    for (const float u0 : {0.0F, std::nextafter(0.0F, 1.0F), 0.5F, below_one, 1.0F})
        for (const float u1 : {0.0F, 0.125F, 0.25F, 0.5F, 0.75F, below_one, 1.0F}) {
            EXPECT_NEAR(cosine_hemisphere(u0, u1).norm(), 1, 1e-6F);
            EXPECT_NEAR(uniform_cap(2, u0, u1).norm(), 1, 1e-6F);
            EXPECT_LE(uniform_disc(u0, u1).norm(), 1 + 1e-6F);
            EXPECT_LE(concentric_disc(u0, u1).norm(), 1 + 1e-6F);
        }
}

TEST(Sampling, ConesAreUniformBySolidAngle) {
    for (const float cosine : {-1.0F, -0.3F, 0.0F, 0.5F, 0.99F}) {
        EXPECT_GT(p_value_of([cosine](float u0, float u1, UniformPairs& pairs) {
                      const Vec3 w = uniform_cap(1 - cosine, u0, u1);
                      ASSERT_NEAR(w.norm(), 1, 1e-6F);
                      pairs.add(static_cast<double>((1 - w.z()) / (1 - cosine)), w.x(), w.y());
                  }),
                  1e-3)
            << cosine;
    }
}

// About an axis of its own, and the density is 1 over the solid angle told.
TEST(Sampling, DirectionsOfAConeAreUniformAboutItsAxis) {
    const Vec3 axis = Vec3(-0.3F, 0.9F, 0.2F).normalized();
    const Frame about(axis);
    for (const float one_minus_cos : {0.01F, 0.4F, 2.0F}) {
        const DirectionCone cone{axis, one_minus_cos};
        EXPECT_GT(p_value_of([&](float u0, float u1, UniformPairs& pairs) {
                      const Vec3 w = about.to_local(cone.sample(u0, u1));
                      const double solid_angle = 2 * pi_d * (1 - static_cast<double>(w.z()));
                      pairs.add(solid_angle / cone.solid_angle(), w.x(), w.y());
                  }),
                  1e-3)
            << one_minus_cos;
    }
}

TEST(Sampling, NarrowConesKeepTheirWidth) {
    const Vec3 axis = Vec3(1, -2, 0.5F).normalized();
    Rng rng(4, Stage::test, 0);
    for (const double angle : {1.2, 0.1, 1e-2, 1e-3, 1e-4}) {
        const DirectionCone cone =
            DirectionCone::from_sine(axis, static_cast<float>(std::sin(angle)));
        const double solid_angle = 4 * pi_d * std::pow(std::sin(angle / 2), 2);
        EXPECT_NEAR(cone.solid_angle() / solid_angle, 1, 1e-5) << angle;
        EXPECT_NEAR(static_cast<double>(cone.angle()) / angle, 1, 1e-5) << angle;
        support::Moments share;
        int held = 0;
        for (int i = 0; i < 10'000; ++i) {
            const float u0 = rng.next();
            const Vec3 w = cone.sample(u0, rng.next());
            held += cone.contains(w) ? 1 : 0;
            const Vec3d aside = w.cast<double>().cross(axis.cast<double>());
            share.add(std::pow(aside.norm() / std::sin(angle), 2));
        }
        EXPECT_GT(held, 9970) << angle;
        // sin^2 is uniform in a narrow cone.
        if (angle < 0.2) {
            EXPECT_NEAR(share.mean(), 0.5, 4 * share.standard_error() + 3e-3) << angle;
        }
        const Vec3 outside = (axis + static_cast<float>(1.01 * std::tan(angle)) *
                                         axis.cross(Vec3::UnitX()).normalized())
                                 .normalized();
        EXPECT_FALSE(cone.contains(outside)) << angle;
    }
    EXPECT_TRUE(DirectionCone{}.contains(-Vec3::UnitZ()));
    EXPECT_TRUE(DirectionCone{}.is_whole_sphere());
}

TEST(Sampling, PickFollowsTheShares) {
    const std::vector<double> cumulative = {0.25, 0.25, 0.75, 1};
    EXPECT_EQ(pick(cumulative, 0.0F), 0U);
    EXPECT_EQ(pick(cumulative, 0.2499F), 0U);
    EXPECT_EQ(pick(cumulative, 0.25F), 2U);  // an empty share is never picked
    EXPECT_EQ(pick(cumulative, 0.7499F), 2U);
    EXPECT_EQ(pick(cumulative, 0.75F), 3U);
    EXPECT_EQ(pick(cumulative, 0.99999994F), 3U);
    EXPECT_EQ(pick({0.5, 0.9999999}, 0.99999994F), 1U);  // shares whose sum is rounded
}

// Each index as often as its share, and what is left of u uniform again.
TEST(Sampling, PickAndStretchFollowsTheSharesAndStaysUniform) {
    const std::vector<double> cumulative = {0.25, 0.25, 0.75, 0.8, 1};
    constexpr std::size_t cells = 10;
    std::vector<double> counts(cumulative.size() * cells), expected;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        const std::size_t index = i / cells;
        const double low = index == 0 ? 0 : cumulative[index - 1];
        expected.push_back(draws * (cumulative[index] - low) / cells);
    }
    Rng rng(6, Stage::test, 0);
    for (int i = 0; i < draws; ++i) {
        double u = rng.next_fine();
        const std::size_t index = pick_and_stretch(cumulative, u);
        counts[index * cells + static_cast<std::size_t>(std::min(u, 0.999999) * cells)] += 1;
    }
    EXPECT_EQ(std::accumulate(counts.begin() + cells, counts.begin() + 2 * cells, 0.0), 0)
        << "an empty share";
    EXPECT_GT(support::chi_square_p_value(counts, expected), 1e-3);
}

}  // namespace
}  // namespace caustics
