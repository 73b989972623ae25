#include "experiments/run/render_and_score.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "experiments/run/notes.h"
#include "tests/support/build_scene.h"

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

RunRequest small_request() {
    RunRequest request{"a scene.json",
                       {{"/camera/width", "8"}, {"/name", "two words"}},
                       parse_method("none", parameters_node({}))};
    request.seed = 7;
    request.samples_per_pixel = 3;
    return request;
}

TEST(Command, MakesThePictureAgain) {
    RunRequest request = small_request();
    EXPECT_EQ(command("render", request),
              "causticbench render 'a scene.json' --method none --set /camera/width=8 "
              "--set '/name=two words' --spp 3 --seed 7");
    EXPECT_EQ(command("probe", request),
              "causticbench probe 'a scene.json' --method none --set /camera/width=8 "
              "--set '/name=two words' --seed 7");
    request.method = parse_method("lighttrace", parameters_node({"paths=9"}));
    EXPECT_NE(command("render", request).find(" --param paths=9 "), std::string::npos);
    request.method = {};
    request.indirect = parse_indirect("pathtrace", parameters_node({}));
    const std::string indirect = command("probe", request);
    EXPECT_NE(indirect.find(" --layer indirect --indirect pathtrace"), std::string::npos)
        << indirect;
}

SceneDesc ball_lit_from(double height) {
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", 0, 3, true, support::diffuse(0.5F)),
                   support::sphere("ball", {0, 0, 1}, 0.5, support::glass(1.5F))};
    desc.lights = {support::point_light({0, 0, height}, 5)};
    desc.camera.width = desc.camera.height = 4;
    return desc;
}

// Trials of time are of the pixels that the whole picture has.
TEST(Run, RendersSomeOfThePixelsAsInTheWholePicture) {
    SceneDesc desc = ball_lit_from(3);
    desc.camera.width = desc.camera.height = 64;
    const Scene scene(std::move(desc));
    RunRequest request = small_request();
    request.method = parse_method("photonmap", parameters_node({"photons=1000"}));
    Stopwatch stopwatch;
    const RunResult whole = run(scene, request, RunOptions{}, stopwatch);
    request.pixel_step = 4;
    const RunResult some = run(scene, request, RunOptions{}, stopwatch);
    const auto rays = [](const RunResult& result) {
        return static_cast<double>(result.counters.at("camera_rays"));
    };
    EXPECT_NEAR(rays(some) / rays(whole), 0.25, 0.03) << "four standard errors";
    for (const Plane& plane : some.film.planes()) {
        const std::vector<float>* const of_whole = whole.film.find(plane.channel);
        ASSERT_NE(of_whole, nullptr) << plane.channel;
        for (std::size_t i = 0; i < plane.values.size(); ++i)
            EXPECT_TRUE(plane.values[i] == 0 || plane.values[i] == (*of_whole)[i])
                << plane.channel << " " << i;
    }
}

// What a terminal shows: stages, and within them the phases of the method.
TEST(Run, TellsItsStagesAndPhases) {
    const Scene scene(ball_lit_from(3));
    RunRequest request = small_request();
    request.method = parse_method("photonmap", parameters_node({"photons=1000"}));
    std::vector<std::string> stages;
    RunOptions options;
    options.begin_phase = [&](std::string_view name) { stages.emplace_back(name); };
    Stopwatch stopwatch;
    const RunResult result = run(scene, request, options, stopwatch);
    EXPECT_EQ(stages,
              (std::vector<std::string>{"precompute", "trace", "balance", "widths", "render"}));
    EXPECT_GT(stopwatch.of("precompute").wall, 0);
    EXPECT_GT(stopwatch.of("precompute/balance").wall, 0);
    EXPECT_GT(stopwatch.of("render").wall, 0);
    EXPECT_GT(result.report.bytes, 1000U);
    EXPECT_TRUE(result.notes.empty());
}

TEST(Run, TellsWhatIsToBeNotedOnItsScene) {
    const Scene scene(ball_lit_from(1.5));  // on the ball
    Stopwatch stopwatch;
    const RunResult result = run(scene, small_request(), {}, stopwatch);
    EXPECT_FALSE(result.notes.empty());
    EXPECT_EQ(result.notes, notes_on(scene));
}

}  // namespace
}  // namespace caustics::experiments
