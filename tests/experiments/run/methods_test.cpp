#include "experiments/run/methods.h"
#include "experiments/run/method.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "experiments/cli/help_text.h"

namespace caustics::experiments {
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

TEST(Methods, GrowWithOneOfTheirParameters) {
    for (const MethodDescription* each : all_methods()) {
        const MethodFacts& facts = each->facts();
        const WorkParameter& work = facts.work;
        EXPECT_EQ(work.parameter.empty(), !facts.has_caustic) << facts.name;
        if (work.parameter.empty()) continue;
        for (const std::int64_t value : {work.first, work.most})
            EXPECT_EQ(error(facts.name, {fmt::format("{}={}", work.parameter, value)}), "no error");
    }
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
        {"causticpolygons", {"prune=0.05", "max_beams=1000"}},
        {"beamtree", {"max_beams=20000"}},
        {"beamtree", {"rest_photons=5000"}},
        {"beamtree", {"rest_nearest=20"}},
        {"beamtree", {"preset=chuang1995"}},
        {"beamtree", {"preset=chuang1995", "bound=two_slice"}},
        {"photonmap", {"preset=jensen1996", "tree=packed"}},
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

// Trials are named by hashes of these texts: another text would run a sweep's trials again.
TEST(Methods, AreDescribedByTheSameTextsAsEver) {
    const auto text = [](const std::string& name, const std::vector<std::string>& params) {
        return describe(method(name, params)).dump();
    };
    EXPECT_EQ(text("none", {}), "{}");
    EXPECT_EQ(text("pathtrace", {}), R"({"max_bounces":1000,"spp":16})");
    EXPECT_EQ(text("lighttrace", {}), R"({"max_bounces":1000,"paths":1000000})");
    EXPECT_EQ(text("lighttrace", {"radius=0.25"}),
              R"({"max_bounces":1000,"paths":1000000,"radius":0.25})");
    EXPECT_EQ(text("illuminationmap", {}),
              R"({"emitted":1000000,"max_bounces":1000,"resolution":256})");
    EXPECT_EQ(text("causticpolygons", {}),
              R"({"light_samples":16,"max_bounces":16,"mesh_resolution":64,"polygons":"triangles",)"
              R"("receiver_resolution":16})");
    EXPECT_EQ(
        text("photonmap", {}),
        R"({"adaptive":false,"emission":"stratified","estimator":"unbiased",)"
        R"("filter":"epanechnikov","interaction":"roulette","kernel":"photon","max_bounces":1000,"nearest":50,"passes":1,)"
        R"("photons":100000,"pixel_footprint":true,"tables":false,"tree":"packed"})");
    EXPECT_EQ(text("photonmap", {"kernel=point"}),
              R"({"adaptive":false,"emission":"random","estimator":"unbiased","filter":"none",)"
              R"("interaction":"roulette","max_bounces":1000,"nearest":50,"passes":1,)"
              R"("photons":100000,"tables":false,"tree":"packed"})");
    EXPECT_EQ(
        text("photonmap", {"load=a.photons", "radius=0.5"}),
        R"({"adaptive":false,"estimator":"unbiased","filter":"epanechnikov","kernel":"photon",)"
        R"("load":"a.photons","passes":1,"pixel_footprint":true,"radius":0.5,)"
        R"("tables":false,"tree":"packed"})");
    EXPECT_EQ(text("photonmap", {"emitted=10", "adaptive=true", "max_radius=1"}),
              R"({"adaptive":true,"emission":"random","emitted":10,"estimator":"unbiased",)"
              R"("filter":"none","interaction":"roulette","max_bounces":1000,"max_radius":1.0,)"
              R"("nearest":200,"passes":1,"tables":false,"tree":"packed"})");
    EXPECT_EQ(
        text("beamtree", {}),
        R"({"bound":"two_slice","hierarchy":"binned","intensity":"refined","leaf":"k",)"
        R"("light_samples":16,"max_bounces":1000,"merging":"rays","mesh_resolution":64,)"
        R"("pencils":200000,"pixel_footprint":true,"polygons":"triangles","rest":"pencils"})");
    EXPECT_EQ(text("beamtree", {"rest=max_beams"}),
              R"({"bound":"two_slice","hierarchy":"binned","intensity":"refined","leaf":"k",)"
              R"("light_samples":16,"max_bounces":16,"merging":"rays","mesh_resolution":64,)"
              R"("polygons":"triangles"})");
    EXPECT_EQ(text("beamtree", {"bound=hybrid", "intensity=area"}),
              R"({"bound":"hybrid","hierarchy":"quadtree","intensity":"area","leaf":"n",)"
              R"("light_samples":16,"max_bounces":16,"merging":"rays","mesh_resolution":64,)"
              R"("polygons":"triangles","spread_threshold":10.0})");
    EXPECT_EQ(text("beamtree", {"footprint=0.1"}),
              R"({"bound":"two_slice","footprint":0.10000000149011612,"hierarchy":"binned",)"
              R"("intensity":"refined","leaf":"k","light_samples":16,"max_bounces":1000,)"
              R"("merging":"rays","mesh_resolution":64,"pencils":200000,"polygons":"triangles",)"
              R"("rest":"pencils"})");
}

// Who takes the parameters of a record has its settings, whatever the defaults have become.
TEST(Methods, AreTheSameByTheParametersOfTheirRecords) {
    for (const std::vector<std::string>& given : {std::vector<std::string>{},
                                                  {"rest=max_beams"},
                                                  {"max_beams=1000"},
                                                  {"rest=photons"},
                                                  {"pixel_footprint=false"},
                                                  {"beam_events=2"},
                                                  {"bound=hybrid"},
                                                  {"preset=chuang1995"}}) {
        const nlohmann::json recorded = describe(method("beamtree", given));
        std::vector<std::string> all;
        for (const auto& [key, value] : recorded.items())
            all.push_back(key + "=" +
                          (value.is_string() ? value.get<std::string>() : value.dump()));
        EXPECT_EQ(describe(method("beamtree", all)), recorded);
    }
}

TEST(Methods, KeepTheWordsOfOlderFilesInRecords) {
    for (const auto& [word, recorded] : {std::pair("receiver", "n"), std::pair("fixed", "k"),
                                         std::pair("n", "n"), std::pair("k", "k")})
        EXPECT_EQ(describe(method("beamtree", {std::string("leaf=") + word})).at("leaf"), recorded);
    EXPECT_NE(error("beamtree", {"leaf=m"}).find("receiver, fixed"), std::string::npos);
    EXPECT_NE(help_text("beamtree").find("receiver, fixed, default fixed"), std::string::npos);
}

// A preset is a paper's settings, and what stands beside it changes it.
TEST(Methods, TakeThePapersSettingsByName) {
    const auto settings = [](const std::string& name, const std::vector<std::string>& params) {
        return describe(method(name, params));
    };
    nlohmann::json paper = settings("beamtree", {"preset=chuang1995"});
    EXPECT_EQ(paper.at("preset"), "chuang1995");
    paper.erase("preset");
    EXPECT_EQ(paper, settings("beamtree", {"bound=hybrid", "merging=cones", "hierarchy=quadtree",
                                           "leaf=receiver", "intensity=area"}));
    EXPECT_EQ(settings("beamtree", {"preset=chuang1995", "bound=single"}).at("bound"), "single");
    paper = settings("photonmap", {"nearest=80", "preset=jensen1996"});
    EXPECT_EQ(paper.at("preset"), "jensen1996");
    paper.erase("preset");
    EXPECT_EQ(paper, settings("photonmap",
                              {"nearest=80", "tree=balanced", "estimator=raw", "max_bounces=16"}));
    EXPECT_NE(error("beamtree", {"preset=jensen1996"}).find("chuang1995"), std::string::npos);
}

// What belongs to cones asks for them, as it did when they were the default.
TEST(Methods, TakeConesWhereAParameterOfConesIsGiven) {
    for (const std::string of_cones : {"spread_threshold=22.5", "merging=cones", "leaf=receiver"}) {
        const nlohmann::json described = describe(method("beamtree", {of_cones}));
        EXPECT_EQ(described.at("bound"), "hybrid") << of_cones;
        EXPECT_EQ(described.at("hierarchy"), "quadtree") << of_cones;
        EXPECT_EQ(described.at("leaf"), "n") << of_cones;
        EXPECT_NE(error("beamtree", {"bound=two_slice", of_cones}), "no error");
    }
}

TEST(Methods, AreToldKeyByKey) {
    for (const MethodDescription* each : all_methods()) {
        const std::string help = help_text(each->facts().name);
        for (std::size_t start = 0; start < help.size(); start = help.find('\n', start) + 1)
            EXPECT_LE(help.find('\n', start) - start, 100U) << help.substr(start);
        for (const KeyText& key : each->parameters()) {
            EXPECT_NE(help.find("\n  " + key.key + " "), std::string::npos) << key.key;
            EXPECT_TRUE(key.meaning.ends_with(".")) << key.key;
            EXPECT_FALSE(key.usual.empty()) << key.key << " has a default";
        }
    }
}

TEST(Methods, StandInTheReadme) {
    const std::string readme = read_whole_file(CAUSTICS_SOURCE_DIR "/README.md");
    for (const MethodDescription* each : all_methods()) {
        const MethodFacts& facts = each->facts();
        const std::string row =
            "| `" + facts.name + "` | " + facts.summary + " | " + facts.serves + " |";
        EXPECT_NE(readme.find(row), std::string::npos) << "README.md needs this row:\n" << row;
    }
}

TEST(Methods, TakeValuesAsJsonOrElseAsStrings) {
    EXPECT_EQ(describe(method("photonmap", {"photons=1e4"})).at("photons"), 10000);
    EXPECT_EQ(describe(method("photonmap", {"estimator=raw"})).at("estimator"), "raw");
    EXPECT_EQ(describe(method("photonmap", {"estimator=\"raw\""})).at("estimator"), "raw");
    EXPECT_EQ(describe(method("photonmap", {"radius=.15"})).at("radius"), 0.15);
    EXPECT_EQ(describe(method("photonmap", {"radius=2."})).at("radius"), 2);
    for (const std::string text : {"nan", "inf", "-inf", "015", "0x1", "+.5", ".", "1e400", ""})
        EXPECT_NE(error("photonmap", {"radius=" + text}), "no error") << text;
}

TEST(Methods, NameTheAlternatives) {
    EXPECT_EQ(error("photonmpa", {}),
              "unknown method \"photonmpa\": did you mean photonmap? (known: none, pathtrace, "
              "lighttrace, "
              "photonmap, beamtree, illuminationmap, causticpolygons)");
    EXPECT_EQ(describe(method("photonmap", {"photons=1.5M"})).at("photons"), 1'500'000);
    const std::string unknown = error("photonmap", {"photns=10"});
    EXPECT_NE(unknown.find("photns"), std::string::npos) << unknown;
    EXPECT_NE(unknown.find("photons"), std::string::npos) << unknown;
    for (const std::string assignment : {"photons", "=5", "="})
        EXPECT_EQ(error("none", {assignment}),
                  "--param \"" + assignment + "\": expected key=value");
    EXPECT_NE(error("lighttrace", {"radius=2e12"}).find("out of range"), std::string::npos);
    EXPECT_EQ(error("lighttrace", {"paths=1", "paths=2"}), "--param \"paths\": given twice");
}

TEST(Methods, SayHowTheyAnswerProbes) {
    EXPECT_TRUE(method("lighttrace", {"radius=0.25"}).facts().gathers_over_discs);
    EXPECT_EQ(method("lighttrace", {"radius=0.25"}).configured->disc_radius(), 0.25);
    EXPECT_FALSE(method("photonmap", {}).facts().gathers_over_discs);
}

}  // namespace
}  // namespace caustics::experiments
