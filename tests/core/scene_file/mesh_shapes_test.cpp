#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/mesh/mesh_doctor.h"
#include "core/render/film.h"
#include "core/scene/scene_reader.h"
#include "tests/support/png_kinds.h"
#include "tests/support/temporary_folder.h"

namespace caustics {
namespace {

class MeshShapes : public testing::Test {
protected:
    Shape read(const std::string& keys) const {
        std::ofstream(folder_ / "scene.json")
            << R"({"sensor": {"type": "perspective"}, "it": {)" << keys << "}}";
        return load_scene(folder_ / "scene.json").desc.shapes.at(0);
    }

    /// A cube of 0.2 m as an OBJ file, its middle anywhere; every other face turned.
    static std::string cube(const Vec3d& middle, int first = 1, bool turned = false) {
        std::string text;
        for (int i = 0; i < 8; ++i)
            text += fmt::format("v {:.4f} {:.4f} {:.4f}\n", middle.x() + (i % 2 == 0 ? -0.1 : 0.1),
                                middle.y() + (i / 2 % 2 == 0 ? -0.1 : 0.1),
                                middle.z() + (i / 4 == 0 ? -0.1 : 0.1));
        const int faces[6][4] = {{1, 3, 4, 2}, {5, 6, 8, 7}, {1, 2, 6, 5},
                                 {3, 7, 8, 4}, {1, 5, 7, 3}, {2, 4, 8, 6}};
        for (int i = 0; i < 6; ++i) {
            const auto [a, b, c, d] = faces[i];
            const int base = first - 1;
            const bool back = turned && i % 2 == 0;
            text += fmt::format("f {} {} {} {}\n", base + (back ? d : a), base + (back ? c : b),
                                base + (back ? b : c), base + (back ? a : d));
        }
        return text;
    }
    void write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name) << text;
    }
    std::string refusal(const std::string& keys) const {
        try {
            read(keys);
        } catch (const InputError& error) {
            return error.what();
        }
        return "accepted";
    }

    support::TemporaryFolder folder_;
};

// Coordinates of maps: floats have half a metre there.
TEST_F(MeshShapes, FilesFarFromTheOriginArePlacedExactly) {
    write("far.obj", cube({512345, 5412345, 300}));
    const std::string glass = R"("type": "obj", "filename": "far.obj", "face_normals": true,
        "bsdf": {"type": "dielectric"})";
    for (const char* const place :
         {"", R"(, "to_world": [{"translate": [-512345, -5412345, -300]}])",
          R"(, "to_world": [{"translate": [-512345, -5412345, -300]}, {"scale": 10},
             {"translate": [1e6, 0, 0]}])"}) {
        const Shape shape = read(glass + place);
        const Box box = bounds(shape);
        const float size =
            *place != 0 && std::string(place).find("scale") != std::string::npos ? 2.0F : 0.2F;
        EXPECT_LT((box.sizes() - Vec3::Constant(size)).norm(), 1e-6F * size) << place;
        EXPECT_LT(box.center().norm(), 1e-5F) << place;
    }
}

TEST_F(MeshShapes, PartsTooFarApartForFloatsAreRefused) {
    write("two.obj", cube(Vec3d::Zero()) + cube({512345, 5412345, 300}, 9));
    EXPECT_NE(refusal(R"("type": "obj", "filename": "two.obj", "bsdf": {"type": "dielectric"})")
                  .find("floats are too coarse for its triangles"),
              std::string::npos);
    EXPECT_NE(refusal(R"("type": "cut", "planes": [[1, 0, 0, 1], [-1, 0, 0, 1], [0, 1, 0, 1],
                         [0, -1, 0, 1], [0, 0, 1, 10001], [0, 0, -1, -9999]])")
                  .find("from its own origin, where floats are too coarse"),
              std::string::npos);
}

