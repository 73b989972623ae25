#include "core/mesh/mesh_io.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "tests/core/mesh/mesh_files.h"
#include "tests/core/mesh/mesh_measures.h"

namespace caustics {
namespace {

using test::area;
using test::expect_same;
using test::PlyContent;

class MeshIo : public test::MeshFiles {};

const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST_F(MeshIo, ObjKeepsNormalsAndTurnsUvAsMitsuba) {
    const TriangleMesh mesh = load("a.obj", corners +
                                                "vt 0 0.25\nvt 1 0.5\nvt 1 1\nvn 0 0 2\nvn 0 3 4\n"
                                                "f 1/1/1 2/2/2 3/3/1\n");
    ASSERT_EQ(mesh.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}}));
    EXPECT_EQ(mesh.uvs[0], Vec2(0, 0.75F));
    EXPECT_EQ(mesh.uvs[1], Vec2(1, 0.5F));
    EXPECT_EQ(mesh.uvs[2], Vec2(1, 0));
    EXPECT_EQ(mesh.normals[0], Vec3(0, 0, 1));
    EXPECT_LT((mesh.normals[1] - Vec3(0, 0.6F, 0.8F)).norm(), 1e-7F);
}

TEST_F(MeshIo, AFaceThatWouldTakeVeryLongToCutIsNamed) {
    std::string tangle;
    for (int i = 0; i < 20'000; ++i)
        tangle += "v " + std::to_string(i * 7919 % 20'011) + " " +
                  std::to_string(i * 6997 % 19'997) + " 0\n";
    tangle += "f 1 2 3\nf";
    for (int i = 1; i <= 20'000; ++i) tangle += " " + std::to_string(i);
    expect_refused("a.obj", tangle + "\n", ":20002: a polygon of 20000 corners");
}

TEST_F(MeshIo, ObjObjectsGroupsAndMaterialsAreOneMesh) {
    const TriangleMesh mesh =
        load("a.obj", "mtllib missing.mtl\no a\n" + corners +
                          "usemtl red\nf 1 2 3\no b\ng c\ns 1\nusemtl blue\nf 1 3 4\nl 1 2\np 3\n");
    EXPECT_EQ(mesh.positions.size(), 4U);
    EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}}));
}

TEST_F(MeshIo, ObjMayCountBackwardsContinueLinesAndColourVertices) {
    const TriangleMesh plain = load("a.obj", corners + "f 1 2 3 4\n");
    expect_same(plain, load("b.obj", corners + "f -4 -3 -2 -1\n"));
    expect_same(plain, load("c.obj", corners + "f 1 2 \\\n3 4\n"));
    expect_same(plain, load("d.obj", corners + "f 1 2 3 4"));
    expect_same(plain,
                load("e.obj", "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 1\nv 0 1 0 # d\nf 1 2 3 4"));
    expect_same(plain, load("g.obj", "\xEF\xBB\xBF" + corners + "f 1 2 3 4\n"));
    expect_same(plain, load("k.obj", "# C:\\models\\\n" + corners + "f 1 2 3 4 # c \\"));
    for (const std::string slashes : {"/", "//"}) {
        std::string face = "f";
        for (const char* corner : {" 1", " 2", " 3", " 4"}) face += corner + slashes;
        expect_same(plain, load("h.obj", corners + face + "\n"));
    }
    expect_same(load("i.obj", corners + "vt 0 0.25\nf 1/1 2/1 3/1\n"),
                load("j.obj", corners + "vt 0 0.25\nf 1/1/ 2/1/ 3/1/\n"));
    std::string dos;
    for (const char c : corners + "f 1 2 3 4\n") dos += c == '\n' ? "\r\n" : std::string(1, c);
    expect_same(plain, load("f.OBJ", dos));
}

