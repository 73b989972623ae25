#include "core/mesh/exact_positions.h"

#include <fmt/format.h>

#include "core/geometry/lathe.h"
#include "core/geometry/tessellate.h"
#include "tests/core/mesh/mesh_files.h"
#include "tests/core/mesh/mesh_measures.h"

namespace caustics::test {
namespace {

const Vec3d far_away(512345, 5412345, 300);

/// A sphere of radius 0.1 m in the words of a file, its middle anywhere.
class FarMeshes : public MeshFiles {
protected:
    static std::string obj(const Vec3d& middle) {
        const TriangleMesh mesh = tessellate_sphere(8);
        std::string text;
        for (const Vec3& p : mesh.positions) {
            const Vec3d at = middle + 0.1 * p.cast<double>();
            text += fmt::format("v {:.7f} {:.7f} {:.7f}\n", at.x(), at.y(), at.z());
        }
        for (const auto& [a, b, c] : mesh.triangles)
            text += fmt::format("f {} {} {}\n", a + 1, b + 1, c + 1);
        return text;
    }
    static std::string ply(const Vec3d& middle) {
        const TriangleMesh mesh = tessellate_sphere(8);
        std::string text = fmt::format(
            "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\n"
            "property double z\nelement face {}\nproperty list uchar int "
            "vertex_indices\nend_header\n",
            mesh.positions.size(), mesh.triangles.size());
        for (const Vec3& p : mesh.positions) {
            const Vec3d at = middle + 0.1 * p.cast<double>();
            text += fmt::format("{:.7f} {:.7f} {:.7f}\n", at.x(), at.y(), at.z());
        }
        for (const auto& [a, b, c] : mesh.triangles) text += fmt::format("3 {} {} {}\n", a, b, c);
        return text;
    }
};

TEST_F(FarMeshes, AreTheSameAsAtTheOriginWhenMovedBack) {
    for (const bool is_ply : {false, true}) {
        const auto words = is_ply ? ply : obj;
        const std::string ending = is_ply ? ".ply" : ".obj";
        const TriangleMesh here = load("here" + ending, words(Vec3d::Zero()));
        TriangleMesh there = load("there" + ending, words(far_away));
        EXPECT_TRUE(here.exact_positions.empty());
        ASSERT_EQ(there.exact_positions.size(), there.positions.size());
        transform(there, Transform(Eigen::Translation3d(-far_away)));
        EXPECT_TRUE(there.exact_positions.empty());
        ASSERT_EQ(there.positions.size(), here.positions.size());
        EXPECT_EQ(there.triangles, here.triangles);
        for (std::size_t i = 0; i < here.positions.size(); ++i) {
            EXPECT_LT((there.positions[i] - here.positions[i]).norm(), 2e-7F);
            EXPECT_LT((there.normals[i] - here.normals[i]).norm(), 1e-4F);
        }
    }
}

TEST_F(FarMeshes, AreOrientedAsAtTheOrigin) {
    std::string text = obj(far_away);
    std::size_t face = 0;
    for (std::size_t at = text.find("f "); at != std::string::npos; at = text.find("f ", at + 1)) {
        if (face++ % 3 != 0) continue;
        const std::size_t end = text.find('\n', at);
        std::istringstream words(text.substr(at + 2, end - at));
        std::string a, b, c;
        words >> a >> b >> c;
        text.replace(at, end - at, "f " + a + " " + c + " " + b);
    }
    TriangleMesh mesh = load("a.obj", text, {.orient = true});
    transform(mesh, Transform(Eigen::Translation3d(-far_away)));
    EXPECT_NEAR(volume(mesh), 4.1e-3, 2e-4);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        EXPECT_GT(mesh.positions[i].normalized().dot(mesh.normals[i]), 0.95F);
}

TEST_F(FarMeshes, KeepDoublesWherePartsLieFarApart) {
    std::string text = obj(Vec3d::Zero());
    for (const char* vertex : {"0 0 0.1", "0.1 0 0.1", "0 0.1 0.1"})
        text += fmt::format("v {}\n", vertex);
    text +=
        fmt::format("v {0}.123 {0} 300\nv {0}.223 {0} 300\nv {0} {0}.1 300\nf -3 -2 -1\n", 5412345);
    const TriangleMesh mesh = load("a.obj", text);
    EXPECT_FALSE(mesh.exact_positions.empty());
}

// The file itself has lost the mesh.
TEST_F(FarMeshes, BinaryFloatsThatAreTooCoarseAreRefused) {
    const auto binary = [](float x) {
        std::string bytes =
            "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\n"
            "property float y\nproperty float z\nelement face 1\n"
            "property list uchar int vertex_indices\nend_header\n";
        const std::array<float, 9> numbers = {x, 0, 0, x + 1, 0, 0, x, 1, 0};
        bytes.append(reinterpret_cast<const char*>(numbers.data()), sizeof numbers);
        const std::array<std::int32_t, 3> corners = {0, 1, 2};
        bytes += '\3';
        bytes.append(reinterpret_cast<const char*>(corners.data()), sizeof corners);
        return bytes;
    };
    EXPECT_EQ(load("near.ply", binary(1000)).triangles.size(), 1U);
    expect_refused("far.ply", binary(5412345), "too coarse for a mesh");
}

TEST_F(FarMeshes, RoundingTurnsTriangles) {
    const TriangleMesh mesh = load("a.obj", obj(far_away));
    EXPECT_GT(rounding_turn(mesh.exact_positions, mesh), 0.5);
    TriangleMesh placed = mesh;
    transform(placed, Transform(Eigen::Translation3d(-far_away)));
    std::vector<Vec3d> exact;
    for (const Vec3d& p : mesh.exact_positions) exact.emplace_back(p - far_away);
    EXPECT_LT(rounding_turn(exact, placed), 1e-5);
}

TEST(FarLathes, AreTheSameWhenMovedBack) {
    const auto lathe = [](double z) {
        LatheProfile profile;
        profile.points = {{{0, z}}, {{0.05, z + 0.01}}, {{0.06, z + 0.1}}, {{0, z + 0.11}}};
        return tessellate_lathe(profile, 24);
    };
    const TriangleMesh here = lathe(0);
    TriangleMesh there = lathe(5412345);
    transform(there, Transform(Eigen::Translation3d(0, 0, -5412345)));
    for (std::size_t i = 0; i < here.positions.size(); ++i)
        EXPECT_LT((there.positions[i] - here.positions[i]).norm(), 1e-8F);
}

}  // namespace
}  // namespace caustics::test
