#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <thread>

#include "core/render/film.h"
#include "experiments/base/file_io.h"
#include "tests/cli/program.h"
#include "tests/support/temporary_folder.h"

namespace caustics::experiments {
namespace {

using nlohmann::json;
using support::causticbench;
using support::ProgramResult;
namespace fs = std::filesystem;

const std::string swept_scene = CAUSTICS_SOURCE_DIR "/tests/experiments/scenes/ball.json";

class Runner : public testing::Test {
protected:
    std::string write_sweep(const std::string& methods) {
        const fs::path file = folder_ / "sweep.json";
        write_atomic_file(file, fmt::format(R"({{"version": 1, "scenes": ["{}"], "spp": 1,
                                               "methods": {}}})",
                                            swept_scene, methods));
        return file;
    }
    std::vector<std::string> arguments(const std::string& file,
                                       const std::vector<std::string>& more = {}) {
        std::vector<std::string> all = {"sweep", file, "-o", out_};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    ProgramResult sweep(const std::string& file, const std::vector<std::string>& more = {}) {
        return causticbench(arguments(file, more));
    }
    /// The lines of records.jsonl.
    std::vector<json> rows() const {
        std::istringstream in(read_whole_file(fs::path(out_) / "records.jsonl"));
        std::vector<json> all;
        for (std::string line; std::getline(in, line);) all.push_back(json::parse(line));
        return all;
    }
    std::string log_of(const json& row) const {
        return read_whole_file(fs::path(out_) / "trials" / row.at("trial").get<std::string>() /
                               "log.txt");
    }
    /// Until the program has written a file of the results.
    void wait_for(support::Program& program, const std::string& file) const {
        while (!fs::exists(fs::path(out_) / file)) {
            ASSERT_FALSE(program.has_ended());
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    }
    support::TemporaryFolder folder_;
    std::string out_ = folder_ / "out";
};

const std::string endless = R"([{"method": "photonmap", "param": {"emitted": 2000000000}}])";

TEST_F(Runner, MakesARowOfATrialThatHangs) {
    const ProgramResult result = sweep(write_sweep(endless), {"--timeout", "0.5"});
    EXPECT_EQ(result.exit_code, 1) << result.err;
    const json row = rows().at(0);
    EXPECT_EQ(row.at("status"), "timeout");
    EXPECT_EQ(row.at("message"), "no result after 0.5 s");
    EXPECT_EQ(row.at("timeout_s"), 0.5);
    EXPECT_NE(log_of(row).find("timeout: no result after 0.5 s"), std::string::npos);
    EXPECT_GE(row.at("elapsed_s"), 0.5);
    EXPECT_NE(result.err.find("log.txt"), std::string::npos) << "failures name their log at once";
}

// Without a time limit, so that a slow machine comes to the memory, too.
TEST_F(Runner, MakesARowOfATrialThatEatsMemory) {
    const std::string file = folder_ / "sweep.json";
    write_atomic_file(file, fmt::format(R"({{"version": 1, "scenes": ["{}"], "spp": 1,
        "set": {{"film": {{"pointer": "/sensor/film", "values": [
            {{"type": "hdrfilm", "width": 4, "height": 4}},
            {{"type": "hdrfilm", "width": 11000, "height": 11000}}]}}}},
        "methods": [{{"method": "none"}}]}})",
                                        swept_scene));
    const ProgramResult result = sweep(file, {"--memory", "200"});
    EXPECT_EQ(result.exit_code, 1) << result.err;
    const std::vector<json> table = rows();
    ASSERT_EQ(table.size(), 2U);
    EXPECT_EQ(table[0].at("status"), "done");
    const json& hungry = table[1];
    EXPECT_EQ(hungry.at("status"), "failed");
    EXPECT_EQ(hungry.at("message"), "took more than 200 MiB of memory");
    EXPECT_EQ(hungry.at("memory_limit_bytes"), 200 << 20);
    EXPECT_NE(log_of(hungry).find("failed: took more than"), std::string::npos);
}