TEST_F(MeshIo, ObjIsReadAsOtherProgramsWriteIt) {
    const TriangleMesh plain = load("a.obj", corners + "f 1 2 3 4\n");
    expect_same(plain,
                load("b.obj", "v 0 +0 0\nv +1 0 0\nv 1.0D0 10d-1 0\nv 0 +1.0E+00 0\nf 1 2 3 4\n"));
    expect_same(plain, load("c.obj", "f 1 2 3 4\n" + corners));  // the face comes first
    expect_same(plain, load("d.obj", corners + "f +1 +2 +3 +4\n"));
    const std::string homogeneous = "v 0 0 0 2\nv 2 0 0 2\nv -3 -3 -0 -3\nv 0 0.5 0 0.5\n";
    expect_same(plain, load("e.obj", homogeneous + "f 1 2 3 4\n"));
    expect_same(plain, load("f.obj", "cstype bezier\nvw 0 1\nvp 0.5\n" + corners +
                                         "curv 0 1 1 2\nend\nf 1 2 3 4\n"));  // curves have no area
    expect_same(load("g.obj", corners + "vt 0.5 0\nvn 0 0 2\nf 1/1/1 2/1/1 3/1/1\n"),
                load("h.obj", "f 1/1/1 2/1/1 3/1/1\n" + corners + "vt 0.5\nvn 0 0 2\n"));
}

TEST_F(MeshIo, ObjIndicesBelowZeroCountFromTheFace) {
    const TriangleMesh mesh = load("a.obj", corners + "f -4 -3 -2\nv 0 0 1\nf -5 -4 -1\n");
    EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 1, 3}}));
    EXPECT_EQ(mesh.positions[3], Vec3(0, 0, 1));
}

TEST_F(MeshIo, VerticesWithoutNormalOrUvBesideOthersAreCompleted) {
    const TriangleMesh mesh =
        load("a.obj", corners + "vt 0.5 0.5\nvn 1 0 0\nf 1/1/1 2/1/1 3/1/1\nf 1 3 4\n");
    ASSERT_EQ(mesh.triangles.size(), 2U);
    for (int corner = 0; corner < 3; ++corner) {
        const auto i = static_cast<std::size_t>(corner);
        EXPECT_EQ(mesh.normals[mesh.triangles[0][i]], Vec3(1, 0, 0));
        EXPECT_EQ(mesh.normals[mesh.triangles[1][i]], Vec3(0, 0, 1));
        EXPECT_EQ(mesh.uvs[mesh.triangles[0][i]], Vec2(0.5F, 0.5F));
    }
}

TEST_F(MeshIo, ObjNumbersAreTheNearestFloats) {
    std::mt19937 random(3);
    std::string text;
    std::vector<std::string> written;
    for (int i = 0; i < 3000; ++i) {
        const auto digits = std::to_string(random() % 1'000'000);
        written.push_back((i % 2 == 0 ? "-" : "") + std::to_string(random() % 10) + "." + digits +
                          (i % 3 == 0 ? "e-3" : ""));
        text += (i % 3 == 0 ? "v " : " ") + written.back() + (i % 3 == 2 ? "\n" : "");
    }
    for (int i = 1; i <= 1000; ++i) text += "f " + std::to_string(i) + " 1 2\n";
    const TriangleMesh mesh = load("a.obj", text);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_EQ(
                mesh.positions[mesh.triangles[i][0]][axis],
                std::strtof(written[3 * i + static_cast<std::size_t>(axis)].c_str(), nullptr));
}

TEST_F(MeshIo, ObjCornersThatAgreeAreOneVertex) {
    // A position named twice, and zeros of both signs; 2,500 others, so that the table of vertices grows.
    std::string text = "v 0 0 0\nv -0 0 -0\nvt 0 0\nvt 0 0\nvt 1 0\n";
    for (int i = 0; i < 2500; ++i) text += "v " + std::to_string(i) + " 1 0\n";
    text += "f 1/1 2/2 3/1\nf 1/3 1/1 3/1\n";
    for (int i = 3; i < 2502; ++i)
        text += "f " + std::to_string(i) + "/1 " + std::to_string(i + 1) + "/1 2/1\n";
    const TriangleMesh mesh = load("a.obj", text);
    EXPECT_EQ(mesh.positions.size(), 2U + 2500U);
    using Triangle = std::array<std::uint32_t, 3>;
    EXPECT_EQ(mesh.triangles[0], (Triangle{0, 0, 1}));
    EXPECT_EQ(mesh.triangles[1], (Triangle{2, 0, 1})) << "other texture coordinates";
    EXPECT_EQ(mesh.triangles[2], (Triangle{1, 3, 0}));
    EXPECT_EQ(mesh.triangles.back(), (Triangle{2500, 2501, 0}));
}

