#include "experiments/run/methods.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/base/error.h"

namespace caustics {
namespace {

Method method(const std::string& name, const std::vector<std::string>& params) {
    return parse_method(name, parameters_node(params));
}

std::string error(const std::string& name, const std::vector<std::string>& params) {
    try {
        method(name, params);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

TEST(Methods, AreDescribedByParametersThatReadBack) {
    const std::vector<std::pair<std::string, std::vector<std::string>>> cases = {
        {"none", {}},
        {"pathtrace", {"spp=7", "max_bounces=3"}},
        {"lighttrace", {"paths=1234", "radius=0.25"}},
        {"photonmap", {}},
        {"beamtree", {}},
        {"beamtree",
         {"bound=double", "merging=cones", "hierarchy=binned", "leaf=k", "light_samples=3",
          "mesh_resolution=20", "max_bounces=1"}},
        {"beamtree", {"spread_threshold=22.5"}},
        {"illuminationmap", {"emitted=1000", "resolution=12", "max_bounces=3"}},
        {"causticpolygons", {"receiver_resolution=5", "light_samples=2"}},
        {"photonmap", {"emitted=1000", "nearest=12", "estimator=raw", "max_radius=0.5"}},
        {"photonmap", {"adaptive=true", "nearest=120", "filter=gaussian"}},
        {"photonmap",
         {"radius=0.25", "filter=cone", "passes=3", "emission=stratified", "interaction=split"}},
        {"photonmap", {"emission=stratified", "save=a.photons"}},
        {"photonmap", {"load=a.photons", "nearest=12"}}};
    for (const auto& [name, params] : cases) {
        const nlohmann::json described = describe(method(name, params));
        const Method again = parse_method(name, JsonNode::parse_text(described.dump(), "test"));
        EXPECT_EQ(describe(again), described) << name;
        for (const std::string& param : params) {
            const std::string key = param.substr(0, param.find('='));
            ASSERT_TRUE(described.contains(key)) << name << " forgets " << key;
            const nlohmann::json& value = described.at(key);
            EXPECT_EQ(value.is_string() ? value.get<std::string>() : value.dump(),
                      param.substr(key.size() + 1));
        }
    }
}

TEST(Methods, TakeValuesAsJsonOrElseAsStrings) {
    EXPECT_EQ(describe(method("photonmap", {"photons=1e4"})).at("photons"), 10000);
    EXPECT_EQ(describe(method("photonmap", {"estimator=raw"})).at("estimator"), "raw");
    EXPECT_EQ(describe(method("photonmap", {"estimator=\"raw\""})).at("estimator"), "raw");
}

TEST(Methods, NameTheAlternatives) {
    EXPECT_EQ(
        error("photonmpa", {}),
        "unknown method \"photonmpa\" (known: none, pathtrace, lighttrace, photonmap, beamtree, "
        "illuminationmap, causticpolygons)");
    const std::string unknown = error("photonmap", {"photns=10"});
    EXPECT_NE(unknown.find("photns"), std::string::npos) << unknown;
    EXPECT_NE(unknown.find("photons"), std::string::npos) << unknown;
    EXPECT_EQ(error("none", {"photons"}), "--param \"photons\": expected key=value");
    EXPECT_EQ(error("lighttrace", {"paths=1", "paths=2"}), "--param \"paths\": given twice");
}

TEST(Methods, SayHowTheyAnswerProbes) {
    EXPECT_TRUE(gathers_over_discs(method("lighttrace", {"radius=0.25"})));
    EXPECT_EQ(disc_radius(method("lighttrace", {"radius=0.25"})), 0.25);
    EXPECT_FALSE(gathers_over_discs(method("photonmap", {})));
}

}  // namespace
}  // namespace caustics
