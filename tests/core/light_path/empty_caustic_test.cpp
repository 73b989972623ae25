#include "core/light_path/empty_caustic.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "tests/support/build_scene.h"

namespace caustics {
namespace {

TEST(EmptyCaustic, SaysWhyNoPathIsAimed) {
    const auto why = [](SceneDesc desc) {
        return why_nothing_is_aimed(Scene(std::move(desc))).value_or("aimed");
    };
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", 0, 1, true, support::diffuse(0.5F))};
    desc.lights = {support::point_light({0, 0, 3}, 1)};
    EXPECT_NE(why(desc).find("no shape is a caster"), std::string::npos);
    desc.shapes.push_back(support::sphere("ball", {0, 0, 1}, 0.5, support::glass(1.5F)));
    EXPECT_EQ(why(desc), "aimed");
    desc.lights = {support::point_light({0, 0, 3}, 0)};
    EXPECT_NE(why(desc).find("has no power"), std::string::npos);
    desc.lights.clear();
    EXPECT_EQ(why(desc), "the scene has no light");
}

// The end that most paths came to which met a caster.
TEST(EmptyCaustic, NamesTheMostFrequentEnd) {
    const std::pair<LightPathCounts, std::string> cases[] = {
        {{.emitted = 9}, "all were thinned out"},
        {{.emitted = 9, .aimed = 8, .missed = 8}, "no light path met a caster"},
        {{.emitted = 9, .aimed = 9, .missed = 3, .escaped = 2, .depth_limited = 4},
         "max_bounces cut the light paths"},
        {{.emitted = 9, .aimed = 9, .escaped = 3, .on_black_side = 6}, "receivers are black"},
        {{.emitted = 9, .aimed = 9, .missed = 5, .absorbed = 4},
         "the casters absorbed all light that met them"},
        {{.emitted = 9, .aimed = 9, .refracted = 2, .absorbed = 9},
         "absorbed on its way through the casters"},
        {{.emitted = 9, .aimed = 9, .reflected = 2, .absorbed = 9},
         "absorbed on its way through the casters"},
        {{.emitted = 9, .aimed = 9, .refracted = 4, .escaped = 4, .misdirected = 5},
         "smooth normals over hard edges"},
        {{.emitted = 9, .aimed = 9, .reflected = 9, .escaped = 9},
         "all light was reflected at the casters, none refracted"},
        {{.emitted = 9, .aimed = 9, .reflected = 2, .refracted = 7, .escaped = 9},
         "light that left the casters met no receiver"}};
    for (const auto& [counts, expected] : cases)
        EXPECT_NE(why_nothing_arrives(counts).find(expected), std::string::npos)
            << why_nothing_arrives(counts);
}

TEST(EmptyCaustic, CountsEveryEnd) {
    const LightPathCounts counts{.emitted = 100,
                                 .aimed = 90,
                                 .missed = 1,
                                 .escaped = 2,
                                 .absorbed = 3,
                                 .misdirected = 4,
                                 .on_black_side = 5,
                                 .depth_limited = 75};
    const std::string ends =
        "10 thinned out at the light, 1 met no caster first, 2 left the scene, 3 absorbed, 4 "
        "misdirected by smooth normals, 5 on black sides, 75 cut at max_bounces";
    EXPECT_EQ(ends_of(counts), ends);
    EXPECT_TRUE(why_nothing_arrives(counts).ends_with("(100 light paths: " + ends + ")"));
}

}  // namespace
}  // namespace caustics
