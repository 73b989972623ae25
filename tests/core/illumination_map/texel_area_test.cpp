#include "core/illumination_map/texel_area.h"

#include <gtest/gtest.h>

#include <numeric>

#include "core/base/error.h"
#include "core/geometry/tessellate.h"
#include "tests/support/build_scene.h"

namespace caustics {
namespace {

double total(const Shape& shape, int resolution) {
    const std::vector<double> areas = texel_areas(shape, texel_grid(shape, resolution));
    return std::accumulate(areas.begin(), areas.end(), 0.0);
}

/// A unit primitive, stretched and turned.
Shape stretched(Primitive primitive) {
    Shape shape;
    shape.name = "receiver";
    shape.primitive = primitive;
    shape.field.waves = {{0.05, Vec2d(4, 1), 0.3}, {0.02, Vec2d(-3, 7), 1}};
    shape.to_world = Eigen::Translation3d(1, 2, 3) *
                     Eigen::AngleAxisd(0.7, Vec3d(1, 2, 2).normalized()) *
                     Eigen::Scaling(Vec3d(2, 1.5, 0.5));
    return shape;
}

TEST(TexelGrid, SharesAPlaceAmongTheTexelsRoundIt) {
    const TexelGrid grid(4, true, false);
    for (const Vec2d& uv : {Vec2d(0, 0), Vec2d(1, 1), Vec2d(0.37, 0.61), Vec2d(0.5, 0.125)}) {
        double sum = 0;
        for (const TexelGrid::Tap& tap : grid.taps(uv)) {
            EXPECT_LT(tap.texel, grid.size());
            EXPECT_GE(tap.share, 0);
            sum += tap.share;
        }
        EXPECT_NEAR(sum, 1, 1e-15);
    }
    // The seam u = 0 = 1 lies between the last and the first column, the edge v = 0 in the first row.
    const auto seam = grid.taps({0, 0});
    EXPECT_EQ(seam[0].texel, 3U);
    EXPECT_EQ(seam[1].texel, 0U);
    EXPECT_NEAR(seam[0].share + seam[2].share, 0.5, 1e-15);
    const auto centre = grid.taps({0.625, 0.375});
    EXPECT_EQ(centre[0].texel, 4U + 2U);
    EXPECT_NEAR(centre[0].share, 1, 1e-15);
}

TEST(TexelAreas, AddUpToTheSurface) {
    // A fine mesh knows the area of what has no simple formula.
    for (const Primitive primitive : {Primitive::rectangle, Primitive::disk, Primitive::sphere,
                                      Primitive::cylinder, Primitive::heightfield}) {
        const Shape shape = stretched(primitive);
        const double expected = support::mesh_area(tessellate_shape(shape, 300));
        for (const int resolution : {1, 7, 64})
            EXPECT_NEAR(total(shape, resolution) / expected, 1, resolution == 1 ? 5e-3 : 1e-4)
                << static_cast<int>(primitive) << " at " << resolution;
    }
    const Shape ball = support::sphere("ball", {0, 0, 0}, 2, support::diffuse(1));
    EXPECT_NEAR(total(ball, 16) / (16 * pi_d), 1, 1e-9);
}

TEST(TexelAreas, AreThoseOfAMeshsTrianglesExactly) {
    for (const Primitive primitive : {Primitive::rectangle, Primitive::disk, Primitive::sphere,
                                      Primitive::cylinder, Primitive::heightfield}) {
        Shape shape = stretched(primitive);
        shape.mesh = tessellate_shape(shape, 9);
        shape.primitive = Primitive::mesh;
        for (const int resolution : {1, 6, 40})
            EXPECT_NEAR(total(shape, resolution) / support::mesh_area(shape.mesh), 1, 1e-6)
                << static_cast<int>(primitive) << " at " << resolution;
    }
}

TEST(TexelAreas, AreEqualSquaresOfAFlatOne) {
    const Shape square = support::horizontal("floor", 0, 1, true, support::diffuse(1));
    // The outermost half texel counts for an edge texel, in place of the neighbour it has not.
    for (const double area : texel_areas(square, texel_grid(square, 4)))
        EXPECT_NEAR(area, 4.0 / 16, 1e-12);
}

std::string refusal(const Shape& shape) {
    try {
        texel_areas(shape, texel_grid(shape, 32));
    } catch (const UnsupportedScene& error) {
        return error.what();
    }
    return "taken";
}

TEST(TexelAreas, RefuseTextureCoordinatesThatNameNoPlaceOrSeveral) {
    const auto shape = [](TriangleMesh mesh) {
        return support::mesh("crate", std::move(mesh), Transform::Identity(), support::diffuse(1));
    };
    EXPECT_NE(refusal(shape(tessellate_cube(2))).find("overlap"), std::string::npos);
    TriangleMesh plain = tessellate_rectangle(2);
    plain.uvs.clear();
    EXPECT_NE(refusal(shape(plain)).find("\"crate\" has no texture coordinates"),
              std::string::npos);
    TriangleMesh outside = tessellate_rectangle(2);
    outside.uvs[0].x() = -0.5F;
    EXPECT_NE(refusal(shape(outside)).find("outside"), std::string::npos);
    TriangleMesh flat = tessellate_rectangle(2);
    for (Vec2& uv : flat.uvs) uv.y() = 0.5F;
    EXPECT_NE(refusal(shape(flat)).find("span no area"), std::string::npos);
    EXPECT_EQ(refusal(shape(tessellate_rectangle(2))), "taken");
}

}  // namespace
}  // namespace caustics
