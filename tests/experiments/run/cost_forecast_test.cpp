#include "experiments/run/cost_forecast.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/scene/scene_reader.h"

namespace caustics::experiments {
namespace {

Method method_of(const std::string& name, const std::vector<std::string>& parameters = {}) {
    return parse_method(name, parameters_node(parameters));
}

Scene ball() {
    return Scene(load_scene(CAUSTICS_SOURCE_DIR "/tests/experiments/scenes/ball.json", {}).desc);
}

TEST(ShareOfWork, MakesTheNumberSmallerThatAMethodIsMadeOf) {
    const auto quarter = [](const Method& method, const std::string& parameter) {
        const auto [some, share] = method.configured->with_share_of_work(0.25);
        EXPECT_EQ(share, 0.25) << method.name;
        Method trial = method;
        trial.configured = some;
        return describe(trial).at(parameter);
    };
    EXPECT_EQ(quarter(method_of("photonmap"), "photons"), 25'000);
    EXPECT_EQ(quarter(method_of("photonmap", {"emitted=4000"}), "emitted"), 1000);
    EXPECT_EQ(quarter(method_of("lighttrace"), "paths"), 250'000);
    EXPECT_EQ(quarter(method_of("illuminationmap"), "emitted"), 250'000);
    EXPECT_EQ(quarter(method_of("beamtree"), "pencils"), 50'000);
}

TEST(ShareOfWork, IsAllOfWhatHasNoNumber) {
    for (const char* name : {"none", "pathtrace"})
        EXPECT_EQ(method_of(name).configured->with_share_of_work(0.25).second, 1) << name;
}

TEST(ShareOfWork, IsAtLeastOneOfEach) {
    const auto [some, share] =
        method_of("photonmap", {"photons=10"}).configured->with_share_of_work(0.001);
    EXPECT_EQ(share, 0.1);
}

TEST(ShareOfWork, WritesNoFile) {
    const Method method = method_of("photonmap", {"save=/nowhere/a.photons"});
    EXPECT_TRUE(method.configured->with_share_of_work(0.25).first->files_written().empty());
}

TEST(CostForecast, GrowsWithTheWork) {
    const Scene scene = ball();
    const CostForecast forecast(scene, 1);
    const PictureCost some = forecast.of(method_of("photonmap", {"photons=100000"}), 0);
    const PictureCost many = forecast.of(method_of("photonmap", {"photons=6400000"}), 0);
    EXPECT_FALSE(some.is_least);
    EXPECT_GT(some.seconds, 0);
    EXPECT_GT(many.seconds, 8 * some.seconds);
    // A photon is kept in 20 bytes.
    EXPECT_GT(many.bytes, 20 * 6'400'000.0);
}

}  // namespace
}  // namespace caustics::experiments
