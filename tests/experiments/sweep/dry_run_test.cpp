#include "experiments/sweep/dry_run.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "experiments/base/environment.h"
#include "experiments/base/file_io.h"
#include "experiments/sweep/sweep_status.h"
#include "tests/support/temporary_folder.h"

namespace caustics::experiments {
namespace {

using nlohmann::json;

/// A plan of some trials of one cell and a folder with records of some of them.
class DryRuns : public testing::Test {
protected:
    void SetUp() override { options_.folder = folder_.path(); }
    void plan(const std::vector<std::string>& ids) {
        for (const std::string& id : ids) {
            Trial& trial = plan_.trials.emplace_back();
            trial.id = trial.config_hash = id;
            trial.cell = "cell";
        }
    }
    /// A record of this code, with more members.
    void record(const std::string& id, const std::string& status, const json& more = {}) {
        store_.prepare();
        write_atomic_file(store_.begin(id) / "image.exr", std::string(500'000, 'x'));
        json all = {{"trial", id},
                    {"status", status},
                    {"threads", 1},
                    {"isa", name(options_.trials.isa)},
                    {"code_version", code_version()},
                    {"elapsed_s", status == "done" ? 2.0 : 100.0}};
        if (!more.is_null()) all.merge_patch(more);
        store_.commit(id, all);
    }
    SweepStatus status() const { return sweep_status(plan_, options_, store_); }
    /// The rest of a line of dry_run() after its first word.
    std::string told(const std::string& first_word) const {
        const std::string text = "\n" + dry_run(plan_, options_);
        const std::size_t start = text.find("\n" + first_word + " ");
        if (start == std::string::npos) return "nothing";
        const std::size_t from = text.find_first_not_of(' ', start + 1 + first_word.size());
        return text.substr(from, text.find('\n', from) - from);
    }

    support::TemporaryFolder folder_;
    TrialStore store_{folder_.path()};
    SweepPlan plan_;
    SweepOptions options_;
};

TEST_F(DryRuns, CountTrialsByWhatBecameOfThem) {
    plan({"a", "b", "c", "d", "e"});
    EXPECT_EQ(told("trials"), "5 planned; 5 to run");
    EXPECT_EQ(told("time"), "unknown: no trial has run yet (run a few by --filter)");
    record("a", "done");
    record("b", "failed");
    record("c", "timeout");
    record("d", "unsupported");
    EXPECT_EQ(told("trials"), "5 planned, 1 done, 1 unsupported, 1 failed, 1 timeout; 1 to run");
    EXPECT_EQ(told("time"), "about 0:02 with 1 at a time, from 1 earlier records")
        << "what failed tells nothing of it";
    EXPECT_TRUE(told("disk").starts_with("pictures of about 0.5 MB, ")) << told("disk");
    options_.rerun_failed = true;
    EXPECT_TRUE(told("trials").ends_with("; 3 to run"));
    options_.force = true;
    options_.trials.jobs = 2;
    EXPECT_TRUE(told("trials").ends_with("; 5 to run"));
    EXPECT_EQ(told("time"), "about 0:05 with 2 at a time, from 1 earlier records");
    plan_.duplicates = 3;
    EXPECT_TRUE(told("trials").ends_with("; 5 to run (3 more are named twice)"));
}

TEST_F(DryRuns, SayWhatIsNotKnownOfTheTime) {
    plan({"a", "b"});
    record("a", "done");
    plan_.trials[1].reference.emplace();
    plan_.trials[1].reference->key = "key";
    EXPECT_EQ(told("references"), "1 to render");
    EXPECT_EQ(told("time"),
              "about 0:02 with 1 at a time, and that of the references, which is not known, from 1 "
              "earlier records");
    EXPECT_EQ(told("code"), "nothing");
    record("a", "done", {{"code_version", "0.1 (old)"}});
    plan_.trials[1].reference.reset();
    EXPECT_EQ(told("time"),
              "about 0:02 with 1 at a time, from 1 earlier records, some by other "
              "code");
    EXPECT_NE(told("code").find(": 1 by 0.1 (old) (--force"), std::string::npos) << told("code");
}

TEST_F(DryRuns, CountBrokenRecordsThatRunAgain) {
    plan({"a", "b"});
    record("a", "done");
    EXPECT_EQ(told("broken"), "nothing");
    record("b", "done");
    write_atomic_file(store_.record_of("b"), "{");
    EXPECT_EQ(told("broken"), "1 records, run again");
    EXPECT_EQ(told("trials"), "2 planned, 1 done; 1 to run");
}

TEST_F(DryRuns, ListTheShardAlone) {
    plan({"a", "b", "c", "d"});
    record("a", "done");
    record("b", "failed");
    EXPECT_EQ(list_plan(plan_, options_),
              "done         a\nfailed       b\ntodo         c\ntodo         d\n");
    options_.shard = {1, 2};
    const std::string first = list_plan(plan_, options_);
    options_.shard = {2, 2};
    const std::string second = list_plan(plan_, options_);
    EXPECT_EQ(std::ranges::count(first, '\n'), 2);
    EXPECT_EQ(std::ranges::count(second, '\n'), 2);
    for (const char* line : {"done         a\n", "failed       b\n", "todo         c\n"})
        EXPECT_NE(first.find(line) == std::string::npos, second.find(line) == std::string::npos)
            << "each in one of them";
    EXPECT_TRUE(told("trials").starts_with("2 planned in shard 2/2"));
}

TEST_F(DryRuns, NameTheReferencesThatAreMadeAnew) {
    plan({"a", "b"});
    for (Trial& trial : plan_.trials) {
        trial.reference.emplace();
        trial.reference->key = "key";
        record(trial.id, "done");
    }
    std::filesystem::create_directories(folder_ / "references");
    write_atomic_file(folder_ / "references/key.exr", "picture");
    EXPECT_EQ(told("references"), "0 to render");
    options_.references = ReferencePolicy::rebuild;
    EXPECT_EQ(told("references"), "1 to render") << "although no trial is to be run";
    EXPECT_EQ(told("trials"), "2 planned, 2 done; 0 to run");
    std::filesystem::remove(folder_ / "references/key.exr");
    options_.references = ReferencePolicy::keep;
    EXPECT_EQ(told("references"), "0 to render") << "none asks for it";
}

TEST_F(DryRuns, WarnOfTimesThatDoNotCompare) {
    const auto warning = [&] { return status().times_warning(options_); };
    plan({"a", "b"});
    record("a", "done");
    EXPECT_EQ(warning(), "");
    plan_.trials[1].threads = 2;
    EXPECT_EQ(warning(), "") << "the sweep file says so itself";
    options_.trials.threads = 4;
    EXPECT_TRUE(warning().starts_with("trials of 1 and 4 threads are in one table")) << warning();
    record("a", "done", {{"isa", "another"}});
    EXPECT_TRUE(warning().starts_with("trials of 1 and 4 threads, another and ")) << warning();
    record("a", "done", {{"isa", "another"}, {"threads", nullptr}});
    EXPECT_TRUE(status().threads.empty());
    EXPECT_TRUE(warning().starts_with("trials of another and ")) << warning();
    record("b", "done");
    EXPECT_EQ(warning(), "") << "nothing is left to run";
}

}  // namespace
}  // namespace caustics::experiments
