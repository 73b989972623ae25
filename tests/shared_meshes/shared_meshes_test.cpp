#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>

#include "core/mesh/mesh_doctor.h"
#include "core/mesh/mesh_io.h"

namespace caustics {
namespace {

std::filesystem::path mesh_file(const std::string& name) {
    return std::filesystem::path(CAUSTICS_SHARED_DIR) / "meshes" / name;
}

TriangleMesh load(const std::string& name) { return load_mesh(mesh_file(name), {}); }

std::string bytes_of(const std::string& name) {
    std::ifstream stream(mesh_file(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

using Point = std::array<float, 3>;
Point key(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

/// Directed edges between positions that have no partner running the other way.
std::size_t open_edges(const TriangleMesh& mesh) {
    std::map<std::pair<Point, Point>, int> edges;
    for (const auto& triangle : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            const Point a = key(mesh.positions[triangle[i]]);
            const Point b = key(mesh.positions[triangle[(i + 1) % 3]]);
            if (a == b) continue;
            ++edges[{a, b}];
            --edges[{b, a}];
        }
    std::size_t open = 0;
    for (const auto& [edge, surplus] : edges) open += surplus > 0 ? 1 : 0;
    return open;
}

void expect_sound(const TriangleMesh& mesh) {
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    for (const Vec3& p : mesh.positions) ASSERT_TRUE(p.allFinite());
    for (const Vec3& n : mesh.normals) ASSERT_NEAR(n.norm(), 1, 1e-6);
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t vertex : triangle) ASSERT_LT(vertex, mesh.positions.size());
}

struct Count {
    const char* file;
    std::size_t triangles;  ///< sum over the file's polygons of (corners - 2)
};

class SharedMesh : public testing::TestWithParam<Count> {};

TEST_P(SharedMesh, LoadsWholeAndSound) {
    const TriangleMesh mesh = load(GetParam().file);
    EXPECT_EQ(mesh.triangles.size(), GetParam().triangles);
    expect_sound(mesh);
}

INSTANTIATE_TEST_SUITE_P(
    All, SharedMesh,
    testing::Values(Count{"dolphin/dolphin_sgi.obj", 211}, Count{"tungsten/water.ply", 102'938},
                    Count{"ignis/Diamond.ply", 270}, Count{"ignis/Gem.ply", 2 * 16 + 32},
                    Count{"gems/octahedron_diamond.obj", 8}, Count{"sms/pool_border.obj", 384},
                    Count{"sms/pool_inside.obj", 426}, Count{"sms/torus.obj", 3600},
                    Count{"sms/slab18_floor.obj", 2}, Count{"sms/slab18_plane_2.obj", 2048},
                    Count{"sms/slab18_planes_border.obj", 2048}, Count{"sms/water_plane.obj", 2}));

// The file's own bytes: 8 little-endian floats a vertex, in file order.
TEST(SharedMeshes, WaterKeepsEveryVertexBitForBit) {
    const TriangleMesh mesh = load("tungsten/water.ply");
    const std::string bytes = bytes_of("tungsten/water.ply");
    const std::size_t body = bytes.find("end_header\n") + 11;
    ASSERT_EQ(mesh.positions.size(), 54'771U);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        std::array<char, 32> raw{};
        bytes.copy(raw.data(), raw.size(), body + 32 * i);
        const auto row = std::bit_cast<std::array<float, 8>>(raw);
        ASSERT_EQ(mesh.positions[i], Vec3(row[0], row[1], row[2])) << i;
        ASSERT_EQ(mesh.uvs[i], Vec2(row[6], row[7])) << i;
        ASSERT_LT((mesh.normals[i] - Vec3(row[3], row[4], row[5])).norm(), 1e-5F) << i;
    }
}

TEST(SharedMeshes, WaterFacesUpOverItsSquare) {
    const TriangleMesh mesh = load("tungsten/water.ply");
    Vec3d area = Vec3d::Zero();
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3 edge = mesh.positions[b] - mesh.positions[a];
        area += edge.cross(mesh.positions[c] - mesh.positions[a]).cast<double>() / 2;
    }
    EXPECT_NEAR(area.y(), 4, 0.05);
}

TEST(SharedMeshes, DiamondAndTorusAreWatertight) {
    EXPECT_EQ(open_edges(load("ignis/Diamond.ply")), 0U);
    EXPECT_EQ(open_edges(load("sms/torus.obj")), 0U);
    EXPECT_EQ(open_edges(load("gems/octahedron_diamond.obj")), 0U);
}

TEST(SharedMeshes, DolphinKeepsItsPositionsAndIsOpen) {
    const TriangleMesh mesh = load("dolphin/dolphin_sgi.obj");
    std::istringstream lines(bytes_of("dolphin/dolphin_sgi.obj"));
    std::set<Point> used;
    for (const Vec3& p : mesh.positions) used.insert(key(p));
    std::set<Point> given;
    for (std::string line; std::getline(lines, line);) {
        if (line.rfind("v ", 0) != 0) continue;
        std::istringstream numbers(line.substr(2));
        Point p{};
        numbers >> p[0] >> p[1] >> p[2];
        given.insert(p);
    }
    EXPECT_EQ(used, given);
    EXPECT_GT(open_edges(mesh), 0U);
}

struct Anatomy {
    const char* file;
    std::size_t parts, closed, open_edges, holes, duplicates, crowded_edges, inside_out;
};

class SharedAnatomy : public testing::TestWithParam<Anatomy> {};

// The numbers are those of a program of its own that follows edges from face to face.
TEST_P(SharedAnatomy, IsDiagnosed) {
    const Anatomy& known = GetParam();
    TriangleMesh mesh = load(known.file);
    const MeshDiagnosis found = diagnose(mesh);
    EXPECT_EQ(found.parts, known.parts);
    EXPECT_EQ(found.closed_parts, known.closed);
    EXPECT_EQ(found.open_edges, known.open_edges);
    EXPECT_EQ(found.holes, known.holes);
    EXPECT_EQ(found.duplicates, known.duplicates);
    EXPECT_EQ(found.crowded_edges, known.crowded_edges);
    EXPECT_EQ(found.inside_out_parts, known.inside_out);
    EXPECT_EQ(found.turned_triangles, 0U);
    EXPECT_EQ(found.one_sided_parts, 0U);
    // Every third face turned, and turned back.
    for (std::size_t t = 0; t < mesh.triangles.size(); t += 3)
        std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    EXPECT_EQ(diagnose(mesh).open_edges, known.open_edges);
    orient(mesh);
    EXPECT_EQ(diagnose(mesh).turned_triangles, 0U);
    EXPECT_EQ(diagnose(mesh).inside_out_parts, 0U);
}

INSTANTIATE_TEST_SUITE_P(
    All, SharedAnatomy,
    testing::Values(Anatomy{"dolphin/dolphin_sgi.obj", 13, 3, 42, 8, 18, 4, 1},
                    Anatomy{"tungsten/water.ply", 1, 0, 1954, 1, 0, 0, 0},
                    Anatomy{"ignis/Diamond.ply", 1, 1, 0, 0, 0, 0, 0},
                    Anatomy{"ignis/Gem.ply", 1, 1, 0, 0, 0, 0, 0},
                    Anatomy{"gems/octahedron_diamond.obj", 1, 1, 0, 0, 0, 0, 0},
                    Anatomy{"sms/pool_border.obj", 1, 0, 16, 2, 0, 0, 0},
                    Anatomy{"sms/pool_inside.obj", 1, 0, 4, 1, 0, 0, 0},
                    Anatomy{"sms/torus.obj", 1, 1, 0, 0, 0, 0, 0},
                    Anatomy{"sms/slab18_plane_2.obj", 1, 0, 128, 1, 0, 0, 0},
                    Anatomy{"sms/slab18_planes_border.obj", 1, 0, 2048, 2, 0, 0, 0}));

}  // namespace
}  // namespace caustics
