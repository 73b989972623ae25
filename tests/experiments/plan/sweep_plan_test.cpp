#include "experiments/plan/sweep_plan.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <regex>
#include <set>

#include "core/base/error.h"
#include "experiments/base/file_io.h"
#include "photonmap/photons/photon_map_file.h"
#include "tests/support/temporary_folder.h"

namespace caustics::experiments {
namespace {

const std::string scene = CAUSTICS_SOURCE_DIR "/tests/experiments/scenes/ball.json";

class SweepPlans : public testing::Test {
protected:
    /// A sweep file over the test scene with these members.
    std::filesystem::path sweep(const std::string& members) {
        const std::filesystem::path file = folder_ / "sweep.json";
        write_atomic_file(file, fmt::format(R"({{"version": 1, "scenes": ["{}"], "spp": 4, {}}})",
                                            scene, members));
        return file;
    }
    /// A second sweep file.
    std::filesystem::path write_second(const std::filesystem::path& of_scene,
                                       const std::string& members) {
        const std::filesystem::path file = folder_ / "second.json";
        write_atomic_file(file, fmt::format(R"({{"version": 1, "scenes": ["{}"], "spp": 4, {}}})",
                                            of_scene.string(), members));
        return file;
    }
    SweepPlan plan(const std::string& members) { return read_plan({sweep(members)}); }
    std::string error(const std::string& members) { return error_of({sweep(members)}); }
    static std::string error_of(const std::vector<std::filesystem::path>& files) {
        try {
            read_plan(files);
        } catch (const InputError& error) {
            return error.what();
        }
        return "no error";
    }
    support::TemporaryFolder folder_;
};

std::set<std::string> ids(const SweepPlan& plan) {
    std::set<std::string> all;
    for (const Trial& trial : plan.trials) all.insert(trial.id);
    return all;
}

const std::string none = R"("methods": [{"method": "none"}])";

TEST_F(SweepPlans, AreTheProductOfAllLists) {
    const SweepPlan all = plan(
        R"("set": {"glass": {"pointer": "/ball/bsdf/int_ior", "values": [1.3, 1.5]}},
           "methods": [{"method": "photonmap",
                        "param": {"photons": [10, 20, 30], "nearest": [5, 6], "estimator": "raw"}},
                       {"method": "none"}],
           "seeds": [1, 2, 3], "repeats": 2)");
    EXPECT_EQ(all.trials.size(), 2U * (3 * 2 + 1) * 3 * 2);
    EXPECT_EQ(ids(all).size(), all.trials.size());
    EXPECT_EQ(all.swept, (std::vector<std::string>{"glass", "estimator", "nearest", "photons"}));
    std::set<std::string> cells;
    for (const Trial& trial : all.trials) cells.insert(trial.cell);
    EXPECT_EQ(cells.size(), 2U * 7) << "a cell is what differs in more than seed and repeat";
}

TEST_F(SweepPlans, MultiplyByMethodsOfTheIndirectLayer) {
    const SweepPlan all = plan(none + R"(, "indirect": [{"method": "none"},
                                 {"method": "globalphotonmap",
                                  "param": {"photons": [1000, 2000], "gather": 4}}],
                    "reference": {"method": "lighttrace", "param": {"paths": 100},
                                  "indirect": {"method": "lighttrace", "param": {"paths": 200}}})");
    ASSERT_EQ(all.trials.size(), 3U);
    EXPECT_FALSE(all.trials[0].request.indirect);
    EXPECT_EQ(all.trials[2].request.indirect->name, "globalphotonmap");
    EXPECT_EQ(all.swept, (std::vector<std::string>{"indirect_gather", "indirect_photons"}));
    EXPECT_EQ(ids(all).size(), 3U);
    EXPECT_EQ(all.trials[1].reference->request.indirect->name, "lighttrace");
    // Without that layer a trial is what it was.
    EXPECT_TRUE(ids(plan(none + R"(, "indirect": [{"method": "none"}])")) == ids(plan(none)));
    EXPECT_NE(error(none + R"(, "indirect": [{"method": "globalphotonmap"}],
                                "reference": {"method": "lighttrace"})")
                  .find("/reference: has no indirect light"),
              std::string::npos);
    EXPECT_NE(error(none + R"(, "indirect": [{"method": "photonmap"}])").find("/indirect/0/method"),
              std::string::npos);
}

TEST_F(SweepPlans, NameTrialsByWordsAndHash) {
    const SweepPlan all = plan(R"("methods": [{"method": "photonmap", "param": {"photons": 10}}])");
    ASSERT_EQ(all.trials.size(), 1U);
    EXPECT_TRUE(
        std::regex_match(all.trials[0].id, std::regex("ball-photonmap-photons10-s1-[0-9a-f]{16}")))
        << all.trials[0].id;
    EXPECT_EQ(ids(all), ids(plan(R"("methods": [{"method": "photonmap",
                                                "param": {"photons": [10]}}], "seeds": [1])")))
        << "the same trial however it is written";
}

TEST_F(SweepPlans, NeverGiveTwoTrialsOneName) {
    const SweepPlan all = plan(
        R"("set": {"floor": {"pointer": "/floor/bsdf/reflectance",
                             "values": [0.1, 0.15, [0.1, 0.1, 0.5], 0.01, 1]},
                   "light": {"pointer": "/light/position",
                             "values": [[1, 0, 3], [-1, 0, 3], [1, 0, 3.5]]}}, )" +
        none);
    EXPECT_EQ(all.trials.size(), 15U);
    EXPECT_EQ(ids(all).size(), 15U);
}

