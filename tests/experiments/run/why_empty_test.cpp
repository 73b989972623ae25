#include "experiments/run/why_empty.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/geometry/tessellate.h"
#include "experiments/run/caustic_survey.h"
#include "experiments/run/render_and_score.h"
#include "tests/support/build_scene.h"

namespace caustics::experiments {
namespace {

using Words = std::vector<std::string>;

/// What a run of the method says of its caustic; "" = it is not empty.
std::string reason(const SceneDesc& desc, const std::string& method, const Words& params) {
    const Scene scene{SceneDesc(desc)};
    RunRequest request;
    request.method = parse_method(method, parameters_node(params));
    Stopwatch stopwatch;
    return run(scene, request, RunOptions{}, stopwatch).why_empty.value_or("");
}

struct Way {
    const char* method;
    Words params;
};
const std::vector<Way> every_way = {
    {"photonmap", {"emitted=3000"}},     {"photonmap", {"emitted=1000", "passes=2"}},
    {"lighttrace", {"paths=3000"}},      {"illuminationmap", {"emitted=3000", "resolution=8"}},
    {"beamtree", {"mesh_resolution=4"}}, {"causticpolygons", {"mesh_resolution=4"}}};

void expect_from_all(const SceneDesc& desc, const std::string& words, const Words& more = {}) {
    for (const Way& way : every_way) {
        Words params = way.params;
        params.insert(params.end(), more.begin(), more.end());
        const std::string said = reason(desc, way.method, params);
        if (words.empty())
            EXPECT_EQ(said, "") << way.method;
        else
            EXPECT_NE(said.find(words), std::string::npos) << way.method << " says: " << said;
        EXPECT_EQ(said.find('\n'), std::string::npos);
    }
}

enum Shapes : std::size_t { water, floor_shape };

/// A lamp above a sheet of water, a floor below it, and a camera between the two.
SceneDesc pool(const Bsdf& water_bsdf = support::glass(1.33F)) {
    SceneDesc desc;
    desc.shapes = {support::horizontal("water", 1, 1, true, water_bsdf),
                   support::horizontal("floor", 0, 3, true, support::diffuse(0.5F))};
    desc.lights = {support::point_light({0.1, 0.2, 2}, 1)};
    desc.camera = support::camera({0.5, 0.1, 0.9}, {0, 0, 0}, {0, 0, 1}, 50, 6, 4);
    return desc;
}

/// The same by day, for light from one direction.
SceneDesc pool_by_day(const Vec3d& direction, const Bsdf& water_bsdf) {
    SceneDesc desc = pool(water_bsdf);
    desc.lights.clear();
    desc.lights = {support::directional_light(direction, 1)};
    return desc;
}

TEST(WhyEmpty, SaysNothingOfACausticThatIsThere) {
    expect_from_all(pool(), "");
    SceneDesc dark = pool();
    dark.lights.clear();
    EXPECT_EQ(reason(dark, "none", {}), "") << "none is meant to be without";
}

TEST(WhyEmpty, KnowsThatNothingIsAimed) {
    SceneDesc desc = pool(support::diffuse(0.5F));
    expect_from_all(desc, "no shape is a caster");
    desc = pool();
    desc.lights.clear();
    expect_from_all(desc, "the scene has no light");
    // A lamp that shines upwards.
    desc.shapes.push_back(support::horizontal("lamp", 2, 0.2, true, support::diffuse(0)));
    desc.shapes.back().radiance = Spectrum(Spectrum::Ones());
    expect_from_all(desc, "no light shines towards a caster");
    EXPECT_NE(reason(desc, "pathtrace", {}).find("no light shines"), std::string::npos);
}

TEST(WhyEmpty, KnowsWhatEndedTheLightPaths) {
    SceneDesc covered = pool();
    covered.shapes.push_back(
        support::horizontal("lid", 1.5, 2, true, support::diffuse(0.5F, true)));
    expect_from_all(covered, "no light path met a caster");

    SceneDesc two_sheets = pool_by_day({0, 0, -1}, support::glass(1.33F));
    two_sheets.shapes.push_back(support::horizontal("ice", 1.2, 1, true, support::glass(1.2F)));
    expect_from_all(two_sheets, "max_bounces", {"max_bounces=1"});

    // From glass into air beyond the critical angle of 42 degrees.
    expect_from_all(pool_by_day({1, 0, -0.7}, support::glass(1, 1.5F)), "none refracted");

    expect_from_all(pool(support::glass(1.33F, 1, Spectrum::Constant(1000))),
                    "absorbed on its way");
    expect_from_all(pool(support::mirror(0)), "the casters absorbed all light");

    SceneDesc turned = pool();
    turned.shapes[floor_shape] = support::horizontal("floor", 0, 3, false, support::diffuse(0.5F));
    expect_from_all(turned, "where receivers are black");

    SceneDesc aside = pool();
    aside.shapes[floor_shape] =
        support::rectangle("floor", {9, 0, 0}, {1, 0, 0}, {0, 1, 0}, support::diffuse(0.5F));
    expect_from_all(aside, "met no receiver; casters far larger than what they light");
}

TEST(WhyEmpty, KnowsThatTheCameraSeesNothingOfTheLight) {
    SceneDesc up = pool();
    up.camera = support::camera({2, 0, 0.9}, {2, 0, 2}, {0, 1, 0}, 30, 6, 4);
    expect_from_all(up, "the camera sees no receiver");

    SceneDesc corner = pool();
    corner.camera = support::camera({2.9, 2.9, 0.5}, {2.9, 2.9, 0}, {0, 1, 0}, 20, 6, 4);
    expect_from_all(corner, "outside of the picture");

    SceneDesc screened = pool();
    screened.shapes.push_back(support::rectangle("screen", {2, 0, 0.5}, {0, 0, 0.5}, {0, 3, 0},
                                                 support::diffuse(0.5F, true)));
    screened.camera = support::camera({2.1, 0, 0.5}, {0, 0, 0.5}, {0, 0, 1}, 120, 6, 4);
    expect_from_all(screened, "hidden from the camera");

    SceneDesc thin = pool();
    thin.shapes[floor_shape].bsdf.twosided = true;
    thin.camera = support::camera({0, 0, -1}, {0, 0, 0}, {0, 1, 0}, 120, 6, 4);
    expect_from_all(thin, "the side that the camera does not see");

    SceneDesc black = pool();
    black.shapes[floor_shape].bsdf = support::diffuse(0);
    expect_from_all(black, "reflect none of it");

    // All of the floor lies below the water, for an eye close above it.
    SceneDesc through_water = pool();
    through_water.camera = support::camera({0, 0, 1.9}, {0, 0, 0}, {0, 1, 0}, 120, 6, 4);
    EXPECT_EQ(reason(through_water, "photonmap", {"emitted=3000", "radius=1e-7", "kernel=point"})
                  .find("the camera sees what light reaches through casters at most ("),
              0U);
}

// A floor whose smooth normals lean away from the camera shows it nothing, although its triangles face it.
TEST(WhyEmpty, KnowsThatSmoothNormalsTurnAReceiverAway) {
    const auto surveyed = [](const Vec3& normal) {
        TriangleMesh square = tessellate_rectangle(1);
        for (Vec3& each : square.normals) each = normal.normalized();
        SceneDesc desc = pool();
        desc.shapes[floor_shape] = support::mesh(
            "floor", std::move(square), Transform(Eigen::Scaling(3.0)), support::diffuse(0.5F));
        desc.camera = support::camera({2.9, 0, 0.3}, {0, 0, 0}, {0, 0, 1}, 90, 6, 4);
        return survey_caustic(Scene(std::move(desc)), 4);
    };
    EXPECT_EQ(surveyed({0, 0, 1}).turned_away, 0U);
    const CausticSurvey leaning = surveyed({-1, 0, 1});
    EXPECT_EQ(leaning.seen, 0U);
    EXPECT_EQ(why_unseen(leaning).find("light reaches receivers on the side that the camera does "
                                       "not see"),
              0U)
        << why_unseen(leaning);
}

TEST(WhyEmpty, KnowsWhatAMethodCannotDo) {
    // From above the water light tracing cannot connect to the camera; the others look through it.
    SceneDesc above = pool();
    above.camera = support::camera({0.5, 0, 1.6}, {0, 0, 1}, {0, 0, 1}, 20, 6, 4);
    EXPECT_NE(reason(above, "lighttrace", {"paths=3000"}).find("cannot connect"),
              std::string::npos);
    EXPECT_EQ(reason(above, "photonmap", {"emitted=3000"}), "");

    // Most of the light passes the second mirror, which turns the rest to the floor. Beams follow it there.
    SceneDesc periscope;
    periscope.shapes = {
        support::rectangle("first", {0, 0, 2}, {0, 0.5, 0}, {-0.5, 0, 0.5}, support::mirror()),
        support::rectangle("second", {3, 0, 2}, {0, 0.1, 0}, {0.5, 0, -0.5}, support::mirror()),
        support::horizontal("floor", 0, 5, true, support::diffuse(0.5F))};
    periscope.lights = {support::directional_light({0, 0, -1}, 1)};
    periscope.camera = support::camera({3, 1, 1}, {3, 0, 0}, {0, 0, 1}, 40, 6, 4);
    EXPECT_EQ(reason(periscope, "beamtree", {"mesh_resolution=4"}), "");
    EXPECT_EQ(reason(periscope, "photonmap", {"emitted=3000"}), "");
}

TEST(WhyEmpty, KnowsThatTheWorkWasTooLittle) {
    for (const char* too_small : {"max_radius=1e-7", "radius=1e-7"})
        EXPECT_NE(reason(pool(), "photonmap", {"emitted=3000", "kernel=point", too_small})
                      .find("no photon lies within 1e-07 m"),
                  std::string::npos)
            << too_small;
    SceneDesc small = pool();
    small.shapes[floor_shape] = support::horizontal("floor", 0, 0.05, true, support::diffuse(0.5F));
    small.camera = support::camera({0, 0, 0.9}, {0, 0, 0}, {0, 1, 0}, 6, 6, 4);
    EXPECT_EQ(reason(small, "illuminationmap", {"emitted=1"}).find("1 light paths are too few"),
              0U);
}

/// What is said of a black picture by a method that counted and chose these.
std::string told(const SceneDesc& desc, const std::string& method, const Words& params,
                 const Counters& counters, const BuildReport& report = {}) {
    Film film(4, 4);
    film.set_rgb("caustic", 0, black());
    return why_empty(Scene{SceneDesc(desc)}, parse_method(method, parameters_node(params)), film,
                     report, counters)
        .value_or("");
}

TEST(WhyEmpty, IsToldByWhatTheMethodCounted) {
    const std::string more = "found none of the light that is there: give it more samples (";
    EXPECT_EQ(told(pool(), "pathtrace", {}, {}).find("pathtrace " + more), 0U);
    EXPECT_EQ(told(pool(), "photonmap", {"emitted=10"}, {}).find("photonmap " + more), 0U);
    EXPECT_EQ(told(pool(), "beamtree", {}, {{"beams", 3}})
                  .find("beamtree has no beam for it: the casters' polygons are too coarse"),
              0U);
    const Words within = {"emitted=10", "radius=0.1"};
    EXPECT_EQ(
        told(pool(), "photonmap", within, {{"gathers", 5}, {"empty_gathers", 5}}).find("no photon"),
        0U);
    EXPECT_EQ(told(pool(), "photonmap", within, {{"gathers", 5}, {"empty_gathers", 4}})
                  .find("photonmap " + more),
              0U);

    // From far above, some of the lit floor is seen through the water and some beside it.
    SceneDesc beside = pool();
    beside.camera = support::camera({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 60, 6, 4);
    EXPECT_EQ(told(beside, "lighttrace", {}, {{"photons_connected", 0}}).find("lighttrace " + more),
              0U);
}

TEST(WhyEmpty, IsToldByTheLimitOfThePhotonsThatWereLoaded) {
    SceneDesc two_sheets = pool_by_day({0, 0, -1}, support::glass(1.33F));
    two_sheets.shapes.push_back(support::horizontal("ice", 1.2, 1, true, support::glass(1.2F)));
    BuildReport loaded;
    EXPECT_EQ(told(two_sheets, "photonmap", {"emitted=10"}, {}, loaded).find("max_bounces"),
              std::string::npos);
    loaded.resolved["max_bounces"] = 1;
    EXPECT_NE(told(two_sheets, "photonmap", {"emitted=10"}, {}, loaded).find("max_bounces"),
              std::string::npos);
}

TEST(WhyEmpty, IsToldWhenAskedForPhotonsThatCannotBeHad) {
    SceneDesc desc = pool();
    desc.lights.clear();
    try {
        reason(desc, "photonmap", {"photons=100"});
        FAIL() << "expected UnsupportedScene";
    } catch (const UnsupportedScene& error) {
        EXPECT_NE(std::string(error.what()).find("no photon can be stored: the scene has no light"),
                  std::string::npos)
            << error.what();
    }
}

}  // namespace
}  // namespace caustics::experiments
