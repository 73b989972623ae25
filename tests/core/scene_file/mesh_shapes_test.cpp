#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "core/base/atomic_file.h"
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

    support::TemporaryFolder folder_;
};

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
