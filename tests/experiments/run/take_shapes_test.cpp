#include <gtest/gtest.h>

#include <algorithm>

#include "experiments/run/render_and_score.h"

namespace caustics::experiments {
namespace {

TEST(TakeShapes, CopiesNoMeshAndLeavesTheRest) {
    SceneFile file = load_scene(CAUSTICS_SOURCE_DIR "/experiments/scenes/pool.json",
                                {{"/water/resolution", "8"}});
    const auto water = std::ranges::find(file.desc.shapes, "water", &Shape::name);
    ASSERT_NE(water, file.desc.shapes.end());
    const Vec3* const positions = water->mesh.positions.data();
    const auto index = static_cast<std::size_t>(water - file.desc.shapes.begin());
    const SceneDesc desc = take_shapes(file);
    EXPECT_EQ(desc.shapes[index].mesh.positions.data(), positions);
    EXPECT_EQ(desc.lights.size(), file.desc.lights.size());
    EXPECT_EQ(desc.camera.width, file.desc.camera.width);
    EXPECT_EQ(desc.sampling.sample_count, file.desc.sampling.sample_count);
    EXPECT_TRUE(file.desc.shapes.empty());
}

}  // namespace
}  // namespace caustics::experiments
