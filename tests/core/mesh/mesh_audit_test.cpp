#include "core/mesh/mesh_audit.h"

#include <gtest/gtest.h>

#include "core/geometry/tessellate.h"

namespace caustics {
namespace {

using Common = std::vector<CommonTriangles>;

Common common_of(const std::vector<TriangleMesh>& meshes) {
    std::vector<const TriangleMesh*> pointers;
    for (const TriangleMesh& mesh : meshes) pointers.push_back(&mesh);
    return common_triangles(pointers);
}

TriangleMesh moved_cube(double z) {
    TriangleMesh cube = tessellate_cube(1);
    transform(cube, Transform(Eigen::Translation3d(0, 0, z)));
    return cube;
}

TEST(MeshAudit, FindsTrianglesThatMeshesShare) {
    const TriangleMesh cube = tessellate_cube(1);
    TriangleMesh turned = cube;
    flip(turned);
    EXPECT_EQ(common_of({cube, turned}), (Common{{0, 1, 12}}));
    EXPECT_EQ(common_of({cube, moved_cube(3), turned, moved_cube(3)}),
              (Common{{0, 2, 12}, {1, 3, 12}}));
    // Two cubes side by side have one face in common; its diagonals may differ.
    for (const CommonTriangles& common : common_of({cube, moved_cube(2)}))
        EXPECT_LE(common.count, 2U);
    EXPECT_EQ(common_of({cube, moved_cube(3)}), Common{});
    EXPECT_EQ(common_of({cube}), Common{});
}

TEST(MeshAudit, CountsTheTrianglesOfTheFirstMesh) {
    TriangleMesh twice = tessellate_cube(1);
    const auto once = twice.triangles;
    twice.triangles.insert(twice.triangles.end(), once.begin(), once.end());
    const TriangleMesh cube = tessellate_cube(1);
    EXPECT_EQ(common_of({twice, cube}), (Common{{0, 1, 24}}));
    EXPECT_EQ(common_of({cube, twice}), (Common{{0, 1, 12}}));
}

}  // namespace
}  // namespace caustics
