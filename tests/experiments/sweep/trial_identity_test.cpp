#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <set>

#include "core/render/film.h"
#include "experiments/base/file_io.h"
#include "experiments/plan/trial_store.h"
#include "experiments/sweep/sweep.h"
#include "tests/experiments/sweep/plan_of.h"
#include "tests/support/temporary_folder.h"

// A finished trial is reused when a sweep is resumed. It may be, where everything that made its picture is the same.

namespace caustics::experiments {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

/// Everything that makes the picture of a small sweep's one trial. A change edits it, and a resumed sweep reads it again.
class ResumedSweeps : public testing::Test {
protected:
    void SetUp() override {
        options_.folder = folder_ / "out";
        scene_ =
            json::parse(read_whole_file(CAUSTICS_SOURCE_DIR "/tests/experiments/scenes/ball.json"));
        scene_["sensor"]["film"]["width"] = scene_["sensor"]["film"]["height"] = 4;
        scene_["sensor"]["sampler"]["type"] = "independent";
        scene_["floor"]["bsdf"]["reflectance"] = {{"type", "bitmap"}, {"filename", "floor.png"}};
        scene_["wall"] = {
            {"type", "obj"}, {"filename", "wall.obj"}, {"bsdf", {{"$include", "paint.json"}}}};
        scene_["waves"] = json::parse(R"({"type": "heightfield", "filename": "waves.exr",
            "height": 0.01, "to_world": [{"translate": [0, 0, -3]}],
            "bsdf": {"type": "dielectric"}})");
        sweep_ = json::parse(R"({"version": 1, "scenes": ["scene.json"], "spp": 1, "threads": 1,
            "set": {"light": {"pointer": "/light/intensity", "values": [10]}},
            "methods": [{"method": "photonmap", "param": {"emitted": 50}}],
            "indirect": [{"method": "globalphotonmap", "param": {"photons": 20, "gather": 1}}],
            "seeds": [1], "repeats": 1,
            "reference": {"method": "lighttrace", "param": {"paths": 50}, "seed": 1, "spp": 1,
                          "indirect": {"method": "lighttrace", "param": {"paths": 50}}}})");
        paint(80);
        build_wall(1);
        raise_waves(0.5F);
        write_atomic_file(folder_ / "paint.json", R"({"type": "diffuse", "reflectance": 0.5})");
    }

    json& method() { return sweep_["methods"][0]; }
    void paint(unsigned char grey) const {
        write_png(2, 2, std::vector<unsigned char>(12, grey), folder_ / "floor.png");
    }
    void build_wall(int height) const {
        write_atomic_file(folder_ / "wall.obj",
                          fmt::format("v -1 1 0\nv 1 1 0\nv 0 1 {}\nf 1 2 3\n", height));
    }
    void raise_waves(float z) const {
        run_in_child([&](const ChildProcess::Tell&) {
            Film heights(3, 3);
            heights.plane("Y")[4] = z;
            write_exr(heights, folder_ / "waves.exr");
            return std::string();
        });
    }

    /// Plans and runs what the files say now; returns the names of its trials.
    std::set<std::string> run() {
        write_atomic_file(folder_ / "scene.json", scene_.dump());
        write_atomic_file(folder_ / "sweep.json", sweep_.dump());
        const SweepPlan plan = plan_of(folder_ / "sweep.json");
        testing::internal::CaptureStderr();
        const int code = run_sweep(plan, options_);
        said_ = testing::internal::GetCapturedStderr();
        EXPECT_EQ(code, 0) << said_;
        std::set<std::string> all;
        for (const Trial& trial : plan.trials) all.insert(trial.id);
        return all;
    }
    /// When the pictures in the sweep's folder were written.
    std::map<std::string, fs::file_time_type> pictures() const {
        std::map<std::string, fs::file_time_type> all;
        for (const auto& trial : fs::directory_iterator(options_.folder / "trials"))
            all[trial.path().filename()] = fs::last_write_time(trial.path() / "image.exr");
        return all;
    }
    /// Runs the sweep, changes one thing, resumes the sweep; returns how many pictures were rendered for that.
    std::size_t rendered_after(const std::function<void()>& change) {
        run();
        const auto before = pictures();
        change();
        const std::set<std::string> trials = run();
        const auto after = pictures();
        for (const auto& [trial, written] : before) EXPECT_EQ(after.at(trial), written) << trial;
        std::size_t fresh = 0;
        for (const std::string& trial : trials) fresh += before.contains(trial) ? 0 : 1;
        EXPECT_EQ(after.size(), before.size() + fresh);
        return fresh;
    }

    support::TemporaryFolder folder_;
    json scene_, sweep_;
    SweepOptions options_;
    std::string said_;
};

