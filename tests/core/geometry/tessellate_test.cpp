#include "core/geometry/tessellate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "core/base/error.h"
#include "core/geometry/height_grid.h"
#include "tests/core/mesh/mesh_measures.h"

namespace caustics {
namespace {

using test::area;
using test::area_vector;
using test::euler_characteristic;
using test::volume;

SineHeightfield waves() {
    SineHeightfield field;
    field.waves = {{0.1, {3, 1}, 0.2}, {0.05, {-2, 4}, 1.1}};
    field.half_size = {2, 1};
    return field;
}

// As a vector grows it takes up to twice the memory, and copies all once more.
TEST(Tessellate, TakesTheMemoryOfAGridAtOnce) {
    const auto expect_no_more = [](const TriangleMesh& mesh) {
        EXPECT_EQ(mesh.positions.capacity(), mesh.positions.size());
        EXPECT_EQ(mesh.normals.capacity(), mesh.positions.size());
        EXPECT_EQ(mesh.uvs.capacity(), mesh.positions.size());
        EXPECT_EQ(mesh.triangles.capacity(), mesh.triangles.size());
    };
    HeightGrid grid{.columns = 40, .rows = 25};
    grid.heights.resize(std::size_t{41} * 26);
    expect_no_more(tessellate_grid(grid));
    expect_no_more(tessellate_rectangle({40, 25}));
    expect_no_more(tessellate_heightfield(waves(), {40, 25}));
}

struct Case {
    const char* name;
    std::function<TriangleMesh(int)> make;
    int least;
    int euler;      ///< V - E + F with vertices at one position counted once
    double area;    ///< of the exact shape; 0 where there is no closed form
    double volume;  ///< enclosed, or else the flux of x/3 through the open shape
    std::function<double(const Vec3d&)> off_shape;
    std::function<Vec3d(const Vec3d&)> normal;  ///< none for the cube
};

std::vector<Case> cases() {
    const auto up = [](const Vec3d&) { return Vec3d(0, 0, 1); };
    const auto flat = [](const Vec3d& p) { return p.z(); };
    return {
        {"rectangle", tessellate_rectangle, 1, 1, 4, 0, flat, up},
        {"disk", tessellate_disk, 1, 1, pi_d, 0, flat, up},
        {"sphere", tessellate_sphere, 2, 2, 4 * pi_d, 4 * pi_d / 3,
         [](const Vec3d& p) { return p.norm() - 1; }, [](const Vec3d& p) { return p; }},
        {"cylinder", tessellate_cylinder, 1, 0, 2 * pi_d, 2 * pi_d / 3,
         [](const Vec3d& p) { return p.head<2>().norm() - 1; },
         [](const Vec3d& p) { return Vec3d(p.x(), p.y(), 0); }},
        {"cube",
         tessellate_cube,
         1,
         2,
         24,
         8,
         [](const Vec3d& p) { return p.lpNorm<Eigen::Infinity>() - 1; },
         {}},
        {"heightfield", [](int n) { return tessellate_heightfield(waves(), n); }, 1, 1, 0, 0,
         [](const Vec3d& p) { return p.z() - waves().height(p.head<2>()); },
         [](const Vec3d& p) { return waves().normal(p.head<2>()); }},
    };
}

class Tessellate : public testing::TestWithParam<Case> {
protected:
    std::vector<int> resolutions() const { return {GetParam().least, 2, 3, 5, 16}; }
};

TEST_P(Tessellate, HasTheShapesTopology) {
    for (const int n : resolutions())
        EXPECT_EQ(euler_characteristic(GetParam().make(n)), GetParam().euler) << n;
}

TEST_P(Tessellate, VerticesLieOnTheShapeWithItsNormals) {
    for (const int n : resolutions()) {
        const TriangleMesh mesh = GetParam().make(n);
        ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
        ASSERT_EQ(mesh.uvs.size(), mesh.positions.size());
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            const Vec3d p = mesh.positions[i].cast<double>();
            const Vec3d normal = mesh.normals[i].cast<double>();
            EXPECT_NEAR(GetParam().off_shape(p), 0, 2e-7);
            EXPECT_NEAR(normal.norm(), 1, 2e-7);
            // 16 roundings of a coordinate of up to 2 through a curvature of up to 2.
            if (GetParam().normal) {
                EXPECT_LT((normal - GetParam().normal(p)).norm(), 1e-6);
            }
            EXPECT_GE(mesh.uvs[i].minCoeff(), 0);
            EXPECT_LE(mesh.uvs[i].maxCoeff(), 1);
        }
    }
}

TEST_P(Tessellate, WindsTrianglesAroundTheirNormals) {
    for (const int n : resolutions()) {
        const TriangleMesh mesh = GetParam().make(n);
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            const Vec3d facing = area_vector(mesh, t);
            EXPECT_GT(facing.norm(), 0.1 / (n * n * n));
            for (const std::uint32_t vertex : mesh.triangles[t])
                EXPECT_GT(facing.normalized().dot(mesh.normals[vertex].cast<double>()), 0.1)
                    << n << ' ' << t;
        }
    }
}

