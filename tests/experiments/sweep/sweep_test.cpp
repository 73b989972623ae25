#include "experiments/sweep/sweep.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <functional>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/scene/scene_reader.h"
#include "experiments/base/file_io.h"
#include "experiments/plan/sweep_selection.h"
#include "experiments/plan/trial_store.h"
#include "tests/experiments/sweep/plan_of.h"
#include "tests/experiments/terminal.h"
#include "tests/support/temporary_folder.h"

namespace caustics::experiments {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

const std::string lighttrace_reference =
    R"(, "reference": {"method": "lighttrace", "param": {"paths": 50}})";
const std::string no_caustic = R"("methods": [{"method": "none"}])";
const std::string endless =
    R"("methods": [{"method": "photonmap", "param": {"emitted": 2000000000}}])";

/// Sweeps over pictures of 4 x 4 pixels of a ball, in children of this process.
class RunSweeps : public testing::Test {
protected:
    void SetUp() override {
        scene_ =
            json::parse(read_whole_file(CAUSTICS_SOURCE_DIR "/tests/experiments/scenes/ball.json"));
        scene_["sensor"]["film"]["width"] = scene_["sensor"]["film"]["height"] = 4;
        options_.folder = folder_ / "out";
    }
    /// Plans a sweep with these members.
    void plan(const std::string& members) {
        write_atomic_file(folder_ / "ball.json", scene_.dump());
        write_atomic_file(folder_ / "sweep.json",
                          R"({"version": 1, "scenes": ["ball.json"], "spp": 1, )" + members + "}");
        plan_ = plan_of(folder_ / "sweep.json");
    }
    /// Returns the exit code; what was told is in `said_`.
    int sweep() {
        testing::internal::CaptureStderr();
        int code = -1;
        try {
            code = run_sweep(plan_, options_);
        } catch (const std::exception& error) {
            ADD_FAILURE() << error.what();
        }
        said_ = testing::internal::GetCapturedStderr();
        return code;
    }
    bool says(const std::string& words) const { return said_.find(words) != std::string::npos; }
    TrialStore store() const { return TrialStore(options_.folder); }
    std::string status_of_record(const Trial& trial) const {
        const auto record = store().record(trial.id);
        return record ? record->at("status").get<std::string>() : "none";
    }
    std::size_t count(const std::string& status) const {
        return static_cast<std::size_t>(std::ranges::count_if(
            plan_.trials, [&](const Trial& trial) { return status_of_record(trial) == status; }));
    }
    /// A file where the folder of references has to be.
    void leave_no_place_for_references() const {
        fs::create_directories(options_.folder);
        fs::remove_all(options_.folder / "references");
        write_atomic_file(options_.folder / "references", "");
    }
    /// Has the trials judged by path tracing, which finds no caustic of a point light.
    void take_a_reference_that_cannot_serve() {
        for (Trial& trial : plan_.trials) {
            ReferenceRequest& reference = *trial.reference;
            reference.request.method = parse_method("pathtrace", parameters_node({}));
            reference.key = run_in_child([&](const ChildProcess::Tell&) {
                const SceneFile file = load_scene(reference.request.scene_file, {});
                return reference_key(reference.request, file, reference_version(Scene(file.desc)));
            });
        }
    }