TEST_F(SweepPlans, JoinFilesAndDropWhatIsNamedTwice) {
    const std::filesystem::path first =
        sweep(R"("methods": [{"method": "none"}], "seeds": [1, 2])");
    const std::filesystem::path second = folder_ / "second.json";
    write_atomic_file(
        second,
        fmt::format(
            R"({{"version": 1, "scenes": ["{}"], "spp": 4, "methods": [{{"method": "none"}}],
            "seeds": [2, 3]}})",
            scene));
    const SweepPlan all = read_plan({first, second});
    EXPECT_EQ(all.trials.size(), 3U);
    EXPECT_EQ(all.duplicates, 1U);
}

TEST_F(SweepPlans, KeyReferencesByAllTheyDependOn) {
    const auto key = [&](const std::string& reference) {
        return plan(none + R"(, "reference": )" + reference).trials[0].reference->key;
    };
    const std::string first = key(R"({"method": "lighttrace", "param": {"paths": 1000}})");
    EXPECT_EQ(first, key(R"({"method": "lighttrace", "param": {"paths": 1e3}, "spp": 64})"));
    for (const char* other : {R"({"method": "lighttrace", "param": {"paths": 1001}})",
                              R"({"method": "lighttrace", "param": {"paths": 1000}, "seed": 2})",
                              R"({"method": "lighttrace", "param": {"paths": 1000}, "spp": 16})"})
        EXPECT_NE(first, key(other)) << other;
}

/// A photon map of no photons; the seed makes it another one.
void write_map(const std::filesystem::path& file, std::uint64_t seed) {
    photonmap::save_photon_map({photonmap::PhotonStore(0), {}, Spectrum::Ones()}, {.seed = seed},
                               file);
}

TEST_F(SweepPlans, TellTrialsThatLoadAFileByItsContent) {
    const std::string load =
        R"("methods": [{"method": "photonmap", "param": {"load": "a.photons"}}])";
    write_map(folder_ / "a.photons", 1);
    const SweepPlan first = plan(load);
    EXPECT_EQ(first.trials[0].method_files.size(), 1U);
    write_map(folder_ / "a.photons", 2);
    EXPECT_NE(plan(load).trials[0].config_hash, first.trials[0].config_hash);
    write_map(folder_ / "b.photons", 1);
    EXPECT_EQ(plan(R"("methods": [{"method": "photonmap", "param": {"load": "b.photons"}}])")
                  .trials[0]
                  .config_hash,
              first.trials[0].config_hash)
        << "the name of the file does not matter";
    EXPECT_NE(error(R"("methods": [{"method": "photonmap", "param": {"load": "c.photons"}}])")
                  .find("c.photons: cannot be read"),
              std::string::npos);
}

TEST_F(SweepPlans, RefuseToSaveTheFilesOfTrialsOverEachOther) {
    const std::string reason =
        error(R"("methods": [{"method": "photonmap", "param": {"save": "a.photons"}}])");
    EXPECT_NE(reason.find("/methods/0/param: /save: not in a sweep"), std::string::npos) << reason;
}

TEST_F(SweepPlans, SetAWholeObjectBeforeAValueInIt) {
    const SweepPlan all = plan(none + R"(, "set": {
        "a_glass": {"pointer": "/ball/bsdf/int_ior", "values": [1.3, 1.5]},
        "kind": {"pointer": "/ball/bsdf", "values": [{"type": "dielectric"}]}})");
    ASSERT_EQ(all.trials.size(), 2U) << "whatever their names, both count";
    const Overrides expected = {{"/ball/bsdf", R"({"type":"dielectric"})"},
                                {"/ball/bsdf/int_ior", "1.3"}};
    EXPECT_EQ(all.trials[0].request.overrides, expected);
}

