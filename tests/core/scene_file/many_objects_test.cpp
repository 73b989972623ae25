#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>
#include <variant>
#include <vector>

#include "core/scene/scene.h"
#include "core/scene/scene_reader.h"
#include "tests/support/temporary_folder.h"

namespace caustics {
namespace {

constexpr int many = 16'000;

/// A scene with many objects beside a sensor and a floor; "$x" stands for a place of each one's own.
Scene scene_of_many(const std::string& object) {
    std::string text = R"({"sensor": {"type": "perspective"}, "floor": {"type": "rectangle"})";
    for (int i = 0; i < many; ++i) {
        std::string one = object;
        one.replace(one.find("$x"), 2, std::to_string(i));
        text += ", \"object" + std::to_string(i) + "\": " + one;
    }
    const support::TemporaryFolder folder;
    std::ofstream(folder / "scene.json") << text + "}";
    return Scene(load_scene(folder / "scene.json").desc);
}

/// Each of the places 0, 1, 2, ... is taken once.
void expect_each_place_once(const std::vector<double>& places) {
    std::vector<int> taken(many);
    for (const double x : places) {
        const long place = std::lround(x);
        ASSERT_NEAR(x, static_cast<double>(place), 0.01);
        ASSERT_TRUE(place >= 0 && place < many) << x;
        ++taken[static_cast<std::size_t>(place)];
    }
    EXPECT_EQ(taken, std::vector<int>(many, 1));
}

void expect_casters_at_each_place(const std::string& object) {
    const Scene scene = scene_of_many(object);
    EXPECT_EQ(scene.shapes().size(), many + 1U);
    std::vector<double> places;
    for (const std::uint32_t caster : scene.casters())
        places.push_back(static_cast<double>(bounds(scene.shapes()[caster]).center().x()) +
                         scene.origin().x());
    expect_each_place_once(places);
}

TEST(ManyObjects, OfLightsAreReadEach) {
    const Scene scene =
        scene_of_many(R"({"type": "point", "position": [$x, 0, 2], "intensity": 1})");
    std::vector<double> places;
    for (const Light& light : scene.lights())
        places.push_back(static_cast<double>(std::get<PointLight>(light).position.x()) +
                         scene.origin().x());
    expect_each_place_once(places);
}

TEST(ManyObjects, OfExactCastersAreReadEach) {
    expect_casters_at_each_place(
        R"({"type": "sphere", "center": [$x, 0, 2], "radius": 0.4, "b": {"type": "conductor"}})");
}

TEST(ManyObjects, OfMeshesAreReadEach) {
    expect_casters_at_each_place(
        R"({"type": "cube", "to_world": [{"scale": 0.1}, {"translate": [$x, 0, 2]}],)"
        R"( "b": {"type": "dielectric"}})");
}

}  // namespace
}  // namespace caustics
