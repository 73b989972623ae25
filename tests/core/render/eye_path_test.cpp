#include "core/render/eye_path.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/build_scene.h"
#include "tests/support/fresnel.h"
#include "tests/support/statistics.h"

namespace caustics {
namespace {

// Glass in a sphere that emits radiance 1 everywhere inwards.
SceneDesc furnace(std::vector<Shape> glass) {
    SceneDesc desc;
    desc.shapes = std::move(glass);
    desc.shapes.push_back(support::enclosure(50, support::diffuse(0.5F)));
    desc.shapes.back().radiance = Spectrum(Spectrum::Ones());
    return desc;
}

// Mean of what is emitted towards the eye over rays spread about `direction`.
support::Moments emitted(const Scene& scene, const Vec3& origin, const Vec3& direction,
                         float spread) {
    support::Moments moments;
    std::vector<WeightedPoint> points;
    for (std::uint64_t i = 0; i < 20'000; ++i) {
        Rng rng(1, Stage::test, i);
        const Vec3 aside(rng.next() - 0.5F, rng.next() - 0.5F, rng.next() - 0.5F);
        points.clear();
        const Ray ray{origin, (direction + spread * aside).normalized()};
        const EyePath path = trace_eye_path(scene, ray, black(), rng, points);
        EXPECT_TRUE(is_finite(path.emitted));
        moments.add(static_cast<double>(path.emitted[0]));
    }
    return moments;
}

TEST(EyePath, LosslessGlassIsInvisibleInAFurnace) {
    const Scene ball(furnace({support::sphere("ball", {0, 0, 0}, 1, support::glass(1.5F))}));
    const support::Moments outside = emitted(ball, Vec3(0, 0, 3), -Vec3::UnitZ(), 0.5F);
    EXPECT_NEAR(outside.mean(), 1, 4 * outside.standard_error() + 2e-4);
}

// Radiance over n^2 is what interfaces keep.
TEST(EyePath, AnEyeInGlassSeesTheSquareOfItsIndex) {
    const Scene ball(furnace({support::sphere("ball", {0, 0, 0}, 1, support::glass(1.5F))}));
    const support::Moments inside = emitted(ball, Vec3::Zero(), Vec3::UnitX(), 1);
    EXPECT_NEAR(inside.mean(), 2.25, 4 * inside.standard_error() + 2e-4);
}

TEST(EyePath, ManyNestedShellsNeitherLoseNorAddLight) {
    std::vector<Shape> shells;
    for (int i = 0; i < 6; ++i)
        shells.push_back(
            support::sphere("shell", {0, 0, 0}, 2 - 0.1 * i,
                            i % 2 == 0 ? support::glass(1.5F) : support::glass(1, 1.5F)));
    const Scene scene(furnace(std::move(shells)));
    // Near the axis no path is trapped; chains longer than the bounce limit carry little here.
    const support::Moments seen = emitted(scene, Vec3(0, 0, 4), -Vec3::UnitZ(), 0.1F);
    EXPECT_NEAR(seen.mean(), 1, 4 * seen.standard_error() + 2e-3);
}

TEST(EyePath, ASlabShowsTheReceiverBehindByItsTransmittance) {
    SceneDesc desc;
    desc.shapes.push_back(support::horizontal("top", 1, 100, true, support::glass(1.5F)));
    desc.shapes.push_back(support::horizontal("bottom", 0.9, 100, false, support::glass(1.5F)));
    desc.shapes.push_back(support::horizontal("floor", 0, 100, true, support::diffuse(0.5F)));
    const Scene scene(std::move(desc));
    const Vec3 direction = Vec3(1, 0, -1).normalized();
    support::Moments weight;
    std::vector<WeightedPoint> points;
    for (std::uint64_t i = 0; i < 20'000; ++i) {
        Rng rng(1, Stage::test, i);
        points.clear();
        const EyePath path =
            trace_eye_path(scene, {Vec3(0, 0, 2), direction}, black(), rng, points);
        EXPECT_TRUE(path.first.caster);
        EXPECT_NEAR(path.first.depth, std::sqrt(2.0F), 1e-5F);
        double sum = 0;
        for (const WeightedPoint& found : points) {
            EXPECT_NEAR(found.point.wo.dot(direction), -1, 1e-5F);
            EXPECT_EQ(found.point.bsdf, &scene.shapes()[2].bsdf);
            sum += static_cast<double>(found.weight[2]);
        }
        weight.add(sum);
    }
    const double expected = support::slab(support::fresnel(std::sqrt(0.5), 1.5)).transmitted;
    EXPECT_NEAR(weight.mean(), expected, 4 * weight.standard_error() + 1e-5);
}

TEST(EyePath, FindsTheFirstHitAndNothingInTheVoid) {
    SceneDesc desc;
    desc.shapes.push_back(support::horizontal("floor", 0, 1, true, support::diffuse(0.25F)));
    const Scene scene(std::move(desc));
    Rng rng(1, Stage::test, 0);
    std::vector<WeightedPoint> points;
    const EyePath seen =
        trace_eye_path(scene, {Vec3(0, 0, 2), -Vec3::UnitZ()}, black(), rng, points);
    EXPECT_FLOAT_EQ(seen.first.albedo[0], 0.25F);
    EXPECT_FLOAT_EQ(seen.first.depth, 2);
    EXPECT_EQ(seen.first.normal, Vec3(0, 0, 1));
    EXPECT_FALSE(seen.first.caster);
    ASSERT_EQ(points.size(), 1U);
    EXPECT_TRUE((points[0].weight == 1).all());

    points.clear();
    const EyePath empty =
        trace_eye_path(scene, {Vec3(0, 0, 2), Vec3::UnitZ()}, black(), rng, points);
    EXPECT_EQ(empty.first.depth, 0);
    EXPECT_TRUE(is_black(empty.emitted) && points.empty());
    // From below the one-sided floor is black.
    trace_eye_path(scene, {Vec3(0, 0, -2), Vec3::UnitZ()}, black(), rng, points);
    EXPECT_TRUE(points.empty());
}

// Beer's law over a known length, once, and a bundle of mirrors that never lets go.
TEST(EyePath, AbsorbsAlongSegmentsAndEndsLongChains) {
    SceneDesc desc;
    desc.shapes.push_back(support::horizontal(
        "top", 1, 1, true, support::glass(1, 1, Spectrum(Spectrum::Constant(0.5F)))));
    desc.shapes.push_back(support::horizontal("floor", 0, 1, true, support::diffuse(0.5F)));
    const Scene scene(std::move(desc));
    Rng rng(1, Stage::test, 0);
    std::vector<WeightedPoint> points;
    trace_eye_path(scene, {Vec3(0, 0, 2), -Vec3::UnitZ()}, black(), rng, points);
    ASSERT_EQ(points.size(), 1U);
    EXPECT_NEAR(points[0].weight[0], std::exp(-0.5F), 1e-5F);

    const Scene mirrors([] {
        SceneDesc cavity;
        cavity.shapes.push_back(support::enclosure(1, support::mirror()));
        return cavity;
    }());
    points.clear();
    const EyePath lost =
        trace_eye_path(mirrors, {Vec3::Zero(), Vec3::UnitX()}, black(), rng, points);
    EXPECT_TRUE(lost.first.caster && points.empty() && is_black(lost.emitted));
}

// However faint a reflection is, each ray follows it to the depth asked for: nothing is left to chance,
// and the mean is the same.
TEST(EyePath, SplitsToADepthAndThenByChance) {
    const auto spread = [](int split_depth) {
        SceneDesc desc = furnace({support::sphere("ball", {0, 0, 0}, 1, support::glass(1.5F))});
        desc.shapes.push_back(support::sphere("sun", {0, 0, 30}, 4, support::diffuse(0)));
        desc.shapes.back().radiance = Spectrum(Spectrum::Constant(100));
        desc.sampling.split_depth = split_depth;
        const Scene scene(std::move(desc));
        return emitted(scene, Vec3(0, 0, 3), -Vec3::UnitZ(), 0.05F);
    };
    const support::Moments drawn = spread(0);
    const support::Moments split = spread(3);
    EXPECT_NEAR(drawn.mean(), split.mean(), 4 * drawn.standard_error());
    EXPECT_LT(split.standard_error(), 0.3 * drawn.standard_error());
}

TEST(EyePath, DispersiveGlassIsInvisibleInAFurnace) {
    Bsdf glass = support::glass(1.5F);
    std::get<Dielectric>(glass.model).int_ior = Ior::cauchy(1.6, 0.02);
    const Scene ball(furnace({support::sphere("ball", {0, 0, 0}, 1, glass)}));
    const support::Moments outside = emitted(ball, Vec3(0, 0, 3), -Vec3::UnitZ(), 0.5F);
    EXPECT_NEAR(outside.mean(), 1, 4 * outside.standard_error() + 2e-4);
}

// Fog before the pool, water in it; a mirror keeps the path where it is.
TEST(EyePath, PointsKnowTheMediumThatTheyAreSeenThrough) {
    const Spectrum ink(0.2F, 0.5F, 1.1F), fog(0.1F, 0.1F, 0.1F);
    SceneDesc desc;
    desc.shapes = {
        support::horizontal("water", 0, 1, true, support::glass(1.33F, 1, ink, fog)),
        support::horizontal("floor", -2, 9, true, support::diffuse(0.5F)),
        support::rectangle("mirror", {5, 0, 0}, {0, 0, 1}, {0, 1, 0}, support::mirror())};
    const Scene scene(std::move(desc));
    const auto seen = [&](const Vec3& origin, const Vec3& direction) {
        Rng rng(1, Stage::test, 0);
        std::vector<WeightedPoint> points;
        trace_eye_path(scene, {origin, direction.normalized()}, fog, rng, points);
        EXPECT_EQ(points.size(), 1U);
        return points.at(0).point.medium;
    };
    EXPECT_EQ(seen(Vec3(3, 0, 1), -Vec3::UnitZ()), &fog);
    EXPECT_EQ(seen(Vec3(0, 0, 1), -Vec3::UnitZ()),
              &std::get<Dielectric>(scene.shapes()[0].bsdf.model).absorption);
    EXPECT_EQ(seen(Vec3(4, 0, 0.5F), Vec3(1, 0, -0.5F)), &fog);
}

}  // namespace
}  // namespace caustics
