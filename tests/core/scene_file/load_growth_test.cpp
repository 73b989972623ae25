#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <limits>
#include <string>

#include "core/scene/scene.h"
#include "core/scene/scene_reader.h"
#include "tests/support/temporary_folder.h"

namespace caustics {
namespace {

/// A scene with so many objects beside a sensor and a floor; "$x" stands for a place of each one's own.
std::string scene_of(int count, const std::string& object) {
    std::string text = R"({"sensor": {"type": "perspective"}, "floor": {"type": "rectangle"})";
    for (int i = 0; i < count; ++i) {
        std::string one = object;
        one.replace(one.find("$x"), 2, std::to_string(i));
        text += ", \"object" + std::to_string(i) + "\": " + one;
    }
    return text + "}";
}

/// Processor time of loading it, the least of three [clock ticks].
double work_of(int count, const std::string& object) {
    const support::TemporaryFolder folder;
    std::ofstream(folder / "scene.json") << scene_of(count, object);
    std::clock_t least = std::numeric_limits<std::clock_t>::max();
    for (int i = 0; i < 3; ++i) {
        const std::clock_t start = std::clock();
        const Scene scene(load_scene(folder / "scene.json").desc);
        least = std::min(least, std::clock() - start);
    }
    return static_cast<double>(least);
}

/// Four times the objects take four times the work, not sixteen times.
void expect_linear(const std::string& object) {
    EXPECT_LT(work_of(16'000, object), 8 * work_of(4'000, object)) << object;
}

TEST(LoadingAScene, TakesWorkInProportionToItsLights) {
    expect_linear(R"({"type": "point", "position": [$x, 0, 2], "intensity": 1})");
}

TEST(LoadingAScene, TakesWorkInProportionToItsCasters) {
    expect_linear(
        R"({"type": "sphere", "center": [$x, 0, 2], "radius": 0.4, "b": {"type": "conductor"}})");
}

TEST(LoadingAScene, TakesWorkInProportionToItsMeshes) {
    expect_linear(R"({"type": "cube", "to_world": [{"scale": 0.1}, {"translate": [$x, 0, 2]}],)"
                  R"( "b": {"type": "dielectric"}})");
}

}  // namespace
}  // namespace caustics