// Failures of one kind do not make up for those of another: one finds no memory for its picture, the other has too little
// time to come to it. (On a machine so slow that the first takes too long as well, two do.)
TEST_F(Runner, FailsWhereAsManyTrialsFailAsTakeTooLong) {
    const std::string file = folder_ / "sweep.json";
    write_atomic_file(file, fmt::format(R"({{"version": 1, "scenes": ["{}"], "spp": 1,
        "set": {{"film": {{"pointer": "/sensor/film", "values": [
            {{"type": "hdrfilm", "width": 11000, "height": 11000}}]}}}},
        "methods": [{{"method": "none"}},
                    {{"method": "photonmap", "param": {{"emitted": 2000000000}}}}]}})",
                                        swept_scene));
    const ProgramResult result = sweep(file, {"--memory", "200", "--timeout", "1"});
    EXPECT_EQ(result.exit_code, 1) << result.err;
    ASSERT_EQ(rows().size(), 2U);
    for (const json& row : rows()) EXPECT_NE(row.at("status"), "done");
    EXPECT_EQ(rows()[1].at("status"), "timeout");
}

// By records whose times are known: ended, running and waiting trials.
TEST_F(Runner, TellsHowLongTheOthersWillTake) {
    const std::string quick = R"({"method": "lighttrace", "param": {"paths": [100, 200]}})";
    const auto pretend_it_took = [&](const std::string& file, double seconds) {
        ASSERT_EQ(sweep(file, {"--filter", "method=none"}).exit_code, 0);
        for (const json& row : rows()) {
            const fs::path record =
                fs::path(out_) / "trials" / row.at("trial").get<std::string>() / "record.json";
            json changed = json::parse(read_whole_file(record));
            changed["elapsed_s"] = seconds;
            write_atomic_file(record, changed.dump());
        }
    };
    // Before the first has ended nothing is known; then the second takes what the first took, next to nothing.
    const ProgramResult unknown = sweep(write_sweep("[" + quick + "]"));
    EXPECT_NE(unknown.err.find(", ETA 0:00\n"), std::string::npos) << unknown.err;
    EXPECT_EQ(unknown.err.find("ETA -"), std::string::npos) << unknown.err;

    // The first of two is like the one of 1,000 s before, then the second like the mean of both.
    out_ = folder_ / "mean";
    const std::string same = write_sweep(R"([{"method": "none"}, )" + quick + "]");
    pretend_it_took(same, 1000);
    const ProgramResult mean = sweep(same);
    EXPECT_NE(mean.err.find("[2/3] "), std::string::npos) << mean.err;
    EXPECT_EQ(mean.err.find("ETA -"), std::string::npos) << mean.err;
    EXPECT_EQ(mean.err.find("ETA 16:"), std::string::npos) << mean.err;

    // While one of 500 s by that mean is at work, half of what is left for two at once is 4:10.
    out_ = folder_ / "running";
    const std::string long_one = write_sweep(
        R"([{"method": "none"}, {"method": "photonmap", "param": {"emitted": 2000000000}}, )" +
        quick + "]");
    pretend_it_took(long_one, 1000);
    support::Program program(arguments(long_one, {"--jobs", "2"}));
    while (std::ranges::count_if(fs::directory_iterator(fs::path(out_) / "trials"),
                                 [](const fs::directory_entry& trial) {
                                     return fs::exists(trial.path() / "record.json");
                                 }) < 3)
        ASSERT_FALSE(program.has_ended());
    program.signal(SIGTERM);
    const std::string lines = program.wait().err;
    EXPECT_NE(lines.find(", ETA 4:"), std::string::npos) << lines;
}

/// What a sweep writes on a terminal.
std::string on_terminal(const std::string& arguments) {
    return support::shell("export P; script -qec \"$P sweep " + arguments + "\" /dev/null").out;
}

// The done share of what is at work, and what goes on beside it; while no trial has ended nothing is known of the time.
TEST_F(Runner, KeepsALineOnATerminalUpToDate) {
    const std::string file =
        write_sweep(R"([{"method": "photonmap", "param": {"emitted": [4000000, 4000001]}}])");
    const std::string shown = on_terminal("'" + file + "' -o '" + out_ + "' --jobs 2");
    EXPECT_TRUE(std::regex_search(shown, std::regex("ETA -, [1-9][0-9]? % "))) << shown;
    EXPECT_NE(shown.find(" and 1 "), std::string::npos) << shown;
}

