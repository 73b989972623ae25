#include "photonmap/global_photon_map.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/geometry/tessellate.h"
#include "core/scene_file/json_reader.h"
#include "tests/support/build_scene.h"

namespace caustics::photonmap {
namespace {

// A closed grey box with a ball of glass in it, lit from within.
Scene box() {
    SceneDesc desc;
    desc.shapes = support::emitting_room(1, 0, support::diffuse(0.5F));
    for (Shape& wall : desc.shapes) wall.radiance.reset();
    desc.shapes.push_back(support::sphere("ball", {0.3, 0, 0}, 0.4, support::glass(1.5F)));
    desc.lights = {support::point_light({-0.6, 0.2, 0.5}, 1)};
    return Scene(std::move(desc));
}

struct Answer {
    double irradiance = 0;
    Counters counters;
    BuildReport report;
};

Answer ask(const GlobalMapParams& params) {
    const Scene scene = box();
    const auto map = build(scene, params, {});
    const ReceiverPoint point = support::probe(scene, 0, scene.shapes()[0].to_world.translation(),
                                               -scene.shapes()[0].to_world.translation(), 0);
    const auto context = map->make_context();
    std::vector<Estimate> out(1);
    map->irradiance({&point, 1}, out, *context);
    Answer answer{static_cast<double>(out[0].value.mean()), {}, map->build_report()};
    context->add_to(answer.counters);
    return answer;
}

// Every parameter moves something, and the way that theory says.
TEST(GlobalPhotonMap, FollowsItsParameters) {
    const GlobalMapParams usual{.photons = 20'000};
    const auto with = [&](const auto& change) {
        GlobalMapParams params = usual;
        change(params);
        return ask(params);
    };
    const Answer all = ask(usual);
    EXPECT_GT(all.irradiance, 0);
    EXPECT_EQ(all.report.counters.at("photons_stored"), 20'000U);
    // Half of the light is reflected at every wall: of the photons stored, half come from one.
    EXPECT_NEAR(static_cast<double>(all.report.counters.at("photons_from_diffuse")), 10'000, 700);
    EXPECT_EQ(all.report.counters.at("irradiance_places"), 5'000U);
    EXPECT_EQ(all.counters.at("gather_rays"), 32U);
    EXPECT_GE(all.counters.at("irradiance_lookups"), 31U);
    EXPECT_EQ(with([](auto& p) { p.precompute = 10; }).report.counters.at("irradiance_places"),
              2'000U);
    const Answer estimated = with([](auto& p) { p.precompute = 0; });
    EXPECT_FALSE(estimated.counters.contains("irradiance_lookups"));
    EXPECT_GE(estimated.counters.at("gathered_photons"), 31U * 50U);
    EXPECT_EQ(with([](auto& p) { p.gather = 7; }).counters.at("gather_rays"), 7U);
    const Answer shown = with([](auto& p) { p.gather = 0; });
    EXPECT_EQ(shown.counters.at("gather_rays"), 0U);
    EXPECT_EQ(shown.counters.at("gathered_photons"), 50U);
    EXPECT_EQ(with([](auto& p) {
                  p.gather = 0;
                  p.nearest = 80;
              }).counters.at("gathered_photons"),
              80U);
    EXPECT_LT(with([](auto& p) {
                  p.gather = 0;
                  p.max_radius = 0.02;
              }).counters.at("gathered_photons"),
              20U);
    // Light that ends at the second receiver, and at the first.
    const auto ended = [&](int bounces) {
        return with([&](auto& p) { p.diffuse_bounces = bounces; }).irradiance;
    };
    EXPECT_EQ(ended(1), 0);
    EXPECT_LT(ended(2), 0.8 * all.irradiance);
    EXPECT_LT(ended(2), ended(3));
    // Without events at the glass its light is missing.
    EXPECT_LT(with([](auto& p) { p.max_bounces = 1; }).report.counters.at("photons_refracted"),
              all.report.counters.at("photons_refracted"));
    EXPECT_EQ(all.report.counters.contains("shadow_photons_stored"), false);
    // Each ray meets one wall from within, through the ball or not.
    EXPECT_EQ(
        with([](auto& p) { p.shadow_photons = 1000; }).report.counters.at("shadow_photons_stored"),
        1'000U);
}

// What arrives is what leaves: each photon ends somewhere.
TEST(GlobalPhotonMap, AccountsForEveryPath) {
    const Counters counted = ask({.photons = 20'000}).report.counters;
    const auto of = [&](const char* name) { return counted.at(name); };
    EXPECT_EQ(of("photons_missed") + of("photons_escaped"), 0U);  // a closed box
    EXPECT_EQ(of("photons_aimed"), of("photons_absorbed") + of("photons_depth_limited") +
                                       of("photons_on_black_side") + of("photons_misdirected"));
}

// A lamp's photons on the walls, straight through the ball: what is behind it is in shadow.
TEST(GlobalPhotonMap, KnowsShadowsWhereItHasPhotonsForThem) {
    const Scene scene = box();
    GlobalMapParams params{.photons = 1'000, .gather = 0};
    const auto without = build(scene, params, {});
    EXPECT_EQ(without->known_shadows(), nullptr);
    params.shadow_photons = 20'000;
    const auto with = build(scene, params, {});
    const KnownShadows* const known = with->known_shadows();
    ASSERT_NE(known, nullptr);
    const auto context = with->make_context();
    const auto sees = [&](std::size_t wall, const Vec3d& at) {
        const Vec3d inwards = -scene.shapes()[wall].to_world.translation();
        return known->sees(support::probe(scene, wall, at, inwards, 0), 0, *context);
    };
    using Seen = KnownShadows::Seen;
    EXPECT_EQ(sees(0, {-1, 0, 0}), Seen::yes);
    EXPECT_EQ(sees(1, {1, -0.15, -0.39}), Seen::no) << "behind the ball's middle";
    // The map's own memory, and 20 bytes or a little more for each of them.
    const BuildReport report = with->build_report();
    const std::uint64_t stored = report.counters.at("shadow_photons_stored");
    EXPECT_GE(report.bytes, without->build_report().bytes + 20 * stored);
    EXPECT_LE(report.bytes, without->build_report().bytes + 24 * stored);
}

// Irradiance is known for surfaces that are lit as they look: under smooth normals that lean, photons are asked themselves.
TEST(GlobalPhotonMap, LooksUpNoIrradianceUnderNormalsThatLean) {
    const auto answer = [](bool smooth) {
        SceneDesc desc;
        TriangleMesh ball = tessellate_sphere(4);
        if (!smooth) ball.normals.clear();
        desc.shapes = support::emitting_room(2, 0, support::diffuse(0.5F));
        for (Shape& wall : desc.shapes) wall.radiance.reset();
        desc.shapes.push_back(
            support::mesh("ball", ball, Transform::Identity(), support::diffuse(0.5F)));
        desc.lights = {support::point_light({-1.5, 0.2, 1.5}, 1)};
        const Scene scene(std::move(desc));
        const auto map = build(scene, {.photons = 20'000, .gather = 400}, {});
        const ReceiverPoint point = support::probe(scene, 0, {-2, 0, 0}, Vec3d::UnitX(), 0);
        const auto context = map->make_context();
        std::vector<Estimate> out(1);
        map->irradiance({&point, 1}, out, *context);
        Answer found{static_cast<double>(out[0].value.mean()), {}, {}};
        context->add_to(found.counters);
        return found;
    };
    const Answer flat = answer(false), smooth = answer(true);
    EXPECT_EQ(flat.counters.at("gather_rays"), 400U);
    EXPECT_EQ(smooth.counters.at("gather_rays"), 400U);
    EXPECT_GE(flat.counters.at("irradiance_lookups"), 398U);
    // The ball has about a tenth of the view.
    EXPECT_LT(smooth.counters.at("irradiance_lookups"), 380U);
    EXPECT_GT(smooth.counters.at("irradiance_lookups"), 300U);
    // The same light, by other rays and photons: 400 rays whose ends scatter by a half agree to 4 sqrt(2) 2.5 %.
    EXPECT_NEAR(smooth.irradiance / flat.irradiance, 1, 0.14);
}

std::string refusal(const std::string& params) {
    try {
        globalphotonmap_method().configure(JsonNode::parse_text(params, "param"));
    } catch (const InputError& error) {
        return error.what();
    }
    return "taken";
}

TEST(GlobalPhotonMap, RefusesParametersThatServeNothing) {
    EXPECT_EQ(refusal("{}"), "taken");
    EXPECT_NE(refusal(R"({"gather": 0, "precompute": 2})").find("gather is 0"), std::string::npos);
    EXPECT_NE(refusal(R"({"gather": -1})").find("gather"), std::string::npos);
    EXPECT_NE(refusal(R"({"nearest": 1})").find("nearest"), std::string::npos);
    EXPECT_NE(refusal(R"({"glow": 1})").find("glow"), std::string::npos);
    for (const char* key : {"photons", "max_bounces", "diffuse_bounces"})
        EXPECT_NE(refusal(std::string(R"({"load": "a", ")") + key + R"(": 3})")
                      .find("cannot be given with load"),
                  std::string::npos)
            << key;
}

}  // namespace
}  // namespace caustics::photonmap