TEST_F(MeshIo, BrokenObjFilesAreRefusedWithTheLine) {
    expect_refused("a.obj", corners + "f 1 2 5\n",
                   ":5: face corner '5': no position 5 among the 4");
    expect_refused("a.obj", corners + "f -5 1 2\n",
                   ":5: face corner '-5': no position -5 among the 4 above");
    expect_refused("a.obj", corners + "f 0 1 2\n",
                   ":5: face corner '0': no position 0, the first one is 1");
    expect_refused("a.obj", corners + "vt 0 0\nf 1/0 2/1 3/1\n",
                   ":6: face corner '1/0': no uv 0, the first one is 1");
    expect_refused("a.obj", corners + "f 1 2\n", "at least 3 corners, this one has 2");
    expect_refused("a.obj", corners + "f 1 2 3\nf 1 3", ":6: a face needs");
    expect_refused("a.obj", corners + "f 1 a 3\n", "face corner 'a'");
    expect_refused("a.obj", corners + "f 1/1/1/1 2 3\n", "more than three");
    expect_refused("a.obj", corners + "f 1/// 2 3\n", "more than three");
    expect_refused("a.obj", corners + "f /1 2 3\n", "face corner '/1' is not v");
    expect_refused("a.obj", corners + "f 1// 2 3\n\xEF\xBB\xBFv 0 0 0\n", ":6: '???v'");
    expect_refused("a.obj", corners + "vt 0 0\nf 1/1 2/2 3/1\n", ":6: face corner '2/2': no uv 2");
    expect_refused("a.obj", corners + "vn 0 0 1\nf 1//1 2//2 3//1\n", "no normal 2");
    expect_refused("a.obj", corners + "vt 0 0\nf 1/1 2 3/1\n", "same form");
    expect_refused("a.obj", corners, "no faces");
    expect_refused("a.obj", "v 0 0\nf 1 1 1\n", ":1: v needs 3, 4 or 6 numbers");
    expect_refused("a.obj", "v 0 nan 0\n", ":1: 'nan' is not a finite number");
    expect_refused("a.obj", "v 0 1e39 0\n", "not a finite number");
    expect_refused("a.obj", "v 0 1.0.0 0\n", "is not a number");
    expect_refused("a.obj", corners + "v 0 0 0 0\nf 1 2 3\n", ":5: the weight w is 0");
    expect_refused("a.obj", corners + "v 1e30 0 0 1e-30\nf 1 2 3\n", ":5: the weight w is 1e-30");
    expect_refused("a.obj", corners + "f 1 2 3\nsurf 0 1 0 1 1 2 3 4\n",
                   ":6: 'surf': curved surfaces");
    expect_refused("a.obj", corners + "cstype bezier\ndeg 3\ncurv 0 1 1 2 3 4\nend\n",
                   ": no faces: curves are not supported");
    expect_refused("a.obj", corners + "f -1 -2 -3\nv 0 0 1\nf -6 1 2\n", ":7: face corner '-6'");
    expect_refused("a.obj", corners + "f 1 2 +-3\n", "face corner '+-3' is not v");
    expect_refused("a.obj", "v 0 +-1 0\n", "'+-1' is not a number");
    expect_refused("a.obj", "v 0 1.0D 0\n", "'1.0D' is not a number");
    expect_refused("a.obj", "vx 1 2\n", "'vx' is not supported");
    expect_refused("a.obj", std::string("\0\1\2rubbish", 10), "is not supported");
}

TEST_F(MeshIo, WhatIsNoMeshFileIsRefused) {
    for (const char* name : {"a.ply", "a.obj"}) expect_refused(name, "", "the file is empty");
    expect_refused("a.stl", "solid", "unknown mesh format '.stl' (known: .obj, .ply)");
    expect_refused("a", "v 0 0 0", "unknown mesh format ''");
    EXPECT_NE(refusal(folder_ / "absent.ply").find("no such file"), std::string::npos);
    std::filesystem::create_directory(folder_ / "folder.obj");
    EXPECT_NE(refusal(folder_ / "folder.obj").find("not a regular file"), std::string::npos);
}