TEST_F(ResumedSweeps, RenderAgainWhateverMakesThePictureIsChanged) {
    const auto reference = [this]() -> json& { return sweep_["reference"]; };
    const std::vector<std::pair<std::string, std::function<void()>>> changes = {
        {"samples a pixel", [&] { sweep_["spp"] = 2; }},
        {"seed", [&] { sweep_["seeds"] = json::array({2}); }},
        {"repeat", [&] { sweep_["repeats"] = 2; }},
        {"parameter of the method", [&] { method()["param"]["emitted"] = 51; }},
        {"parameter that had its default", [&] { method()["param"]["max_bounces"] = 9; }},
        {"parameter of the indirect method", [&] { sweep_["indirect"][0]["param"]["gather"] = 2; }},
        {"indirect method", [&] { sweep_["indirect"][0] = {{"method", "none"}}; }},
        {"method", [&] { method() = {{"method", "none"}}; }},
        {"the reference's parameter", [&] { reference()["param"]["paths"] = 51; }},
        {"the reference's seed", [&] { reference()["seed"] = 2; }},
        {"the reference's samples a pixel", [&] { reference()["spp"] = 2; }},
        {"the reference's indirect light", [&] { reference()["indirect"]["param"]["paths"] = 51; }},
        {"value set by the sweep", [&] { sweep_["set"]["light"]["values"] = json::array({11}); }},
        {"value of the scene", [&] { scene_["ball"]["radius"] = 0.41; }},
        {"size of the picture", [&] { scene_["sensor"]["film"]["width"] = 5; }},
        {"view", [&] { scene_["sensor"]["fov"] = 51; }},
        {"further object", [&] { scene_["ambient"] = json::parse(R"({"type": "ambient"})"); }},
        {"content of a texture", [&] { paint(81); }},
        {"content of a mesh", [&] { build_wall(2); }},
        {"content of a heightfield", [&] { raise_waves(0.25F); }},
        {"content of an included file",
         [&] {
             write_atomic_file(folder_ / "paint.json",
                               R"({"type": "diffuse", "reflectance": 0.6})");
         }},
        {"way in which a texture is read",
         [&] { scene_["floor"]["bsdf"]["reflectance"]["filter_type"] = "nearest"; }}};
    for (const auto& [what, change] : changes) {
        SCOPED_TRACE(what);
        SetUp();
        EXPECT_EQ(rendered_after(change), 1U);
    }
    SetUp();
    EXPECT_EQ(rendered_after([&] { sweep_.erase("reference"); }), 1U);
}

TEST_F(ResumedSweeps, RenderNothingAgainForWhatMakesNoPicture) {
    const std::vector<std::pair<std::string, std::function<void()>>> changes = {
        {"nothing", [] {}},
        {"threads", [&] { sweep_["threads"] = 2; }},
        {"spelling of a number", [&] { method()["param"]["emitted"] = 5e1; }},
        {"suffix of a number", [&] { method()["param"]["emitted"] = "0.05k"; }},
        {"suffix of the indirect method's number",
         [&] { sweep_["indirect"][0]["param"]["photons"] = "0.02k"; }},
        {"file that is written again", [&] { paint(80); }}};
    for (const auto& [what, change] : changes) {
        SCOPED_TRACE(what);
        SetUp();
        EXPECT_EQ(rendered_after(change), 0U);
    }
}

// Pictures stay when the program is built anew: most changes change none. The user is told, and --force renders them again.
TEST_F(ResumedSweeps, TellOfPicturesByOtherCode) {
    const std::string trial = *run().begin();
    const fs::path record = options_.folder / "trials" / trial / "record.json";
    json kept = json::parse(read_whole_file(record));
    kept["code_version"] = "0.0.1 (another)";
    write_atomic_file(record, kept.dump());
    run();
    EXPECT_NE(said_.find("results by other code than this program's"), std::string::npos) << said_;
    EXPECT_NE(said_.find("1 by 0.0.1 (another) (--force runs them again)"), std::string::npos)
        << said_;
    options_.force = true;
    run();
    EXPECT_NE(json::parse(read_whole_file(record)).at("code_version"), "0.0.1 (another)");
}

// Another hash would run every kept sweep again, so a change of it is made by raising record_version.
TEST_F(ResumedSweeps, NameTrialsAsEver) {
    const fs::path sweep = folder_ / "ever.json";
    write_atomic_file(sweep, fmt::format(R"({{"version": 1, "spp": 4, "seeds": [7], "repeats": 2,
        "scenes": ["{}/tests/experiments/scenes/ball.json"],
        "methods": [{{"method": "lighttrace", "param": {{"paths": 123}}}}],
        "reference": {{"method": "lighttrace", "param": {{"paths": 1000}}, "spp": 9}}}})",
                                         CAUSTICS_SOURCE_DIR));
    const SweepPlan plan = plan_of(sweep);
    ASSERT_EQ(plan.trials.size(), 2U);
    EXPECT_EQ(plan.trials[0].reference->key, "ff38630c912daf2e");
    EXPECT_EQ(plan.trials[1].id, "ball-lighttrace-paths123-s7-r2-6dc381f9d03d370a");
}

}  // namespace
}  // namespace caustics::experiments
