#include "core/mesh/mesh_audit.h"

#include <gtest/gtest.h>

#include "core/geometry/tessellate.h"

namespace caustics {
namespace {

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