TEST_F(MeshIo, ConvexAndConcavePolygonsKeepTheirAreaAndSide) {
    struct Polygon {
        const char* points;
        int corners;
        double area;
    };
    const Polygon polygons[] = {{"v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\n", 4, 4},
                                {"v 0 0 0\nv 2 0 0\nv 0.5 0.5 0\nv 0 2 0\n", 4, 1},
                                {"v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 0.5 0\nv 0 2 0\n", 5, 2.5},
                                {"v 0 0 0\nv 3 0 0\nv 3 1 0\nv 1 1 0\nv 1 2 0\nv 3 2 0\nv 3 3 0\n"
                                 "v 0 3 0\n",
                                 8, 7}};
    for (const Polygon& polygon : polygons)
        for (int start = 0; start < polygon.corners; ++start) {
            std::string face = "f";
            for (int i = 0; i < polygon.corners; ++i)
                face += " " + std::to_string((start + i) % polygon.corners + 1);
            const TriangleMesh mesh = load("a.obj", polygon.points + face);
            EXPECT_EQ(mesh.triangles.size(), static_cast<std::size_t>(polygon.corners) - 2);
            EXPECT_NEAR(area(mesh), polygon.area, 1e-6) << polygon.points << face;
            for (const Vec3& normal : mesh.normals) EXPECT_GT(normal.z(), 0.99F);
        }
}

TEST_F(MeshIo, DegenerateTrianglesStayAndNormalsStayUnit) {
    const TriangleMesh mesh = load("a.obj",
                                   "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 5 5 5\n"
                                   "f 1 2 3\nf 1 2 2\nf 1 2 4\nf 5 5 5\nf 1 2 3 3\n");
    EXPECT_EQ(mesh.triangles.size(), 6U);
    for (const Vec3& normal : mesh.normals) EXPECT_EQ(normal, Vec3(0, 0, 1));
}

TEST_F(MeshIo, SheetsBackToBackHaveUnitNormals) {
    const TriangleMesh mesh = load("a.obj", corners + "f 1 2 3\nf 3 2 1\n");
    for (const Vec3& normal : mesh.normals) EXPECT_EQ(std::abs(normal.z()), 1);
}

// At the corner of a cube the three faces weigh the same, however each is cut into triangles.
TEST_F(MeshIo, MadeNormalsAreWeightedByAngleOverSharedPositions) {
    PlyContent cube;
    const int sides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                             {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (const auto& side : sides) {
        const auto first = static_cast<std::uint32_t>(cube.rows.size());
        for (const int c : side)
            cube.rows.push_back(
                {(c & 1) != 0 ? 1.F : -1.F, (c & 2) != 0 ? 1.F : -1.F, (c & 4) != 0 ? 1.F : -1.F});
        cube.polygons.push_back({first, first + 1, first + 2, first + 3});
    }
    const TriangleMesh mesh = load("cube.ply", test::ascii_ply(cube));
    ASSERT_EQ(mesh.positions.size(), 24U);
    for (std::size_t i = 0; i < 24; ++i)
        EXPECT_LT((mesh.normals[i] - mesh.positions[i].normalized()).norm(), 1e-6F);
}

TEST_F(MeshIo, FaceNormalsLeaveNormalsOutAndFlipTurnsTheMesh) {
    const std::string bytes = corners + "vn 0 0 1\nf 1//1 2//1 3//1\n";
    const TriangleMesh flat = load("a.obj", bytes, {.face_normals = true});
    EXPECT_TRUE(flat.normals.empty());
    const TriangleMesh turned = load("a.obj", bytes, {.flip_normals = true});
    for (const Vec3& normal : turned.normals) EXPECT_EQ(normal.z(), -1);
    EXPECT_EQ(turned.triangles[0], (std::array<std::uint32_t, 3>{0, 2, 1}));
}

TEST_F(MeshIo, APolygonOfAThousandCornersIsATriangulatedDisk) {
    std::ostringstream text;
    std::string face = "f";
    for (int i = 0; i < 1000; ++i) {
        text << "v " << std::cos(2 * pi_d * i / 1000) << ' ' << std::sin(2 * pi_d * i / 1000)
             << " 0\n";
        face += " " + std::to_string(i + 1);
    }
    const TriangleMesh mesh = load("a.obj", text.str() + face + "\n");
    EXPECT_EQ(mesh.triangles.size(), 998U);
    EXPECT_NEAR(area(mesh), 500 * std::sin(2 * pi_d / 1000), 1e-4);
}

}  // namespace
}  // namespace caustics