// Linear triangles: the errors of area and volume fall by 4 as n doubles.
TEST_P(Tessellate, AreaAndVolumeConvergeAtSecondOrder) {
    const Case& shape = GetParam();
    const TriangleMesh coarse = shape.make(16);
    const TriangleMesh fine = shape.make(32);
    if (shape.area > 0) {
        const double error = std::abs(area(fine) - shape.area);
        EXPECT_LT(error, 0.01 * shape.area);
        const double ratio = std::abs(area(coarse) - shape.area) / error;
        if (error > 1e-5) {
            EXPECT_NEAR(ratio, 4, 0.1);
        }
        const double volume_error = std::abs(volume(fine) - shape.volume);
        if (volume_error > 1e-5) {
            EXPECT_NEAR(std::abs(volume(coarse) - shape.volume) / volume_error, 4, 0.1);
        }
    } else {
        const double limit = area(shape.make(256));
        EXPECT_NEAR((limit - area(coarse)) / (limit - area(fine)), 4, 0.15);
    }
}

TEST_P(Tessellate, RefusesResolutionsThatMakeNoMesh) {
    EXPECT_THROW(GetParam().make(GetParam().least - 1), InputError);
    EXPECT_THROW(GetParam().make(-3), InputError);
    EXPECT_THROW(GetParam().make(1'000'000), InputError);
}

INSTANTIATE_TEST_SUITE_P(Shapes, Tessellate, testing::ValuesIn(cases()),
                         [](const auto& shape) { return std::string(shape.param.name); });

TEST(TessellateCounts, AreAsDocumented) {
    EXPECT_EQ(tessellate_rectangle(3).triangles.size(), 18U);
    EXPECT_EQ(tessellate_disk(3).triangles.size(), 12U + 2 * 2 * 12U);
    EXPECT_EQ(tessellate_sphere(4).triangles.size(), 8U * 2 + 8 * 2 * 2U);
    EXPECT_EQ(tessellate_cylinder(2).triangles.size(), 8U * 2 * 2);
    EXPECT_EQ(tessellate_cube(2).triangles.size(), 6U * 8);
    EXPECT_EQ(tessellate_heightfield(waves(), 3).triangles.size(), 18U);
    EXPECT_EQ(tessellate_rectangle({3, 2}).triangles.size(), 12U);
    EXPECT_EQ(tessellate_heightfield(waves(), {1, 5}).triangles.size(), 10U);
}

// A corner of Mitsuba's cube, one a face: (1, -1, -1) has uv (0, 1), (0, 1) and (1, 1).
TEST(TessellateCube, HasMitsubasUvs) {
    const TriangleMesh mesh = tessellate_cube(1);
    std::multiset<std::pair<float, float>> uvs;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        if (mesh.positions[i] == Vec3(1, -1, -1)) uvs.emplace(mesh.uvs[i].x(), mesh.uvs[i].y());
    EXPECT_EQ(uvs, (std::multiset<std::pair<float, float>>{{0, 1}, {0, 1}, {1, 1}}));
}