// Of 0.4 MB, they took all memory.
TEST_F(SweepPlans, RefuseMoreValuesThanAPlanHolds) {
    const auto keys = [](int count, const std::string& value) {
        std::string text;
        for (int i = 0; i < count; ++i)
            text += (i == 0 ? "" : ",") + ("\"a" + std::to_string(i)) + "\": " + value;
        return "{" + text + "}";
    };
    const std::string axis = R"({"pointer": "/ball/radius", "values": [1]})";
    std::string many = "[1";
    for (int i = 2; i <= 20'000; ++i) many += "," + std::to_string(i);
    const std::vector<std::pair<std::string, std::string>> cases = {
        {none + R"(, "set": )" + keys(101, axis),
         "/set: makes trials of 101 keys, more than 100 (split the sweep file)"},
        {R"("methods": [{"method": "photonmap", "param": )" + keys(101, "1") + "}]",
         "/methods/0/param: makes trials of 101 keys"},
        {R"("methods": [{"method": "photonmap", "param": )" + keys(60, many + "]") + "}]",
         "makes 20000 trials of 60 keys, more than 1000000 values"}};
    for (const auto& [members, words] : cases)
        EXPECT_NE(error(members).find(words), std::string::npos) << error(members);
}

TEST_F(SweepPlans, RefuseWhatDoesNotFitBeforeAnythingRuns) {
    const std::vector<std::pair<std::string, std::string>> cases = {
        {R"("methods": [])", "/methods"},
        {none + R"(, "seeds": [])", "/seeds"},
        {none + R"(, "set": {"a": {"pointer": "/ball/radius", "values": []}})", "/set/a/values"},
        {none + R"(, "threads": 0)", "/threads"},
        {none + R"(, "seeds": [-1])", "/seeds/0"},
        {none + R"(, "version": 2)", "version"},
        {none + R"(, "repeats": 0)", "/repeats"},
        {none + R"(, "spq": 4)", "spq"},
        {none + R"(, "repeats": 1000000000)", "makes 1000000000 trials, more than 100000 ("},
        {none + R"(, "repeats": 100001)", "makes 100001 trials, more than 100000 ("},
        {R"("methods": [{"method": "photonmpa"}])", "/methods/0/method"},
        {R"("methods": [{"method": "photonmap", "param": {"photons": []}}])", "photons"},
        {R"("methods": [{"method": "photonmap", "param": {"photns": 5}}])", "photns"},
        {R"("methods": [{"method": "photonmap", "param": {"nearest": [10, -1]}}])", "nearest"},
        {none + R"(, "set": {"a": {"pointer": "/flor/bsdf", "values": [1]}})", "/flor"},
        {none + R"(, "set": {"a": {"pointer": "/floor/bsdf/alhpa", "values": [1]}})", "alhpa"},
        {none + R"(, "set": {"rmse": {"pointer": "/x", "values": [1]}})", "column of every trial"},
        {R"("methods": [{"method": "photonmap", "param": {"photons": 5}}],
             "set": {"photons": {"pointer": "/ball/radius", "values": [0.3]}})",
         R"(/set/photons: "photons" is the column of a method's parameter)"},
        {none + R"(, "indirect": [{"method": "pathtrace", "param": {"spp": 5}}],
             "set": {"indirect_spp": {"pointer": "/ball/radius", "values": [0.3]}})",
         "/set/indirect_spp"},
        {none + R"(, "set": {"a": {"pointer": "/ball/radius", "values": [0.3]},
                             "b": {"pointer": "/ball/radius", "values": [0.4]}})",
         R"(/set/b/pointer: /ball/radius is what "a" sets already)"},
        {none + R"(, "set": {"A b": {"pointer": "/x", "values": [1]}})", "small letters"},
        {none + R"(, "spp": 5)", "spp"},
        {none + R"(, "reference": {"method": "lighttrace", "spp": 1002001})",
         "/reference/spp: 1002001 is out of range"}};
    for (const auto& [members, word] : cases) {
        const std::string message = error(members);
        EXPECT_NE(message.find(word), std::string::npos) << members << ": " << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
    EXPECT_THROW(plan(none + R"(, "reference": {"method": "pathtrace"})"), UnsupportedScene);
}

TEST_F(SweepPlans, TakeAsManySamplesAsARenderedPicture) {
    const std::filesystem::path file = folder_ / "samples.json";
    const auto error_with = [&](int samples) {
        write_atomic_file(file, fmt::format(R"({{"version": 1, "scenes": ["{}"], "spp": {}, {}}})",
                                            scene, samples, none));
        return error_of({file});
    };
    EXPECT_EQ(error_with(1'000'000), "no error");
    EXPECT_NE(error_with(1'002'001).find("/spp: 1002001 is out of range"), std::string::npos)
        << error_with(1'002'001);
}

