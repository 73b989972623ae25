#include "experiments/run/caustic_ledger.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "experiments/run/method.h"
#include "experiments/run/notes.h"
#include "tests/support/build_scene.h"

namespace caustics::experiments {
namespace {

// A light in a sphere that is half a mirror: event n brings q^n of its light to the wall, so that paths of M events at
// most miss q^M of the caustic.
constexpr double q = 0.9 * 0.6;

SceneDesc half_mirror_ball() {
    Bsdf blend = support::diffuse(0.5F);
    blend.mirror = MirrorPart{0.6F, Spectrum(Spectrum::Constant(0.9F))};
    SceneDesc desc;
    desc.shapes = {support::enclosure(2, blend)};
    desc.lights = {support::point_light({0, 0, 0}, 10)};
    return desc;
}

CausticLedger ledger_of(const Scene& scene, const std::string& name,
                        const std::vector<std::string>& parameters) {
    const Method method = parse_method(name, parameters_node(parameters));
    const BuildReport report = build(scene, method, RunOptions{})->build_report();
    return caustic_ledger(scene, method, report).value();
}

TEST(CausticLedger, TellsTheShareThatALimitOfEventsCuts) {
    const Scene scene(half_mirror_ball());
    for (const int limit : {1, 3, 6})
        for (const auto& [name, parameters] :
             {std::pair<std::string, std::vector<std::string>>{"photonmap", {"emitted=20000"}},
              {"photonmap", {"emitted=20000", "interaction=split"}},
              {"illuminationmap", {"emitted=20000"}},
              {"beamtree", {"mesh_resolution=8"}}}) {
            std::vector<std::string> all = parameters;
            all.push_back("max_bounces=" + std::to_string(limit));
            const CausticLedger ledger = ledger_of(scene, name, all);
            const double missed = std::pow(q, limit);
            EXPECT_NEAR(ledger.share(ledger.missed_by_cut), missed, 0.05 * missed)
                << name << " " << limit;
            EXPECT_GT(ledger.light.cut, 0) << name;
        }
}

TEST(CausticLedger, NotesTheShareThatALimitOfEventsCuts) {
    const Scene scene(half_mirror_ball());
    const auto told = [&](const std::string& limit) {
        const Method method = parse_method("photonmap", parameters_node({"emitted=20000", limit}));
        const BuildReport report = build(scene, method, RunOptions{})->build_report();
        return notes(scene, method, report, caustic_ledger(scene, method, report));
    };
    const std::vector<std::string> cut = told("max_bounces=3");
    ASSERT_EQ(cut.size(), 1U);
    EXPECT_TRUE(cut[0].starts_with("max_bounces=3 cuts 15.") ||
                cut[0].starts_with("max_bounces=3 cuts 16."))
        << cut[0];
    EXPECT_TRUE(told("max_bounces=1000").empty());
}

// Sent = arrived + cut + pruned + misdirected + absorbed + escaped, in watts.
TEST(CausticLedger, BalancesForEveryMethod) {
    SceneDesc desc;
    desc.shapes = {support::sphere("ball", {0, 0, 1}, 0.5, support::glass(1.5F)),
                   support::horizontal("floor", 0, 2, true, support::diffuse(0.5F))};
    desc.lights = {support::point_light({0.2, 0.1, 3}, 5)};
    const Scene scene(std::move(desc));
    const LightSurvey survey = survey_light(scene, 1000, 200'000);
    for (const auto& [name, parameters] :
         {std::pair<std::string, std::vector<std::string>>{"photonmap", {"photons=50000"}},
          {"illuminationmap", {"emitted=100000"}},
          {"beamtree", {"mesh_resolution=8", "prune=0.05"}},
          {"causticpolygons", {"mesh_resolution=8"}}}) {
        const CausticLedger ledger = ledger_of(scene, name, parameters);
        const LightLedger& light = ledger.light;
        EXPECT_NEAR(light.ended(), light.sent, 1e-5 * light.sent) << name;
        EXPECT_NEAR(light.sent, survey.light.sent, 0.02 * survey.light.sent) << name;
        EXPECT_EQ(light.pruned > 0, name == "beamtree" || name == "causticpolygons") << name;
        const nlohmann::json json = to_json(ledger);
        EXPECT_NEAR(json.at("escaped_share").get<double>(), light.escaped / light.arrived, 1e-12);
    }
}

TEST(CausticLedger, IsNoneOfAMethodWithoutCaustic) {
    const Scene scene(half_mirror_ball());
    EXPECT_FALSE(caustic_ledger(scene, parse_method("none", parameters_node({})), {}).has_value());
}

// The share of the caustic is told, not that of the light on casters. Coarse polygons also misplace light, which is not part
// of what pruning loses.
TEST(CausticLedger, TellsMostOfTheCausticThatBeamsLose) {
    SceneDesc desc;
    for (int i = 0; i < 3; ++i)
        desc.shapes.push_back(
            support::sphere("ball", {0.02 * i, 0, 1 + 1.01 * i}, 0.5, support::glass(1.5F)));
    desc.shapes.push_back(support::horizontal("floor", 0, 10, true, support::diffuse(0.5F)));
    desc.lights = {support::point_light({0, 0, 5}, 5)};
    const Scene scene(std::move(desc));
    const std::vector<std::string> coarse = {"mesh_resolution=24", "prune=0.3", "footprint=0.1"};
    const CausticLedger ledger = ledger_of(scene, "beamtree", coarse);
    const Method method = parse_method("beamtree", parameters_node(coarse));
    const auto beams = build(scene, method, RunOptions{});
    const auto whole = survey_light(scene, 1000, 200'000);
    std::vector<ReceiverPoint> points;
    constexpr int side = 200;  // squares that tile the floor
    const std::size_t floor = scene.shapes().size() - 1;
    for (int i = 0; i < side * side; ++i)
        points.push_back(support::probe(
            scene, floor, {(i % side + 0.5) * 20 / side - 10, (i / side + 0.5) * 20 / side - 10, 0},
            Vec3d::UnitZ(), points.size()));
    double sum = 0;
    for (const Estimate& found : support::irradiance(*beams, points))
        sum += static_cast<double>(found.value.mean()) * 400 / (side * side);
    const double missing = 1 - sum / whole.on_shape[floor];
    ASSERT_GT(missing, 0.01);
    EXPECT_GT(ledger.share(ledger.missed_by_pruning), missing / 2);
    EXPECT_LT(ledger.share(ledger.missed_by_pruning), missing);
}

}  // namespace
}  // namespace caustics::experiments