// By its done share; of the trials after it nothing is known.
TEST_F(Runner, TellsHowLongAReferenceWillTake) {
    const std::string file = folder_ / "sweep.json";
    write_atomic_file(file, fmt::format(R"({{"version": 1, "scenes": ["{}"], "spp": 1,
        "methods": [{{"method": "none"}}],
        "reference": {{"method": "lighttrace", "param": {{"paths": 4000000}}}}}})",
                                        swept_scene));
    const std::string shown = on_terminal("'" + file + "' -o '" + out_ + "'");
    const std::regex line("ETA at least ([0-9]+):([0-9]+), [1-9][0-9]? % ref");
    std::vector<int> seconds;
    for (std::sregex_iterator at(shown.begin(), shown.end(), line), end; at != end; ++at)
        seconds.push_back(60 * std::stoi((*at)[1]) + std::stoi((*at)[2]));
    ASSERT_FALSE(seconds.empty()) << shown;
    EXPECT_GE(seconds.front(), seconds.back()) << "it falls";
}

TEST_F(Runner, KeepsOtherRunnersOutUntilItEnds) {
    const std::string file = write_sweep(endless);
    support::Program first(arguments(file));
    wait_for(first, "plan.json");
    const ProgramResult second = sweep(file);
    EXPECT_EQ(second.exit_code, 2);
    EXPECT_NE(
        second.err.find(fmt::format("another runner works on it (process {} on ", first.id())),
        std::string::npos)
        << second.err;
    EXPECT_EQ(sweep(file, {"--list"}).exit_code, 0) << "looking is allowed";
    first.signal(SIGKILL);
    first.wait();
    const ProgramResult third = sweep(file, {"--timeout", "0.1"});
    EXPECT_EQ(third.exit_code, 1) << third.err;
    EXPECT_EQ(rows().at(0).at("status"), "timeout");
}

TEST_F(Runner, DropsTheTrialAtWorkWhenAskedToStop) {
    support::Program program(arguments(write_sweep(endless)));
    wait_for(program, "environment.json");
    program.signal(SIGTERM);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    program.signal(SIGTERM);  // as timeout(1) does
    EXPECT_EQ(program.wait().exit_code, 130);
    EXPECT_TRUE(fs::is_empty(fs::path(out_) / "trials"));
}

TEST_F(Runner, TellsWhatItWouldDo) {
    const std::string file = write_sweep(
        R"([{"method": "none"}, {"method": "photonmap", "param": {"photons": [10, 20, 30]}}])");
    const ProgramResult before = sweep(file, {"--dry-run", "--shard", "1/2"});
    EXPECT_EQ(before.exit_code, 0) << before.err;
    EXPECT_NE(before.out.find("2 planned in shard 1/2; 2 to run\n"), std::string::npos)
        << before.out;
    EXPECT_NE(before.out.find("time       unknown"), std::string::npos) << before.out;
    EXPECT_FALSE(fs::exists(out_));

    EXPECT_EQ(sweep(file, {"--filter", "photons=20", "--filter", "photons=30"}).exit_code, 0);
    ASSERT_EQ(rows().size(), 2U);
    const ProgramResult after = sweep(file, {"--dry-run"});
    EXPECT_NE(after.out.find("4 planned, 2 done; 2 to run\n"), std::string::npos) << after.out;
    EXPECT_NE(after.out.find("from 2 earlier records"), std::string::npos) << after.out;

    EXPECT_EQ(sweep(file, {"--filter", "method=none"}).exit_code, 0);
    EXPECT_EQ(rows().size(), 3U) << "the table keeps what other filters chose";
    EXPECT_EQ(sweep(file, {"--jobs", "2"}).exit_code, 0);
    EXPECT_EQ(rows().size(), 4U);
}