    support::TemporaryFolder folder_;
    json scene_;
    SweepPlan plan_;
    SweepOptions options_;
    std::string said_;
};

TEST_F(RunSweeps, RenderReferencesAloneWhenAsked) {
    plan(no_caustic + lighttrace_reference);
    options_.only_references = true;
    EXPECT_EQ(sweep(), 0) << said_;
    EXPECT_TRUE(
        fs::exists(options_.folder / "references" / (plan_.trials[0].reference->key + ".exr")));
    EXPECT_EQ(count("none"), 1U);
    leave_no_place_for_references();
    EXPECT_EQ(sweep(), 1);
    EXPECT_TRUE(says("failed: reference " + plan_.trials[0].reference->key)) << said_;
}

TEST_F(RunSweeps, LeaveToDoTheTrialsOfAReferenceThatFailed) {
    plan(no_caustic + lighttrace_reference + R"(,
        "set": {"glass": {"pointer": "/ball/bsdf/int_ior", "values": [1.3, 1.4, 1.5]}})");
    Trial& unjudged = plan_.trials[1];
    unjudged.reference.reset();
    leave_no_place_for_references();
    options_.fail_fast = true;
    EXPECT_EQ(sweep(), 1);
    EXPECT_EQ(count("none"), 3U) << "stopped at the first failure";
    options_.fail_fast = false;
    EXPECT_EQ(sweep(), 1);
    EXPECT_TRUE(says("1 trials of this reference are left to do")) << said_;
    EXPECT_EQ(count("none"), 2U);
    EXPECT_EQ(status_of_record(unjudged), "done");
    fs::remove(options_.folder / "references");
    EXPECT_EQ(sweep(), 0) << said_;
    EXPECT_EQ(count("done"), 3U);
    // What is done stays, where no other picture can be made to judge it by.
    leave_no_place_for_references();
    options_.references = ReferencePolicy::rebuild;
    EXPECT_EQ(sweep(), 1);
    EXPECT_TRUE(says("no trial waits for it; what was there of it stays")) << said_;
    EXPECT_EQ(count("done"), 3U);
}

TEST_F(RunSweeps, FailTheTrialsOfAReferenceThatCannotServe) {
    plan(no_caustic + lighttrace_reference + R"(, "seeds": [1, 2])");
    take_a_reference_that_cannot_serve();
    options_.fail_fast = true;
    EXPECT_EQ(sweep(), 1);
    EXPECT_EQ(count("failed"), 1U) << "and none after it";
    options_.fail_fast = false;
    EXPECT_EQ(sweep(), 1);
    EXPECT_EQ(count("failed"), 2U);
    const json record = *store().record(plan_.trials[0].id);
    EXPECT_TRUE(record.at("message").get<std::string>().starts_with("reference: ")) << record;
    EXPECT_TRUE(says("1 trials failed or took too long before")) << said_;
}

TEST_F(RunSweeps, KeepErrorsOfPicturesThatAreGone) {
    plan(no_caustic + lighttrace_reference + R"(, "seeds": [1, 2])");
    ASSERT_EQ(sweep(), 0) << said_;
    const fs::path reference =
        options_.folder / "references" / (plan_.trials[0].reference->key + ".exr");
    run_in_child([&](const ChildProcess::Tell&) {
        Film film = read_exr(reference);
        for (float& value : film.plane("caustic.R")) value = 2 * value + 1;
        write_exr(film, reference);
        return std::string();
    });
    const std::string& gone = plan_.trials[1].id;
    fs::remove(store().image_of(gone));
    const json before = *store().record(gone);
    EXPECT_EQ(sweep(), 0) << said_;
    EXPECT_TRUE(says("warning: " + gone +
                     ": was judged by another picture of its reference, and its own is not there "
                     "any more"))
        << said_;
    EXPECT_TRUE(says("note: 1 trials were judged by other pictures of their references")) << said_;
    EXPECT_EQ(*store().record(gone), before);
}

// The ball fills the picture, and light tracing reaches nothing behind glass.
TEST_F(RunSweeps, TellNoErrorWhereNoPixelCounts) {
    scene_["sensor"]["fov"] = 2;
    scene_["sensor"]["to_world"] =
        json::parse(R"([{"look_at": {"origin": [0, -3, 2], "target": [0, 0, 0.6],
                                     "up": [0, 0, 1]}}])");
    plan(no_caustic + lighttrace_reference);
    EXPECT_EQ(sweep(), 0) << said_;
    EXPECT_TRUE(store().record(plan_.trials[0].id)->at("metrics").at("rmse").is_null());
    EXPECT_TRUE(says(plan_.trials[0].id + ": done, ")) << said_;
}

TEST_F(RunSweeps, ShowHowManyTrialsAreAtWork) {
    plan(endless + R"(, "seeds": [1, 2])");
    options_.trials.jobs = 2;
    options_.trials.threads = static_cast<int>(own_processors().size());
    options_.trials.timeout = 0.25;
    Terminal terminal(200);
    EXPECT_EQ(run_sweep(plan_, options_), 1);
    const std::string written = terminal.text();
    EXPECT_NE(written.find(" and 1 more"), std::string::npos) << written;
    EXPECT_NE(written.find("warning: 2 trials at a time share "), std::string::npos) << written;
    EXPECT_EQ(count("timeout"), 2U);
}

TEST_F(RunSweeps, TellNoTimeWhileThatOfATrialAtWorkIsNotKnown) {
    plan(R"("methods": [{"method": "none"},
                        {"method": "photonmap", "param": {"emitted": 2000000000}}])");
    plan_.trials[0].scene_hash = "of another scene";
    options_.trials.jobs = 2;
    options_.trials.timeout = 0.25;
    EXPECT_EQ(sweep(), 1);
    EXPECT_EQ(status_of_record(plan_.trials[0]), "none");
    EXPECT_EQ(status_of_record(plan_.trials[1]), "timeout");
    const std::size_t left = said_.find("; it is left to do, ETA ");
    ASSERT_NE(left, std::string::npos) << said_;
    // A machine may be so slow that the other trial has ended before.
    if (left < said_.find(plan_.trials[1].id)) {
        EXPECT_TRUE(says("; it is left to do, ETA -\n")) << said_;
    }
}

TEST_F(RunSweeps, StopAtTheFirstFailureOfALongList) {
    std::string seeds = "1";
    for (int seed = 2; seed <= 105; ++seed) seeds += fmt::format(", {}", seed);
    plan(no_caustic + R"(, "seeds": [)" + seeds + "]");
    const std::string third = run_order(plan_)[2]->id;
    for (Trial& trial : plan_.trials)
        if (trial.id == third) trial.scene_hash = "of another scene";
    options_.fail_fast = true;
    EXPECT_EQ(sweep(), 1);
    EXPECT_TRUE(says(third + ": left: ")) << said_;
    EXPECT_EQ(count("done"), 2U);
    EXPECT_EQ(count("none"), 103U);
}

TEST_F(RunSweeps, EndWhereATrialsPictureCannotBeWritten) {
    plan(no_caustic);
    const TrialStore into = store();
    into.prepare();
    ReferenceCache references(options_.folder / "references", ReferencePolicy::keep);
    TrialRunner runner(into, references, options_.trials);
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
    auto* const usual = std::signal(SIGXFSZ, SIG_IGN);  // as the program does
    const rlimit nothing{0, before.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &nothing), 0);
    runner.start(plan_.trials[0]);
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
    std::signal(SIGXFSZ, usual);
    try {
        while (!runner.running().empty()) runner.wait();
        FAIL() << status_of_record(plan_.trials[0]);
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("image.exr: cannot be written"), std::string::npos)
            << error.what();
    }
}

}  // namespace
}  // namespace caustics::experiments