TriangleMesh one_triangle() {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 1}};
    mesh.normals.assign(3, Vec3(0, -1, 1).normalized());
    mesh.triangles = {{0, 1, 2}};
    return mesh;
}

TEST(MeshTransform, KeepsNormalsAcrossTheSurfaceUnderAnyMap) {
    for (const double mirror : {1.0, -1.0}) {
        TriangleMesh mesh = one_triangle();
        Transform map = Transform::Identity();
        map.linear() << 2 * mirror, 0.3, 0, 0, 0.5, 0.1, 0, 0, 7;
        map.translation() = Vec3d(1, 2, 3);
        transform(mesh, map);
        const Vec3d facing = area_vector(mesh, 0).normalized();
        for (const Vec3& normal : mesh.normals)
            EXPECT_LT((normal.cast<double>() - facing).norm(), 1e-6) << mirror;
        EXPECT_EQ(mesh.positions[1], Vec3(static_cast<float>(1 + 2 * mirror), 2, 3));
        EXPECT_EQ(mesh.triangles[0][1], mirror > 0 ? 1U : 2U);
    }
}

TEST(MeshTransform, AMirroredSphereStillEnclosesItsVolume) {
    TriangleMesh mesh = tessellate_sphere(16);
    const double before = volume(mesh);
    transform(mesh, Transform(Eigen::Scaling(Vec3d(-1, 2, 3))));
    EXPECT_NEAR(volume(mesh), 6 * before, 1e-4);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        EXPECT_GT(mesh.positions[i].dot(mesh.normals[i]), 0);
}

TEST(MeshTransform, RefusesSingularAndNonFiniteMaps) {
    TriangleMesh mesh = one_triangle();
    EXPECT_THROW(transform(mesh, Transform(Eigen::Scaling(Vec3d(1, 0, 1)))), InputError);
    Transform broken = Transform::Identity();
    broken.translation().x() = std::nan("");
    EXPECT_THROW(transform(mesh, broken), InputError);
}

TEST(MeshFlip, TurnsTrianglesAndNormals) {
    TriangleMesh mesh = tessellate_sphere(8);
    const double before = volume(mesh);
    flip(mesh);
    EXPECT_DOUBLE_EQ(volume(mesh), -before);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        EXPECT_LT(mesh.positions[i].dot(mesh.normals[i]), 0);
}

Shape exact_at(Primitive primitive, const Vec3d& place) {
    Shape shape;
    shape.primitive = primitive;
    shape.to_world = Eigen::Translation3d(place) * Eigen::Scaling(0.5);
    shape.flip_normals = true;
    return shape;
}

TEST(OwnFrameMeshes, AreMadeOnceForAllShapesOfAKind) {
    OwnFrameMeshes meshes(8);
    const Shape first = exact_at(Primitive::sphere, {1, 2, 3});
    const Shape second = exact_at(Primitive::sphere, {4, 5, 6});
    const Shape disk = exact_at(Primitive::disk, {1, 2, 3});
    EXPECT_EQ(&meshes.of(first), &meshes.of(second));
    EXPECT_NE(&meshes.of(first), &meshes.of(disk));
}

TEST(OwnFrameMeshes, BecomeTheShapesMeshWherePlaced) {
    OwnFrameMeshes meshes(8);
    Shape field = exact_at(Primitive::heightfield, {0, 0, 0});
    field.field = waves();
    const Shape flat_field = exact_at(Primitive::heightfield, {0, 0, 0});
    for (const Shape& shape : {exact_at(Primitive::sphere, {1, 2, 3}),
                               exact_at(Primitive::sphere, {4, 5, 6}), field, flat_field}) {
        TriangleMesh mesh = meshes.of(shape);
        place_exact(mesh, shape);
        const TriangleMesh expected = tessellate_shape(shape, 8);
        EXPECT_EQ(mesh.positions, expected.positions);
        EXPECT_EQ(mesh.normals, expected.normals);
        EXPECT_EQ(mesh.triangles, expected.triangles);
    }
}

}  // namespace
}  // namespace caustics
