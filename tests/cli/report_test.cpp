#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <set>

#include "experiments/base/file_io.h"
#include "tests/cli/program.h"
#include "tests/support/temporary_folder.h"

namespace caustics::experiments {
namespace {

using support::ProgramResult;
namespace fs = std::filesystem;

/// Where `report` puts its page; what is on it is tests/tooling/report_test.py's business.
class Report : public testing::Test {
protected:
    void SetUp() override {
        write_atomic_file(folder_ / "sweep.json",
                          fmt::format(R"({{"version": 1, "scenes": ["{}/ball.json"], "spp": 1,
                                          "methods": [{{"method": "none"}}]}})",
                                      CAUSTICS_SOURCE_DIR "/tests/experiments/scenes"));
        ASSERT_EQ(run("$P sweep sweep.json -o out").exit_code, 0);
    }
    /// In the test's folder.
    ProgramResult run(const std::string& line) const {
        return support::shell(fmt::format("cd '{}'; {}", folder_.path().string(), line));
    }
    std::set<fs::path> entries() const {
        std::set<fs::path> all;
        for (const auto& entry : fs::recursive_directory_iterator(folder_.path()))
            all.insert(entry.path());
        return all;
    }
    /// In one line, before anything is made.
    void is_refused(const std::string& words, const std::string& why) const {
        const std::set<fs::path> before = entries();
        const ProgramResult result = run("$P report " + words);
        EXPECT_EQ(result.exit_code, 2) << words;
        EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << words << "\n" << result.err;
        EXPECT_NE(result.err.find(why), std::string::npos) << words << "\n" << result.err;
        EXPECT_EQ(entries(), before) << words;
    }
    support::TemporaryFolder folder_;
};

TEST_F(Report, IsPutIntoTheFolderOfResultsOrOneThatIsNamed) {
    if (run("/usr/bin/python3 -c 'import numpy, scipy'").exit_code != 0)
        GTEST_SKIP() << "needs Debian's python3-numpy and python3-scipy";
    fs::create_directory(folder_ / "shelf");
    for (const auto& [words, page] :
         {std::pair("out", "out/report.html"), std::pair("out -o shelf", "shelf/report.html")}) {
        const ProgramResult result = run(std::string("$P report ") + words);
        EXPECT_EQ(result.exit_code, 0) << words << result.err;
        EXPECT_TRUE(fs::is_regular_file(folder_ / page)) << words;
    }
}

TEST_F(Report, TakesTheNameOfAPageAlone) {
    write_atomic_file(folder_ / "page.txt", "precious");
    is_refused("out -o page.txt", "page.txt: pages are written as .html");
    is_refused("out -o page", "page: pages are written as .html");
    is_refused("out -o absent/a.html", "absent");
    is_refused("out other", "-o: name the page to write for several folders");
    EXPECT_EQ(read_whole_file(folder_ / "page.txt"), "precious");
}

TEST_F(Report, ReplacesNoPipeAndNoLink) {
    const std::string pipe = folder_ / "pipe.html";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    fs::create_symlink("elsewhere", folder_ / "link.html");
    is_refused("out -o pipe.html", "pipe.html: is no regular file");
    is_refused("out -o link.html", "link.html: is a symbolic link");
    EXPECT_TRUE(fs::is_fifo(pipe));
    fs::rename(pipe, folder_ / "out/report.html");
    for (const std::string words : {"out", "out -o out"})
        is_refused(words, "out/report.html: is no regular file");
    fs::rename(folder_ / "link.html", folder_ / "out/report.html");
    is_refused("out", "out/report.html: is a symbolic link");
}

TEST_F(Report, RefusesWhatItCannotUseBeforeThePageIsWritten) {
    write_atomic_file(folder_ / "tables", "precious");
    is_refused("out -o a.html --tables tables", "tables: no folder for tables");
    EXPECT_EQ(read_whole_file(folder_ / "tables"), "precious");
    is_refused("out -o a.html --columns=-rmse", "unknown column -rmse");
    is_refused("out -o a.html --tables t --columns rmse,work_s,rmse", "rmse is named twice");
    is_refused("out -o a.html --columns rmse", "--columns: belongs to --tables");
    is_refused("out -o a.html --references absent", "--references absent: no such folder");
    is_refused("out -o a.html --references tables", "--references tables: is no folder");
    is_refused("-o a.html -- -out", "-out: no such folder");
}

}  // namespace
}  // namespace caustics::experiments
