#include "core/scene/shared_faces.h"

#include <gtest/gtest.h>

#include "core/geometry/tessellate.h"
#include "tests/support/build_scene.h"

namespace caustics {
namespace {

using FacePairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

FacePairs sharing(std::vector<Shape> shapes) {
    SceneDesc desc;
    desc.shapes = std::move(shapes);
    FacePairs pairs;
    for (const SharedFace& face : shared_faces(Scene(std::move(desc))))
        pairs.emplace_back(face.caster, face.other);
    return pairs;
}

/// A cube of half a metre from z on.
Shape block(double z, const Bsdf& bsdf = support::glass(1.5F), double x = 0) {
    return support::mesh("block", tessellate_cube(1),
                         Transform(Eigen::Translation3d(x, 0, z + 0.25) * Eigen::Scaling(0.25)),
                         bsdf);
}

Shape floor_at(double z) {
    return support::horizontal("floor", z, 5, true, support::diffuse(0.5F));
}

TEST(SharedFaces, NamesGlassThatStandsOnAFloor) {
    EXPECT_EQ(sharing({floor_at(0), block(0)}), (FacePairs{{1, 0}}));
    EXPECT_EQ(sharing({floor_at(0), block(1e-4)}), FacePairs{});
    EXPECT_EQ(sharing({floor_at(0), block(-0.1)}), FacePairs{}) << "it sinks in";
    // Far from the origin of coordinates, too, where floats are coarse.
    EXPECT_EQ(sharing({floor_at(0), block(0, support::glass(1.5F), 4)}), (FacePairs{{1, 0}}));
}

TEST(SharedFaces, NamesGlassOnGlassOnce) {
    EXPECT_EQ(sharing({block(0), block(0.5), block(1.1)}), (FacePairs{{0, 1}}));
    EXPECT_EQ(sharing({block(0), block(0, support::glass(1.5F), 0.5)}), (FacePairs{{0, 1}}))
        << "side by side";
}

TEST(SharedFaces, NamesAMirrorOnAFloor) {
    const Shape mirror = support::horizontal("mirror", 0, 0.3, true, support::mirror());
    EXPECT_EQ(sharing({floor_at(0), mirror}), (FacePairs{{1, 0}}));
    EXPECT_EQ(sharing({floor_at(-0.001), mirror}), FacePairs{});
}

// No middle of the large one lies on the small one; whichever comes first.
TEST(SharedFaces, NamesTheSmallOnTheLarge) {
    const Shape slab =
        support::mesh("slab", tessellate_cube(1),
                      Transform(Eigen::Translation3d(0, 0, -0.5) * Eigen::Scaling(20.0, 20.0, 0.5)),
                      support::glass(1.5F));
    const Shape stone = block(0, support::glass(1.7F), 7);
    EXPECT_EQ(sharing({slab, stone}), (FacePairs{{1, 0}}));
    EXPECT_EQ(sharing({stone, slab}), (FacePairs{{0, 1}}));
}

// Corners, edges and points that touch are no faces; nor do receivers matter among themselves.
TEST(SharedFaces, LeavesAloneWhatMerelyTouches) {
    EXPECT_EQ(sharing({floor_at(0), support::sphere("ball", {0, 0, 1}, 1, support::glass(1.5F))}),
              FacePairs{});
    EXPECT_EQ(sharing({block(0), block(0.5, support::glass(1.5F), 0.5)}), FacePairs{}) << "an edge";
    EXPECT_EQ(sharing({floor_at(0), block(0, support::diffuse(0.5F))}), FacePairs{});
}

}  // namespace
}  // namespace caustics
