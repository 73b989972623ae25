#include "experiments/run/light_differences.h"

#include <gtest/gtest.h>

namespace caustics::experiments {
namespace {

using Lines = std::vector<std::string>;

Film film_with(const std::string& parameters, const std::string& scene = "{}") {
    Film film(1, 1);
    film.metadata = {{"parameters", parameters}, {"scene", scene}};
    return film;
}

TEST(LightDifferences, AreWhatChangesTheLight) {
    const Film a = film_with(R"({"max_bounces": 3, "photons": 10})",
                             R"({"floor": {"bsdf": {"alpha": 0.1}},
                                 "sensor": {"fov": 40, "sampler": {"sample_count": 1}}})");
    const Film b = film_with(R"({"max_bounces": 16, "paths": 10})",
                             R"({"floor": {"bsdf": {"alpha": 0.5}}, "lamp": {"watt": 1},
                                 "sensor": {"fov": 40, "sampler": {"sample_count": 4}}})");
    EXPECT_EQ(light_differences(a, b, "caustic"),
              (Lines{"max_bounces: 3 against 16", "/floor/bsdf/alpha: 0.1 against 0.5",
                     "/lamp/watt: absent against 1"}));
    EXPECT_EQ(light_differences(a, a, "caustic"), Lines());
}

TEST(LightDifferences, NameFilesThatChanged) {
    Film a = film_with("{}");
    Film b = a;
    a.metadata["scene_assets"] = R"({"a.ply": "1"})";
    b.metadata["scene_assets"] = R"({"a.ply": "2"})";
    EXPECT_EQ(light_differences(a, b, "caustic"), Lines{R"(a.ply: "1" against "2")"});
}

TEST(LightDifferences, AreNotGuessed) {
    const Film a = film_with(R"({"max_bounces": 3})", R"({"a": 1})");
    EXPECT_EQ(light_differences(a, Film(1, 1), "caustic"), Lines()) << "another program's picture";
    EXPECT_EQ(light_differences(Film(1, 1), a, "caustic"), Lines()) << "the other way round";
    EXPECT_EQ(light_differences(a, film_with("no JSON", "[1]"), "caustic"),
              Lines{"/a: 1 against absent"});
    EXPECT_EQ(light_differences(a, film_with("{}", R"({"a": 1})"), "caustic"), Lines())
        << "a method without that parameter";
}

TEST(LightDifferences, AreNotSoughtInTextThatIsNestedWithoutEnd) {
    const std::string deep = std::string(300'000, '[') + std::string(300'000, ']');
    EXPECT_EQ(light_differences(film_with("{}", "{\"ball\":" + deep + "}"),
                                film_with("{}", R"({"ball": 1})"), "caustic"),
              Lines{"/ball: absent against 1"});
}

TEST(LightDifferences, AreOneLineWhateverTheKeys) {
    EXPECT_EQ(light_differences(film_with("{}", R"({"a\nb": 1})"), film_with("{}"), "caustic"),
              Lines{"/a\\nb: 1 against absent"});
}

TEST(LightDifferences, CountShadowsWhereDirectLightIsJudged) {
    const Film a = film_with(R"({"shadows": "opaque"})");
    const Film b = film_with(R"({"shadows": "transparent"})");
    for (const char* layer : {"", "direct"})
        EXPECT_EQ(light_differences(a, b, layer),
                  Lines{R"(shadows: "opaque" against "transparent")"})
            << layer;
    for (const char* layer : {"caustic", "indirect"})
        EXPECT_EQ(light_differences(a, b, layer), Lines()) << layer;
}

TEST(LightDifferences, CountTheLightBetweenSurfacesWhereItIsJudged) {
    Film a = film_with(R"({"max_bounces": 3})");
    Film b = a;
    a.metadata["indirect_parameters"] = R"({"diffuse_bounces": 2, "max_bounces": 4, "spp": 1})";
    b.metadata["indirect_parameters"] = R"({"diffuse_bounces": 0, "max_bounces": 4, "gather": 8})";
    const Lines bounces{"indirect_diffuse_bounces: 2 against 0"};
    EXPECT_EQ(light_differences(a, b, "indirect"), bounces);
    EXPECT_EQ(light_differences(a, b, ""), bounces);
    EXPECT_EQ(light_differences(a, b, "caustic"), Lines());
    b.set_rgb("indirect", 0, Spectrum(1, 1, 1));
    EXPECT_EQ(light_differences(a, b, "").at(1), "light between surfaces: false against true");
    EXPECT_EQ(light_differences(a, b, "caustic"), Lines());
}

}  // namespace
}  // namespace caustics::experiments
