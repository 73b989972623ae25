#include "experiments/job_store.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "experiments/files.h"
#include "tests/support/temporary_folder.h"

namespace caustics {
namespace {

namespace fs = std::filesystem;

TrialOutcome outcome(const std::string& status) {
    Film film(2, 2);
    film.set_rgb("", 0, Spectrum::Ones());
    return {{{"trial", "a-1"}, {"status", status}}, film, "log\n"};
}

TEST(JobStore, KeepsWholeTrials) {
    const support::TemporaryFolder folder;
    const JobStore store(folder.path());
    EXPECT_FALSE(store.record("a-1"));
    store.add("a-1", outcome("failed"));
    store.add("a-1", outcome("done"));
    EXPECT_EQ(store.record("a-1")->at("status"), "done");
    EXPECT_TRUE(fs::exists(store.image_of("a-1")));
    std::size_t entries = 0;
    for (const auto& entry : fs::directory_iterator(folder / "trials")) {
        EXPECT_EQ(entry.path().filename(), "a-1");
        ++entries;
    }
    EXPECT_EQ(entries, 1U);
}

TEST(JobStore, RemovesWhatAKilledProcessLeft) {
    const support::TemporaryFolder folder;
    fs::create_directories(folder / "trials/.tmp-a-1-999999999");
    write_whole_file(folder / "trials/.tmp-a-1-999999999/record.json", "{");
    const JobStore store(folder.path());
    EXPECT_FALSE(store.record("a-1"));
    EXPECT_TRUE(fs::is_empty(folder / "trials"));
}

TEST(JobStore, SaysSoWhenARecordIsBroken) {
    const support::TemporaryFolder folder;
    const JobStore store(folder.path());
    fs::create_directories(folder / "trials/a-1");
    for (const char* text : {"{", "[]", R"({"trial": "b-2", "status": "done"})"}) {
        write_whole_file(folder / "trials/a-1/record.json", text);
        EXPECT_THROW(store.record("a-1"), InputError) << text;
    }
}

TEST(JobStore, NeedsAFolderItCanWrite) {
    const support::TemporaryFolder folder;
    write_whole_file(folder / "file", "");
    EXPECT_THROW(JobStore(folder / "file"), InputError);
}

}  // namespace
}  // namespace caustics
