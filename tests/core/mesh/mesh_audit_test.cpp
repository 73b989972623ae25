#include "core/mesh/mesh_audit.h"

#include <gtest/gtest.h>

#include "core/geometry/tessellate.h"

namespace caustics {
namespace {

TEST(MeshAudit, CountsOpenEdges) {
    EXPECT_EQ(open_edge_count(tessellate_sphere(8)), 0U);
    EXPECT_EQ(open_edge_count(tessellate_cube(3)), 0U);
    EXPECT_EQ(open_edge_count(tessellate_rectangle({3, 2})), 10U);
    EXPECT_EQ(open_edge_count(tessellate_cylinder(4)), 32U);
    // One triangle the wrong way round: its edges do not pair.
    TriangleMesh cube = tessellate_cube(1);
    std::swap(cube.triangles[0][0], cube.triangles[0][1]);
    EXPECT_EQ(open_edge_count(cube), 3U);
}

TEST(MeshAudit, VolumeIsBelowZeroInsideOut) {
    TriangleMesh cube = tessellate_cube(2);
    transform(cube, Transform(Eigen::Translation3d(1000, 0, 0)));
    EXPECT_NEAR(enclosed_volume(cube), 8, 1e-3);
    flip(cube);
    EXPECT_NEAR(enclosed_volume(cube), -8, 1e-3);
    EXPECT_EQ(enclosed_volume({}), 0);
}

TEST(MeshAudit, FindsTrianglesThatTwoMeshesShare) {
    const TriangleMesh cube = tessellate_cube(1);
    TriangleMesh turned = cube;
    flip(turned);
    EXPECT_EQ(common_triangles(cube, turned), 12U);
    // Two cubes side by side have one face in common; its diagonals may differ.
    TriangleMesh neighbour = cube;
    transform(neighbour, Transform(Eigen::Translation3d(0, 0, 2)));
    EXPECT_LE(common_triangles(cube, neighbour), 2U);
    transform(neighbour, Transform(Eigen::Translation3d(0, 0, 1)));
    EXPECT_EQ(common_triangles(cube, neighbour), 0U);
}

}  // namespace
}  // namespace caustics