TEST_F(SweepPlans, NameFileKeyAndSceneOfSamplesThatASamplerCannotTake) {
    const std::filesystem::path file = folder_ / "samples.json";
    const auto error_with = [&](const std::string& members) {
        write_atomic_file(file, fmt::format(R"({{"version": 1, "scenes": ["{}"], {}, {}}})", scene,
                                            members, none));
        return error_of({file});
    };
    EXPECT_TRUE(error_with(R"("spp": 3)")
                    .starts_with(fmt::format("{}: /spp: for {}: 3: the scene's stratified sampler",
                                             file.string(), scene)))
        << error_with(R"("spp": 3)");
    const std::string reference =
        R"("spp": 4, "reference": {"method": "lighttrace", "param": {"paths": 10}, "spp": 5})";
    EXPECT_TRUE(error_with(reference).starts_with(fmt::format(
        "{}: /reference/spp: for {}: 5: the scene's stratified sampler", file.string(), scene)))
        << error_with(reference);
}

// All files of a command make one table.
TEST_F(SweepPlans, RefuseAnAxisNamedAsAParameterOfAnotherFile) {
    const std::filesystem::path params =
        sweep(R"("methods": [{"method": "photonmap", "param": {"photons": 5}},
                            {"method": "beamtree", "param": {"polygons": "quads"}}])");
    for (const std::string name : {"photons", "method_polygons"}) {
        const std::filesystem::path axis =
            write_second(scene, none + R"(, "set": {")" + name +
                                    R"(": {"pointer": "/ball/radius", "values": [0.3]}})");
        EXPECT_EQ(error_of({axis}), "no error") << name;
        for (const auto& both : {std::vector{params, axis}, std::vector{axis, params}})
            EXPECT_EQ(
                error_of(both),
                fmt::format("{}: /set/{}: \"{}\" is the column of a method's parameter: choose "
                            "another name",
                            axis.string(), name, name));
    }
}

TEST_F(SweepPlans, RefuseTwoScenesOfOneName) {
    const std::filesystem::path other = folder_ / "other/ball.json";
    std::filesystem::create_directory(other.parent_path());
    std::filesystem::copy_file(scene, other);
    const std::vector<std::filesystem::path> both = {sweep(none), write_second(other, none)};
    const std::string reason = error_of(both);
    for (const std::string& name : {both[1].string(), scene, other.string()})
        EXPECT_NE(reason.find(name), std::string::npos) << reason;
    EXPECT_NE(reason.find("have one name"), std::string::npos) << reason;
    std::filesystem::remove(other);
    std::filesystem::create_symlink(scene, other);
    EXPECT_EQ(error_of(both), "no error") << "one file by two names is one scene";
}

TEST_F(SweepPlans, NameThePlaceOfAMistakeInTheSweepFileToo) {
    const std::string file = (folder_ / "sweep.json").string();
    EXPECT_EQ(error(none + R"(, "set": {"a": {"pointer": "/ball/radius", "values": [0.4]},
                                        "b": {"pointer": "/ball/bsdf/int_ior", "values": [1.5, -1]},
                                        "c": {"pointer": "/floor/bsdf/reflectance", "values": [0]}})"),
              file + ": /set/b: -1: " + scene +
                  ": /ball/bsdf/int_ior: -1 is out of range (from 0.1 to 10)");
    EXPECT_NE(error(none + R"(, "set": {"a": {"pointer": "/flor/x", "values": [1]}})")
                  .find(file + ": /set/a: 1: "),
              std::string::npos);
    const std::string broken = folder_ / "broken.json";
    write_atomic_file(broken, "{}");
    const std::filesystem::path sweep = folder_ / "second.json";
    write_atomic_file(sweep,
                      fmt::format(R"({{"version": 1, "scenes": ["{}"], {}}})", broken, none));
    try {
        read_plan({sweep});
        FAIL();
    } catch (const InputError& mistake) {
        EXPECT_EQ(std::string(mistake.what()).rfind(sweep.string() + ": /scenes: " + broken, 0), 0U)
            << mistake.what();
    }
}

// Those that the project brings along, README's tiny.json among them.
TEST_F(SweepPlans, EveryShippedSweepFileCanBePlanned) {
    std::size_t files = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(CAUSTICS_SOURCE_DIR "/experiments/sweeps")) {
        if (entry.path().extension() != ".json") continue;
        ++files;
        EXPECT_NO_THROW(EXPECT_FALSE(read_plan({entry.path()}).trials.empty())) << entry.path();
    }
    EXPECT_GE(files, 20U);
}

}  // namespace
}  // namespace caustics::experiments