TEST_F(Runner, WarnsOfResultsByOtherCodeAndRunsBrokenOnesAgain) {
    const std::string file = write_sweep(R"([{"method": "none"}])");
    ASSERT_EQ(sweep(file).exit_code, 0);
    const fs::path record =
        fs::path(out_) / "trials" / rows()[0].at("trial").get<std::string>() / "record.json";
    json changed = json::parse(read_whole_file(record));
    changed["code_version"] = "0.0.1 (older)";
    write_atomic_file(record, changed.dump());
    const ProgramResult warned = sweep(file);
    EXPECT_EQ(warned.exit_code, 0);
    EXPECT_NE(warned.err.find("1 by 0.0.1 (older)"), std::string::npos) << warned.err;

    write_atomic_file(record, changed.dump().substr(0, 100));
    const ProgramResult again = sweep(file);
    EXPECT_EQ(again.exit_code, 0);
    EXPECT_NE(again.err.find("broken record"), std::string::npos) << again.err;
    EXPECT_EQ(rows()[0].at("status"), "done");
}

TEST_F(Runner, RunsBrokenRecordsAgainAndNamesThem) {
    const std::string file = write_sweep(R"([{"method": "none"}])");
    ASSERT_EQ(sweep(file).exit_code, 0);
    const fs::path record =
        fs::path(out_) / "trials" / rows()[0].at("trial").get<std::string>() / "record.json";
    const json good = json::parse(read_whole_file(record));
    const std::vector<std::pair<std::string, json>> changes = {
        {"trial", 16}, {"status", "interrupted"}, {"status", 1e-10}, {"seed", "1"}};
    for (const auto& [key, value] : changes) {
        json changed = good;
        changed[key] = value;
        write_atomic_file(record, changed.dump());
        const ProgramResult again = sweep(file);
        EXPECT_EQ(again.exit_code, 0) << again.err;
        EXPECT_NE(again.err.find("note: " + record.string() + ": broken record (/" + key),
                  std::string::npos)
            << again.err;
        EXPECT_EQ(rows()[0].at("status"), "done");
    }
}

TEST_F(Runner, GoesOnWithoutPicturesThatAreGone) {
    const std::string file = folder_ / "sweep.json";
    write_atomic_file(file,
                      fmt::format(R"({{"version": 1, "scenes": ["{}"], "spp": 1, "seeds": [1, 2],
        "methods": [{{"method": "photonmap", "param": {{"emitted": 100}}}}],
        "reference": {{"method": "lighttrace", "param": {{"paths": 100}}}}}})",
                                  swept_scene));
    ASSERT_EQ(sweep(file).exit_code, 0);
    const std::vector<json> before = rows();
    for (const json& row : before)
        fs::remove(fs::path(out_) / "trials" / row.at("trial").get<std::string>() / "image.exr");
    const ProgramResult kept = sweep(file);
    EXPECT_EQ(kept.exit_code, 0);
    EXPECT_EQ(kept.err, "") << "the table and the figures know all";
    EXPECT_EQ(rows(), before);

    fs::remove(fs::path(out_) / ".table");
    fs::remove_all(fs::path(out_) / "report");
    const ProgramResult lacking = sweep(file, {"--rerun", "failed"});
    EXPECT_EQ(lacking.exit_code, 0);
    EXPECT_NE(lacking.err.find("note: the variance of 1 cell stays empty"), std::string::npos)
        << lacking.err;
    EXPECT_NE(lacking.err.find("note: the figures of 1 cell are not drawn"), std::string::npos)
        << lacking.err;
    for (const json& row : rows()) {
        EXPECT_EQ(row.at("status"), "done");
        EXPECT_TRUE(row.at("variance").is_null());
    }
    EXPECT_EQ(sweep(file, {"--force"}).exit_code, 0) << "brings them back";
    EXPECT_EQ(rows()[0].at("variance"), before[0].at("variance"));
}

TEST_F(Runner, WarnsOfTrialsThatAreNotInTheTable) {
    const std::string first =
        write_sweep(R"([{"method": "photonmap", "param": {"photons": [10, 20]}}])");
    ASSERT_EQ(sweep(first).exit_code, 0);
    const std::string other = folder_ / "other.json";
    write_atomic_file(other, fmt::format(R"({{"version": 1, "scenes": ["{}"], "spp": 1,
                                             "methods": [{{"method": "none"}}]}})",
                                         swept_scene));
    const ProgramResult result = sweep(other);
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(rows().size(), 1U);
    EXPECT_NE(
        result.err.find("warning: " + out_ + " holds 2 trials that " + other + " does not name"),
        std::string::npos)
        << result.err;
    EXPECT_NE(result.err.find("the plan before was of " + first), std::string::npos) << result.err;
    EXPECT_NE(result.out.find("records.csv (without 2 trials of other sweeps)\n"),
              std::string::npos)
        << result.out;
    const ProgramResult both = causticbench({"sweep", first, other, "-o", out_});
    EXPECT_EQ(both.err.find("warning"), std::string::npos) << both.err;
    EXPECT_EQ(rows().size(), 3U);
}

