#include "experiments/plan/trial_store.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <set>

#include "core/base/error.h"
#include "experiments/base/file_io.h"
#include "tests/experiments/refusal.h"
#include "tests/support/temporary_folder.h"

namespace caustics::experiments {
namespace {

namespace fs = std::filesystem;

/// Writes a trial with a file of that content beside the record.
void add(const TrialStore& store, const std::string& id, const std::string& status) {
    write_atomic_file(store.begin(id) / "log.txt", status);
    store.commit(id, {{"trial", id}, {"status", status}});
}

std::string log_of(const TrialStore& store, const std::string& id) {
    return read_whole_file(store.folder_of(id) / "log.txt");
}

class JobStores : public testing::Test {
protected:
    void SetUp() override { store_.prepare(); }
    std::set<std::string> entries() const {
        std::set<std::string> names;
        for (const auto& entry : fs::directory_iterator(folder_ / "trials"))
            names.insert(entry.path().filename());
        return names;
    }
    support::TemporaryFolder folder_;
    TrialStore store_{folder_.path()};
};

TEST_F(JobStores, KeepWholeTrials) {
    EXPECT_FALSE(store_.record("a-1"));
    add(store_, "a-1", "failed");
    add(store_, "a-1", "done");
    EXPECT_EQ(store_.record("a-1")->at("status"), "done");
    EXPECT_EQ(log_of(store_, "a-1"), "done");
    EXPECT_EQ(entries(), std::set<std::string>{"a-1"});
    store_.begin("b-2");
    store_.drop("b-2");
    store_.remove("a-1");
    EXPECT_TRUE(entries().empty());
}

TEST_F(JobStores, RemoveWhatAKilledProcessLeft) {
    write_atomic_file(store_.begin("a-1") / "record.json", "{");
    EXPECT_FALSE(store_.record("a-1"));
    store_.prepare();
    EXPECT_TRUE(entries().empty());
}

TEST_F(JobStores, BringBackWhatAKilledProcessWasAboutToReplace) {
    add(store_, "a-1", "done");
    add(store_, "b-2", "done");
    // Killed between the two renames, and between the second and the removal.
    fs::rename(folder_ / "trials/a-1", folder_ / "trials/.old-a-1");
    fs::copy(folder_ / "trials/b-2", folder_ / "trials/.old-b-2");
    write_atomic_file(folder_ / "trials/.old-b-2/log.txt", "older");
    store_.prepare();
    EXPECT_EQ(entries(), (std::set<std::string>{"a-1", "b-2"}));
    EXPECT_EQ(log_of(store_, "a-1"), "done");
    EXPECT_EQ(log_of(store_, "b-2"), "done");
}

TEST_F(JobStores, SaySoWhenARecordIsBroken) {
    fs::create_directories(folder_ / "trials/a-1");
    for (const char* text :
         {"", "{", "[]", R"({"trial": "b-2", "status": "done"})",
          R"({"trial": 16, "status": "done"})", R"({"trial": "a-1", "status": "interrupted"})",
          R"({"trial": "a-1", "status": 1e-10})", R"({"trial": "a-1"})",
          R"({"trial": null, "status": "done"})", R"({"trial": "a-1", "status": null})",
          R"({"trial": "a-1", "status": "done", "seed": "1"})",
          R"({"trial": "a-1", "status": "done", "seed": -1})",
          R"({"trial": "a-1", "status": "done", "metrics": {"rmse": [1]}})",
          R"({"trial": "a-1", "status": "done", "machine": {"cpu": 1}})",
          R"({"trial": "a-1", "status": "done", "metrics": "x"})",
          R"({"trial": "a-1", "status": "done", "counters": [1]})",
          R"({"trial": "a-1", "status": "done", "mask_metrics": 1})"}) {
        write_atomic_file(folder_ / "trials/a-1/record.json", text);
        EXPECT_THROW(store_.record("a-1"), InputError) << text;
    }
}

/// Whether a sweep would run the trial again, in place of what is there.
bool is_broken(const TrialStore& store, const std::string& id) {
    try {
        store.record(id);
    } catch (const BrokenRecord&) {
        return true;
    } catch (const InputError&) {}
    return false;
}

TEST_F(JobStores, CallNoRecordBrokenThatCannotBeReadNow) {
    add(store_, "a-1", "done");
    add(store_, "b-2", "done");
    write_atomic_file(store_.record_of("b-2"), "{");
    EXPECT_TRUE(is_broken(store_, "b-2"));
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
    const rlimit none{0, before.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &none), 0);
    const bool broken = is_broken(store_, "a-1");
    EXPECT_THROW(store_.record("a-1"), InputError);
    ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
    EXPECT_FALSE(broken);
    const std::string too_long(300, 'a');
    EXPECT_THROW(store_.record(too_long), InputError);
    EXPECT_FALSE(is_broken(store_, too_long));
}

TEST_F(JobStores, TakeNothingElseForARecord) {
    fs::create_directories(folder_ / "trials/a-1/record.json");
    EXPECT_THROW(store_.record("a-1"), InputError) << "a folder";
    fs::remove_all(folder_ / "trials/a-1");
    fs::create_symlink("a-1", folder_ / "trials/a-1");
    EXPECT_THROW(store_.record("a-1"), InputError) << "a link to itself";
    store_.remove("a-1");
    EXPECT_FALSE(store_.record("a-1"));
}

TEST_F(JobStores, NeedAFolderTheyCanWrite) {
    write_atomic_file(folder_ / "file", "");
    EXPECT_THROW(TrialStore(folder_ / "file").prepare(), InputError);
}

TEST_F(JobStores, NameTheFolderThatCannotBeWritten) {
    const std::string too_long(300, 'a');
    const std::string why = ": cannot be written (File name too long)";
    EXPECT_EQ(refusal_of([&] { store_.begin(too_long); }),
              store_.temporary_of(too_long).string() + why);
    EXPECT_EQ(refusal_of([&] { store_.remove(too_long); }),
              store_.folder_of(too_long).string() + why);
    const TrialStore nowhere(folder_ / "nowhere");
    EXPECT_EQ(
        refusal_of([&] { nowhere.begin("a-1"); }),
        nowhere.temporary_of("a-1").string() + ": cannot be written (No such file or directory)");
}

TEST_F(JobStores, CountNothingThatIsUnfinishedAmongTheTrials) {
    add(store_, "a-1", "done");
    store_.begin("b-2");
    fs::create_directories(folder_ / "trials/.old-c-3");
    write_atomic_file(folder_ / "trials/notes.txt", "mine");
    EXPECT_EQ(store_.trials(), std::vector<std::string>{"a-1"});
}

}  // namespace
}  // namespace caustics::experiments