TEST_F(MeshShapes, OrientTurnsFacesOfFiles) {
    write("mixed.obj", cube(Vec3d::Zero(), 1, true));
    const std::string mesh = R"("type": "obj", "filename": "mixed.obj")";
    EXPECT_EQ(diagnose(read(mesh).mesh).turned_triangles, 6U);
    const Shape turned = read(mesh + R"(, "orient": true)");
    EXPECT_EQ(diagnose(turned.mesh).turned_triangles, 0U);
    EXPECT_EQ(diagnose(turned.mesh).inside_out_parts, 0U);
    EXPECT_TRUE(turned.is_oriented);
    for (std::size_t i = 0; i < turned.mesh.normals.size(); ++i)
        EXPECT_GT(turned.mesh.normals[i].dot(turned.mesh.positions[i]), 0.1F);
    EXPECT_EQ(
        diagnose(read(mesh + R"(, "orient": true, "flip_normals": true)").mesh).inside_out_parts,
        1U);
    EXPECT_NE(refusal(R"("type": "cube", "orient": true)").find("orient"), std::string::npos);
}

TEST_F(MeshShapes, TwoResolutionsAreThoseAlongXAndY) {
    const Shape floor = read(R"("type": "rectangle", "resolution": [3, 2])");
    ASSERT_EQ(floor.mesh.patches.size(), 1U);
    EXPECT_EQ(floor.mesh.patches[0].columns, 3U);
    EXPECT_EQ(floor.mesh.patches[0].rows, 2U);
    const Shape water = read(R"("type": "heightfield", "waves": [], "resolution": [1, 5])");
    EXPECT_EQ(water.mesh.triangles.size(), 10U);
}

TEST_F(MeshShapes, HeightsOfAPictureStandOnItsPixels) {
    // Three by two pixels of one channel, the upper row first.
    const std::vector<std::uint16_t> heights{65535, 0, 0, 0, 32768, 13107};
    write_atomic_file(folder_ / "heights.png",
                      support::png_of_kind({support::PngKind::Colours::grey, 16}, 3, 2, heights));
    Film film(3, 2);
    std::ranges::transform(heights, film.plane("Y").begin(),
                           [](std::uint16_t z) { return static_cast<float>(z) / 65535; });
    write_exr(film, folder_ / "heights.exr");
    const std::vector<Vec3> expected = {{-3, -1, 0},   {0, -1, 2 * 32768 / 65535.0F},
                                        {3, -1, 0.4F}, {-3, 1, 2},
                                        {0, 1, 0},     {3, 1, 0}};
    for (const std::string format : {"png", "exr"}) {
        const Shape relief = read(
            R"("type": "heightfield", "height": 2, "half_size": [3, 1], "filename": "heights.)" +
            format + '"');
        ASSERT_EQ(relief.mesh.positions.size(), expected.size());
        // Of 16 bits one in 65536 is read.
        for (std::size_t i = 0; i < expected.size(); ++i)
            EXPECT_LT((relief.mesh.positions[i] - expected[i]).norm(), 1e-4F) << format << i;
        EXPECT_EQ(relief.mesh.triangles.size(), 4U);
    }
}

TEST_F(MeshShapes, TakeTheKeysOfOtherMeshes) {
    const std::string cone = R"("type": "lathe", "profile": [[0, 0], [1, 0], [0, 1]])";
    EXPECT_EQ(read(cone).mesh.patches.at(0).columns, 64U);
    const Shape turned =
        read(cone + R"(, "resolution": 4, "flip_normals": true, "to_world": [{"scale": 3}])");
    EXPECT_EQ(turned.mesh.positions.at(0), Vec3(3, 0, 0));
    EXPECT_LT(turned.mesh.normals.at(0).x(), 0);
    EXPECT_TRUE(read(cone + R"(, "face_normals": true)").mesh.normals.empty());
    const Shape ground = read(
        R"("type": "heightfield", "fractal": {"levels": 4, "rms": 0.1}, "face_normals": true)");
    EXPECT_EQ(ground.mesh.triangles.size(), 512U);
    EXPECT_TRUE(ground.mesh.normals.empty());
}

TEST_F(MeshShapes, RingsOfACutLookWhereTheirAnglesSay) {
    const Shape drum = read(R"("type": "cut", "rings": [{"count": 4, "angle": 0, "distance": 1,
        "phase": 0.5}, {"count": 1, "angle": -90, "distance": 0}], "height": 2)");
    Box box;
    for (const Vec3& p : drum.mesh.positions) box.extend(p);
    EXPECT_LT((box.max() - Vec3(std::sqrt(2.0F), std::sqrt(2.0F), 2)).norm(), 1e-5F);
    EXPECT_NEAR(box.min().z(), 0, 1e-6F);
}

}  // namespace
}  // namespace caustics
