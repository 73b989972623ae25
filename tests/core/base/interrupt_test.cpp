#include "core/base/interrupt.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <functional>
#include <thread>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/exact_shapes/sphere.h"
#include "core/light_path/aimed_emission.h"
#include "core/reference/light_trace.h"
#include "core/reference/path_trace.h"
#include "core/render/renderer.h"
#include "tests/support/build_scene.h"

namespace caustics {
namespace {

constexpr int was_interrupted = 130;
constexpr unsigned too_long = 120;  // seconds, of work that never ends by itself

// Nobody takes a request back, so that each piece of work runs in a process of its own, which ends here.
[[noreturn]] void interrupt(const std::function<void()>& work, bool at_work) {
    alarm(too_long);
    const std::jthread asks([at_work] {
        if (at_work) std::this_thread::sleep_for(std::chrono::milliseconds(100));
        request_interrupt();
    });
    while (!at_work && !interrupt_requested()) std::this_thread::yield();
    try {
        work();
    } catch (const Interrupted&) {
        std::_Exit(was_interrupted);
    }
    std::_Exit(EXIT_SUCCESS);
}

SceneDesc one_pixel() {
    SceneDesc desc;
    desc.camera = support::camera({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 1, 1, 1);
    desc.shapes = {support::horizontal("floor", 0, 2, true, support::diffuse(0.5F)),
                   support::sphere("ball", {0.5, 0, 1}, 0.2, support::glass(1.5F)),
                   support::horizontal("lamp", 4, 1, false, support::diffuse(0))};
    desc.shapes.back().radiance = Spectrum::Ones();
    return desc;
}

class Interrupt : public testing::Test {
protected:
    void SetUp() override { testing::FLAGS_gtest_death_test_style = "threadsafe"; }
};

TEST_F(Interrupt, IsAskedForByNobodyAtFirst) {
    EXPECT_FALSE(interrupt_requested());
    EXPECT_NO_THROW(throw_if_interrupted());
}

TEST_F(Interrupt, EndsLoopsOverThreads) {
    const auto endless = [] {
        parallel_for(2, std::size_t{1} << 62U, [](std::size_t, std::size_t) {});
    };
    EXPECT_EXIT(interrupt(endless, true), testing::ExitedWithCode(was_interrupted), "");
}

TEST_F(Interrupt, EndsTheBuildOfAScene) {
    EXPECT_EXIT(interrupt([] { const Scene scene(one_pixel()); }, false),
                testing::ExitedWithCode(was_interrupted), "");
}

// Each piece of a large lamp looks at each corner of a caster.
TEST_F(Interrupt, EndsTheAimingAtAMesh) {
    SceneDesc desc = one_pixel();
    desc.shapes[1].primitive = Primitive::mesh;
    desc.shapes[1].mesh = tessellate_sphere(4);
    const Scene scene(desc);
    EXPECT_EXIT(interrupt([&] { const AimedEmission emission(scene); }, false),
                testing::ExitedWithCode(was_interrupted), "");
}

// A pixel is the work of one thread, which nothing else would stop.
TEST_F(Interrupt, EndsAPixelOfPathTracing) {
    const Scene scene(one_pixel());
    const auto endless = [&] {
        render(scene, *build(scene, PathTraceParams{.spp = 1'000'000'000}, {}), {});
    };
    EXPECT_EXIT(interrupt(endless, true), testing::ExitedWithCode(was_interrupted), "");
}

TEST_F(Interrupt, EndsLightTracing) {
    const Scene scene(one_pixel());
    const auto endless = [&] {
        render(scene, *build(scene, LightTraceParams{.paths = 1'000'000'000'000}, {}), {});
    };
    EXPECT_EXIT(interrupt(endless, true), testing::ExitedWithCode(was_interrupted), "");
}

}  // namespace
}  // namespace caustics
