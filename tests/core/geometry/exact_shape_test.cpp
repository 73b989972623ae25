#include "core/geometry/exact_shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/math/rng.h"

namespace caustics {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Shape unit(Primitive primitive) {
    Shape shape;
    shape.primitive = primitive;
    return shape;
}

Shape waves(std::vector<SineWave> sines, const Vec2d& half_size = Vec2d::Ones()) {
    Shape shape = unit(Primitive::heightfield);
    shape.field.waves = std::move(sines);
    shape.field.half_size = half_size;
    return shape;
}

Shape rough_water() {
    return waves({{0.1, {5, 1}, 0.3}, {0.05, {-3, 9}, 1}, {0.02, {17, -11}, 2}}, {1, 0.8});
}

double uniform(Rng& rng, double low, double high) {
    return low + (high - low) * static_cast<double>(rng.next());
}

Vec3d random_point(Rng& rng, double half) {
    const double x = uniform(rng, -half, half), y = uniform(rng, -half, half);
    return {x, y, uniform(rng, -half, half)};
}

// Signed distance-like function whose zeros are the unbounded surface.
double implicit(const Shape& shape, const Vec3d& p) {
    switch (shape.primitive) {
        case Primitive::sphere: return p.squaredNorm() - 1;
        case Primitive::cylinder: return p.head<2>().squaredNorm() - 1;
        case Primitive::heightfield: return p.z() - shape.field.height(p.head<2>());
        default: return p.z();
    }
}

bool within(const Shape& shape, const Vec3d& p, double margin) {
    switch (shape.primitive) {
        case Primitive::cylinder: return p.z() >= -margin && p.z() <= 1 + margin;
        case Primitive::rectangle: return p.head<2>().cwiseAbs().maxCoeff() <= 1 + margin;
        case Primitive::disk: return p.head<2>().norm() <= 1 + margin;
        case Primitive::heightfield:
            return (p.head<2>().cwiseAbs() - shape.field.half_size).maxCoeff() <= margin;
        default: return true;
    }
}

// First sign change on a dense march, refined by bisection; none when there is no change.
std::optional<double> marched_root(const Shape& shape, const Vec3d& o, const Vec3d& d, double t_max,
                                   int steps) {
    double before = implicit(shape, o);
    for (int i = 1; i <= steps; ++i) {
        double high = t_max * i / steps;
        const double after = implicit(shape, o + high * d);
        if ((before < 0) != (after < 0)) {
            double low = t_max * (i - 1) / steps;
            for (int k = 0; k < 60; ++k) {
                const double middle = (low + high) / 2;
                ((implicit(shape, o + middle * d) < 0) == (before < 0) ? low : high) = middle;
            }
            if (within(shape, o + high * d, 0)) return high;
        }
        before = after;
    }
    return {};
}

// No first root is missed and none invented, by a dense march over the same ray.
void expect_same_as_march(const Shape& shape, const Vec3d& o, const Vec3d& d, int steps) {
    const double t_max = 8 / d.norm();
    const auto marched = marched_root(shape, o, d, t_max, steps);
    const auto hit = intersect_exact(shape, o, d, 0, infinity);
    if (marched) {
        ASSERT_TRUE(hit) << "missed: o " << o.transpose() << " d " << d.transpose();
        // A march may step over a pair of roots, never the other way round.
        ASSERT_LE(hit->distance, *marched + 1e-9 * (1 + *marched));
    }
    if (!hit) return;
    const Vec3d p = o + hit->distance * d;
    ASSERT_LT((p - hit->local).norm(), 1e-9 * (1 + o.norm()));
    ASSERT_LT(std::abs(implicit(shape, hit->local)), 1e-9);
    ASSERT_TRUE(within(shape, hit->local, 1e-9));
}

TEST(ExactShape, FindsTheFirstHitOfRandomRays) {
    Rng rng(1, Stage::test, 0);
    for (const Primitive primitive :
         {Primitive::rectangle, Primitive::disk, Primitive::sphere, Primitive::cylinder}) {
        const Shape shape = unit(primitive);
        for (int i = 0; i < 5000; ++i) {
            const Vec3d o = random_point(rng, 2);
            const Vec3d d = (random_point(rng, 1) - o) * uniform(rng, 0.1, 10);
            expect_same_as_march(shape, o, d, 300);
            if (HasFatalFailure()) return;
        }
    }
}

TEST(ExactShape, FindsTheFirstCrossingOfRandomRaysOnAHeightfield) {
    Rng rng(2, Stage::test, 0);
    for (const Shape& shape : {rough_water(), waves({{0.3, {2, 0}, 0}}), waves({})})
        for (int i = 0; i < 4000; ++i) {
            const Vec3d o = random_point(rng, 1.5);
            const Vec3d d = (random_point(rng, 0.3) - o) * uniform(rng, 0.1, 10);
            expect_same_as_march(shape, o, d, 1000);
            if (HasFatalFailure()) return;
        }
}

// Rays nearly along the surface, close above or below it: many near-double roots.
TEST(ExactShape, FindsTheFirstCrossingOfGrazingRaysOnAHeightfield) {
    Rng rng(3, Stage::test, 0);
    const Shape shape = rough_water();
    for (int i = 0; i < 3000; ++i) {
        const Vec2d at(uniform(rng, -1, 1), uniform(rng, -0.8, 0.8));
        const double lift = std::pow(10, uniform(rng, -7, -2)) * (i % 2 == 0 ? 1 : -1);
        const Vec3d o(at.x(), at.y(), shape.field.height(at) + lift);
        const Vec2d slope = shape.field.gradient(at);
        const double turn = uniform(rng, 0, 2 * pi_d);
        Vec3d d(std::cos(turn), std::sin(turn), 0);
        d.z() = slope.dot(d.head<2>()) + uniform(rng, -0.02, 0.02);
        expect_same_as_march(shape, o, d, 4000);
        if (HasFatalFailure()) return;
    }
}

// A downward ray that starts above the field and ends below it must meet it, whatever the ray
// parameter's unit is: nothing leaks through.
TEST(ExactShape, NothingLeaksThroughAHeightfield) {
    Rng rng(4, Stage::test, 0);
    const Shape ripples = waves({{1e-3, {200, 50}, 0.3}, {5e-4, {-300, 90}, 1}});
    for (const Shape& shape : {rough_water(), ripples, waves({})})
        for (const double speed : {1e-6, 1e-3, 1.0, 1e3, 1e6})
            for (int i = 0; i < 4000; ++i) {
                const double top = shape.field.max_height() + 0.01;
                const Vec2d to = shape.field.half_size.cwiseProduct(
                    Vec2d(uniform(rng, -0.9, 0.9), uniform(rng, -0.9, 0.9)));
                const Vec2d from = shape.field.half_size.cwiseProduct(
                    Vec2d(uniform(rng, -0.9, 0.9), uniform(rng, -0.9, 0.9)));
                const Vec3d o(from.x(), from.y(), top);
                const Vec3d d = (Vec3d(to.x(), to.y(), -top) - o) * speed;
                const auto hit = intersect_exact(shape, o, d, 0, infinity);
                ASSERT_TRUE(hit) << speed << ": " << o.transpose() << " -> " << to.transpose();
                ASSERT_LT(hit->distance * speed, 1);
                ASSERT_LT((o + hit->distance * d - hit->local).norm(), 1e-9);
            }
}

// Rays skimming tiny ripples take many steps; running out of them would be a silent miss.
TEST(ExactShape, SkimmingRaysOverFineRipplesAreFollowedToTheEnd) {
    const Shape shape = waves({{1e-5, {3000, 0}, 0}, {1e-5, {0, 2000}, 0.5}}, {10, 10});
    Rng rng(5, Stage::test, 0);
    for (int i = 0; i < 300; ++i) {
        const double y = uniform(rng, -9, 9);
        // From just above all crests at one end to below all troughs at the other.
        const Vec3d o(-9.5, y, 2.1e-5);
        const Vec3d d = (Vec3d(9.5, y, -2.1e-5) - o) / 19;
        ASSERT_TRUE(intersect_exact(shape, o, d, 0, infinity)) << i;
    }
}

TEST(ExactShape, RespectsTheInterval) {
    const Vec3d o(0.1, 0.2, 5), d(0, 0, -1);
    for (const Primitive primitive : {Primitive::rectangle, Primitive::disk, Primitive::sphere}) {
        const Shape shape = unit(primitive);
        const double t = intersect_exact(shape, o, d, 0, infinity)->distance;
        EXPECT_FALSE(intersect_exact(shape, o, d, 0, t * 0.999));
        const auto second = intersect_exact(shape, o, d, t * 1.001, infinity);
        EXPECT_EQ(second.has_value(), primitive == Primitive::sphere);
        EXPECT_FALSE(intersect_exact(shape, o, -d, 0, infinity));
    }
    const Shape water = rough_water();
    const double t = intersect_exact(water, o, d, 0, infinity)->distance;
    EXPECT_FALSE(intersect_exact(water, o, d, 0, t * 0.999));
    EXPECT_FALSE(intersect_exact(water, o, d, t * 1.001, infinity));
}

TEST(ExactShape, RaysAlongTheirAxesAndPlanesHitNothing) {
    EXPECT_FALSE(intersect_exact(unit(Primitive::rectangle), {0, 0, 0}, {1, 0, 0}, 0, infinity));
    EXPECT_FALSE(intersect_exact(unit(Primitive::cylinder), {0, 0, -1}, {0, 0, 1}, 0, infinity));
    EXPECT_FALSE(intersect_exact(waves({}), {0, 0, 0.5}, {1, 0, 0}, 0, infinity));
}

TEST(ExactShape, NormalsAreTheGradients) {
    Rng rng(6, Stage::test, 0);
    for (const Shape& shape : {unit(Primitive::sphere), unit(Primitive::cylinder), rough_water(),
                               unit(Primitive::rectangle)})
        for (int i = 0; i < 500; ++i) {
            const Vec3d o = random_point(rng, 2);
            const auto hit = intersect_exact(shape, o, random_point(rng, 0.5) - o, 0, infinity);
            if (!hit) continue;
            Vec3d gradient;
            for (int axis = 0; axis < 3; ++axis) {
                const Vec3d step = 1e-6 * Vec3d::Unit(axis);
                gradient[axis] =
                    implicit(shape, hit->local + step) - implicit(shape, hit->local - step);
            }
            EXPECT_LT((exact_normal(shape, hit->local) - gradient.normalized()).norm(), 1e-6);
        }
}

TEST(ExactShape, TextureCoordinatesAreMitsubas) {
    const auto expect_uv = [](Primitive primitive, const Vec3d& p, float u, float v) {
        const Vec2 uv = exact_uv(unit(primitive), p);
        EXPECT_NEAR(uv.x(), u, 1e-6F);
        EXPECT_NEAR(uv.y(), v, 1e-6F);
    };
    expect_uv(Primitive::rectangle, {-1, 1, 0}, 0, 1);
    expect_uv(Primitive::rectangle, {0.5, 0, 0}, 0.75F, 0.5F);
    expect_uv(Primitive::disk, {0, 0.5, 0}, 0.5F, 0.25F);
    expect_uv(Primitive::sphere, {0, 0, 1}, 0, 0);
    expect_uv(Primitive::sphere, {0, -1, 0}, 0.75F, 0.5F);
    expect_uv(Primitive::cylinder, {-1, 0, 0.25}, 0.5F, 0.25F);
    const Vec2 water = exact_uv(rough_water(), {0.5, -0.8, 0});
    EXPECT_NEAR(water.x(), 0.75F, 1e-6F);
    EXPECT_NEAR(water.y(), 0, 1e-6F);
}

}  // namespace
}  // namespace caustics
