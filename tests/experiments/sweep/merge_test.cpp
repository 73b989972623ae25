#include "experiments/sweep/merge.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "experiments/base/child_process.h"
#include "experiments/base/file_io.h"
#include "experiments/base/folder_lock.h"
#include "experiments/plan/plan_file.h"
#include "experiments/plan/trial_store.h"
#include "tests/support/temporary_folder.h"

namespace caustics::experiments {
namespace {

namespace fs = std::filesystem;

/// Four trials, a to d, in two shards of two.
class Merges : public testing::Test {
protected:
    void SetUp() override {
        for (const char* id : {"a", "b", "c", "d"}) plan_.trials.push_back({id, id, 1, true});
        add(one_, "a");
        add(one_, "c");
        add(two_, "b");
        add(two_, "d");
    }
    void add(const fs::path& folder, const std::string& id, const std::string& code = "1",
             const std::string& isa = "avx2", const std::string& cpu = "fast") {
        const TrialStore store(folder);
        store.prepare();
        write_plan(plan_, folder);
        write_atomic_file(store.begin(id) / "log.txt", "log of " + id);
        store.commit(id, {{"trial", id},
                          {"status", "unsupported"},
                          {"scene", {{"name", "pool"}}},
                          {"method", {{"name", "none"}}},
                          {"swept", {{"key", id}}},
                          {"code_version", code},
                          {"isa", isa},
                          {"machine", {{"cpu", cpu}}}});
    }
    Merged merge_all() { return merge_results({one_, two_}, whole_); }
    std::vector<std::string> merge() { return merge_all().warnings; }
    std::string error() {
        try {
            merge();
        } catch (const InputError& error) {
            EXPECT_FALSE(fs::exists(whole_)) << "whole or absent";
            return error.what();
        }
        return "no error";
    }
    support::TemporaryFolder folder_;
    PlanFile plan_{{}, {"key"}, {"sweep.json"}, {}, "/"};
    fs::path one_ = folder_ / "1";
    fs::path two_ = folder_ / "2";
    fs::path whole_ = folder_ / "whole";
};

TEST_F(Merges, TellWhatCameFromWhere) {
    const fs::path none = folder_ / "3";
    fs::create_directories(none);
    write_plan(plan_, none);
    for (const fs::path& folder : {one_, two_}) {
        fs::create_directories(folder / "references");
        write_atomic_file(folder / "references/key.exr", "picture");
    }
    write_atomic_file(two_ / "references/other.exr", "picture");
    const Merged merged = merge_results({one_, two_, none}, whole_);
    EXPECT_EQ(merged.trials, (std::map<fs::path, std::size_t>{{one_, 2}, {two_, 2}, {none, 0}}));
    EXPECT_EQ(merged.statuses, (std::map<std::string, std::size_t>{{"unsupported", 4}}));
    EXPECT_EQ(merged.references, 2U);
    EXPECT_EQ(merged.repeated_references, 1U);
}

TEST_F(Merges, PutShardsTogether) {
    fs::create_directories(one_ / "references");
    write_atomic_file(one_ / "references/key.exr", "picture");
    write_atomic_file(two_ / "environment.json", R"({"cpu": "fast"})");
    EXPECT_TRUE(merge().empty());
    EXPECT_EQ(read_plan_of(whole_).trials, plan_.trials);
    EXPECT_EQ(nlohmann::json::parse(read_whole_file(whole_ / "environment.json")),
              (nlohmann::json{{"shards", {{{"cpu", "fast"}, {"folder", two_.string()}}}}}));
    for (const char* id : {"a", "b", "c", "d"})
        EXPECT_EQ(read_whole_file(TrialStore(whole_).folder_of(id) / "log.txt"),
                  std::string("log of ") + id);
    EXPECT_EQ(read_whole_file(whole_ / "references/key.exr"), "picture");
    const std::string table = read_whole_file(whole_ / "records.csv");
    EXPECT_EQ(std::ranges::count(table, '\n'), 5);
    EXPECT_LT(table.find("\na,"), table.find("\nb,")) << "in the plan's order";
}

TEST_F(Merges, RefuseGaps) {
    TrialStore(two_).remove("b");
    EXPECT_NE(error().find("plan.json: 1 of the plan's trials are in none of the folders: b"),
              std::string::npos)
        << error();
}

TEST_F(Merges, NameAFewOfManyGaps) {
    for (const char* id : {"e", "f", "g", "h", "i", "j", "k"})
        plan_.trials.push_back({id, id, 1, true});
    for (const fs::path& folder : {one_, two_}) write_plan(plan_, folder);
    EXPECT_TRUE(
        error().ends_with("7 of the plan's trials are in none of the folders: e, f, g, h, "
                          "i and 2 more"))
        << error();
}

TEST_F(Merges, TakeNothingButPicturesFromReferences) {
    for (const fs::path& folder : {one_, two_}) {
        fs::create_directories(folder / "references");
        write_atomic_file(folder / "references/notes.txt", "notes of " + folder.string());
    }
    write_atomic_file(two_ / "references/key.exr", "picture");
    EXPECT_TRUE(merge().empty());
    EXPECT_TRUE(fs::exists(whole_ / "references/key.exr"));
    EXPECT_FALSE(fs::exists(whole_ / "references/notes.txt"));
}

TEST_F(Merges, TakeOneFigureACell) {
    plan_.trials[1].cell = plan_.trials[0].cell;
    for (const auto& [folder, id] :
         {std::pair(one_, "a"), std::pair(two_, "b"), std::pair(two_, "d")}) {
        write_plan(plan_, folder);
        fs::create_directories(folder / "report/figures");
        write_atomic_file(folder / "report/figures" / (std::string(id) + ".png"), id);
    }
    EXPECT_TRUE(merge().empty());
    const fs::path figures = whole_ / "report/figures";
    EXPECT_TRUE(fs::exists(figures / "a.png"));
    EXPECT_FALSE(fs::exists(figures / "b.png")) << "of the cell of a";
    EXPECT_TRUE(fs::exists(figures / "d.png"));
}

TEST_F(Merges, LeaveOutWhatNoFilterChose) {
    plan_.trials[1].chosen = false;
    for (const fs::path& folder : {one_, two_}) write_plan(plan_, folder);
    TrialStore(two_).remove("b");
    EXPECT_TRUE(merge().empty());
}

TEST_F(Merges, RefuseDuplicates) {
    add(two_, "c");
    EXPECT_NE(error().find("c: is in " + one_.string() + " and in " + two_.string()),
              std::string::npos)
        << error();
}

TEST_F(Merges, RefuseOtherCodeAndInstructionSets) {
    add(two_, "b", "2");
    EXPECT_NE(error().find("different code: \"1\" in"), std::string::npos) << error();
    add(two_, "b", "1", "plain");
    EXPECT_NE(error().find("instruction sets: \"avx2\" in"), std::string::npos) << error();
}

TEST_F(Merges, RefuseReferencesThatDiffer) {
    const fs::path first = one_ / "references/key.exr";
    const fs::path second = two_ / "references/key.exr";
    for (const fs::path& file : {first, second}) {
        fs::create_directories(file.parent_path());
        write_atomic_file(file, "picture of " + file.string());
    }
    EXPECT_NE(error().find(first.string() + " and " + second.string() + " are different pictures"),
              std::string::npos)
        << error();
    write_atomic_file(second, read_whole_file(first));
    EXPECT_TRUE(merge().empty());
    EXPECT_EQ(read_whole_file(whole_ / "references/key.exr"), read_whole_file(first));
}

TEST_F(Merges, RefuseTrialsJudgedByDifferentPictures) {
    const auto judge = [](const fs::path& folder, const std::string& id, double mean) {
        const TrialStore store(folder);
        nlohmann::json record = *store.record(id);
        record["reference"] = {{"name", "lighttrace:key"}, {"key", "key"}, {"mean", mean}};
        store.begin(id);
        store.commit(id, record);
    };
    for (const char* id : {"a", "c"}) judge(one_, id, 0.125);
    judge(two_, "b", 0.25);
    EXPECT_NE(error().find("judged by different pictures of the reference lighttrace:key (means "
                           "0.125 and 0.25)"),
              std::string::npos)
        << error();
    judge(two_, "b", 0.125);
    EXPECT_TRUE(merge().empty());
}

TEST_F(Merges, RefuseATargetInsideASource) {
    for (const fs::path& target : {one_ / "trials" / "whole", one_ / "trials" / "a" / "whole"}) {
        whole_ = target;
        EXPECT_NE(error().find("lies inside " + one_.string()), std::string::npos) << error();
    }
}

TEST_F(Merges, WarnOfMixedProcessors) {
    add(two_, "b", "1", "avx2", "slow");
    const std::vector<std::string> warnings = merge();
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings[0].find("\"slow\" in " + two_.string()), std::string::npos) << warnings[0];
}

TEST_F(Merges, WriteNowhereElse) {
    for (const std::string id :
         {"../../out", "/tmp/out", "..", ".", "", "a/b", ".tmp-a", "-a", "a\n"}) {
        plan_.trials[1].id = id;
        for (const fs::path& folder : {one_, two_}) write_plan(plan_, folder);
        EXPECT_NE(error().find("a plain name of a folder, not \"" + id.substr(0, 1)),
                  std::string::npos)
            << error();
    }
}

TEST_F(Merges, FollowNoLinks) {
    const fs::path log = TrialStore(two_).folder_of("b") / "log.txt";
    write_atomic_file(folder_ / "secret", "secret");
    fs::remove(log);
    fs::create_symlink(folder_ / "secret", log);
    EXPECT_NE(error().find(log.string() + ": is a symbolic link"), std::string::npos) << error();
    fs::remove_all(log.parent_path());
    fs::create_directory_symlink(TrialStore(one_).folder_of("a"), log.parent_path());
    EXPECT_NE(error().find("trials/b"), std::string::npos) << error();
}

TEST_F(Merges, NameABrokenFile) {
    for (const char* text : {"{", "[]", ""}) {
        write_atomic_file(two_ / "environment.json", text);
        EXPECT_NE(error().find((two_ / "environment.json").string() + ": broken"),
                  std::string::npos)
            << error();
    }
    fs::remove(two_ / "environment.json");
    const fs::path record = TrialStore(two_).record_of("b");
    write_atomic_file(record, R"({"trial": 16, "status": "done"})");
    EXPECT_NE(error().find(record.string() + ": broken record (/trial: expected text)"),
              std::string::npos)
        << error();
}

TEST_F(Merges, TakeAnyNameOfTheTarget) {
    for (const char* name : {"whole/", "whole//", "./x/../whole"}) {
        merge_results({one_, two_}, folder_ / name);
        EXPECT_TRUE(fs::exists(whole_ / "records.csv")) << name;
        fs::remove_all(whole_);
    }
    fs::create_directory(whole_);
    merge();
    EXPECT_TRUE(fs::exists(whole_ / "records.csv"));
}

TEST_F(Merges, RefuseFoldersThatDoNotBelongTogether) {
    plan_.trials.pop_back();
    write_plan(plan_, two_);
    EXPECT_NE(error().find("not the plan of"), std::string::npos) << error();
    fs::remove(two_ / "plan.json");
    EXPECT_NE(error().find("no results of a sweep"), std::string::npos) << error();
}

TEST_F(Merges, WaitForRunnersToEnd) {
    const fs::path sign = folder_ / "locked";
    const ChildProcess runner([&](const ChildProcess::Tell&) -> std::string {
        const FolderLock lock(two_);
        write_atomic_file(sign, "");
        while (true) pause();
    });
    while (!fs::exists(sign)) usleep(1000);
    EXPECT_NE(error().find(fmt::format("{}: a runner still works on it (process {} on ",
                                       two_.string(), runner.id())),
              std::string::npos)
        << error();
}

TEST_F(Merges, OverwriteNothing) {
    write_atomic_file(folder_ / "whole", "mine");
    EXPECT_THROW(merge(), InputError);
    EXPECT_EQ(read_whole_file(whole_), "mine");
    fs::remove(whole_);
    fs::create_directory(whole_);
    write_atomic_file(whole_ / "notes.txt", "mine");
    EXPECT_THROW(merge(), InputError);
    EXPECT_FALSE(fs::exists(whole_ / "plan.json"));
}

}  // namespace
}  // namespace caustics::experiments
