#include "core/scene/media_conflicts.h"

#include <gtest/gtest.h>

#include "core/geometry/tessellate.h"
#include "tests/support/build_scene.h"

namespace caustics {
namespace {

Bsdf glass(float inside, float outside, float absorbs = 0, float outside_absorbs = 0) {
    Bsdf bsdf = support::glass(inside);
    auto& medium = std::get<Dielectric>(bsdf.model);
    medium.ext_ior = outside;
    medium.absorption = Spectrum::Constant(absorbs);
    medium.ext_absorption = Spectrum::Constant(outside_absorbs);
    return bsdf;
}

Shape ball_of(double radius, const Bsdf& bsdf, const Vec3d& at = {0, 0, 0}) {
    return support::sphere("ball", at, radius, bsdf);
}

Shape cube(double half, const Bsdf& bsdf) {
    return support::mesh("cube", tessellate_cube(2), Transform(Eigen::Scaling(half)), bsdf);
}

std::vector<MediaConflict> conflicts_of(std::vector<Shape> shapes) {
    SceneDesc desc;
    desc.shapes = std::move(shapes);
    return media_conflicts(Scene(std::move(desc)));
}

TEST(MediaConflicts, NameWaterInGlassThatIsSaidToLieInAir) {
    const auto conflicts =
        conflicts_of({ball_of(0.4, glass(1.333F, 1)), ball_of(0.5, glass(1.5F, 1))});
    ASSERT_EQ(conflicts.size(), 1U);
    EXPECT_EQ(conflicts[0].first, 0U);
    EXPECT_EQ(conflicts[0].second, 1U);
    EXPECT_NEAR(conflicts[0].first_ior, 1, 1e-6);
    EXPECT_NEAR(conflicts[0].second_ior, 1.5, 1e-6);
    EXPECT_EQ(conflicts_of({cube(0.4, glass(1.333F, 1)), cube(0.5, glass(1.5F, 1))}).size(), 1U);
    EXPECT_EQ(conflicts_of({cube(0.3, glass(1.333F, 1)), ball_of(0.9, glass(1.5F, 1))}).size(), 1U);
}

TEST(MediaConflicts, AreNoneWhereEachSaysWhatIsRoundIt) {
    EXPECT_TRUE(
        conflicts_of({ball_of(0.4, glass(1.333F, 1.5F)), ball_of(0.5, glass(1.5F, 1))}).empty());
    EXPECT_TRUE(
        conflicts_of({ball_of(0.4999, glass(1, 1.5F)), ball_of(0.5, glass(1.5F, 1))}).empty())
        << "a bulb";
    EXPECT_TRUE(conflicts_of({cube(0.4, glass(1.333F, 1.5F)), cube(0.5, glass(1.5F, 1))}).empty());
    EXPECT_TRUE(conflicts_of(
                    {ball_of(0.5, glass(1.5F, 1)), ball_of(0.5, glass(1.5F, 1.000277F), {2, 0, 0})})
                    .empty())
        << "both words for air";
    EXPECT_TRUE(conflicts_of({ball_of(0.5, glass(1.5F, 1))}).empty());
}

TEST(MediaConflicts, TellOfWhatAMediumAbsorbs) {
    const auto nested = [](float said, double radius) {
        return conflicts_of(
            {ball_of(0.5, glass(1.5F, 1, 3)), ball_of(radius, glass(1, 1.5F, 0, said))});
    };
    const auto conflicts = nested(0, 0.3);
    ASSERT_EQ(conflicts.size(), 1U);
    EXPECT_EQ(conflicts[0].first_ior, conflicts[0].second_ior);
    EXPECT_TRUE(nested(3, 0.3).empty());
    EXPECT_TRUE(nested(0, 0.4999).empty()) << "0.1 mm take 0.03 % of the light";
}

TEST(MediaConflicts, AreFoundUnderOpenWater) {
    const Shape water = support::horizontal("water", 1, 2, true, glass(1.333F, 1));
    EXPECT_TRUE(conflicts_of({water, ball_of(0.3, glass(1.5F, 1.333F))}).empty());
    EXPECT_EQ(conflicts_of({water, ball_of(0.3, glass(1.5F, 1))}).size(), 1U);
    EXPECT_TRUE(conflicts_of({water, ball_of(0.3, glass(1.5F, 1), {0, 0, 2})}).empty()) << "above";
}

}  // namespace
}  // namespace caustics