TEST_F(Runner, ExplainsHowToMakeATrialAgain) {
    const std::string file = folder_ / "sweep.json";
    write_atomic_file(file, fmt::format(R"({{"version": 1, "scenes": ["{}"], "spp": 4, "seeds": [7],
        "set": {{"glass": {{"pointer": "/ball/bsdf/int_ior", "values": [1.3]}},
                 "kind": {{"pointer": "/ball/bsdf", "values": [{{"type": "dielectric"}}]}}}},
        "methods": [{{"method": "photonmap", "param": {{"photons": 100, "filter": "cone"}}}}]}})",
                                        swept_scene));
    ASSERT_EQ(sweep(file).exit_code, 0);
    const std::string id = rows()[0].at("trial");
    const ProgramResult result =
        causticbench({"explain", out_, rows()[0].at("config_hash").get<std::string>()});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(std::system(fmt::format("cd '{}' && ({}) 2>/dev/null", fs::current_path().string(),
                                      result.out)
                              .c_str()),
              0)
        << result.out;
    const Film again = read_exr(id + ".exr");
    fs::remove(id + ".exr");
    const Film first = read_exr(fs::path(out_) / "trials" / id / "image.exr");
    for (const Plane& plane : first.planes()) EXPECT_EQ(*again.find(plane.channel), plane.values);
    EXPECT_EQ(causticbench({"explain", out_, "absent"}).exit_code, 2);
}

TEST_F(Runner, ExplainsTrialsThatLoadPhotonMapsFromWhereverItIsAsked) {
    const auto run = [&](const std::string& line) {
        return support::shell(
            fmt::format("cd '{}'; S='{}'; {}", folder_.path().string(), swept_scene, line));
    };
    for (const std::string seed : {"1", "2"})
        ASSERT_EQ(run("$P render $S --spp 1 --method photonmap --param photons=100 --param "
                      "save=caustic" +
                      seed +
                      " --indirect globalphotonmap --indirect-param "
                      "photons=100 --indirect-param save=all" +
                      seed + " --seed " + seed + " -o a.exr")
                      .exit_code,
                  0);
    write_atomic_file(folder_ / "sweep.json",
                      fmt::format(R"({{"version": 1, "scenes": ["{}"], "spp": 1,
        "methods": [{{"method": "photonmap", "param": {{"load": "caustic1"}}}}],
        "indirect": [{{"method": "globalphotonmap", "param": {{"load": "all1"}}}}]}})",
                                  swept_scene));
    ASSERT_EQ(run("$P sweep sweep.json -o out; mkdir elsewhere").exit_code, 0);
    const ProgramResult again = run("cd elsewhere; $P explain ../out ball > line && sh line");
    ASSERT_EQ(again.exit_code, 0) << again.err;
    const std::string id = rows().at(0).at("trial");
    const Film first = read_exr(fs::path(out_) / "trials" / id / "image.exr");
    const Film second = read_exr(folder_ / ("elsewhere/" + id + ".exr"));
    for (const Plane& plane : first.planes()) EXPECT_EQ(*second.find(plane.channel), plane.values);

    const std::string same = read_whole_file(folder_ / "elsewhere/line");
    EXPECT_EQ(same.find("gives another picture"), std::string::npos) << same;
    for (const std::string map : {"caustic", "all"}) {
        const ProgramResult changed = run("cp " + map + "1 kept; cp " + map + "2 " + map +
                                          "1; $P explain out ball; mv kept " + map + "1");
        EXPECT_NE(changed.out.find("# the command below gives another picture: a file that its "
                                   "method reads has changed since\n"),
                  std::string::npos)
            << map << changed.out << changed.err;
    }
}

}  // namespace
}  // namespace caustics::experiments
