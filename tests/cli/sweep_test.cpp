#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "core/render/film.h"
#include "experiments/base/file_io.h"
#include "experiments/plan/sweep_plan.h"
#include "experiments/plan/sweep_selection.h"
#include "tests/cli/program.h"
#include "tests/support/temporary_folder.h"

namespace caustics::experiments {
namespace {

using support::causticbench;
using support::ProgramResult;
namespace fs = std::filesystem;

const std::string ball_file = CAUSTICS_SOURCE_DIR "/tests/experiments/scenes/ball.json";

using Row = std::map<std::string, std::string>;

std::vector<std::string> cells(const std::string& line) {
    std::vector<std::string> all;
    bool quoted = false;
    all.emplace_back();
    for (const char c : line) {
        if (c == '"')
            quoted = !quoted;
        else if (c == ',' && !quoted)
            all.emplace_back();
        else
            all.back() += c;
    }
    return all;
}

std::vector<Row> read_rows(const fs::path& file) {
    std::istringstream in(read_whole_file(file));
    std::string line;
    std::getline(in, line);
    const std::vector<std::string> names = cells(line);
    std::vector<Row> rows;
    while (std::getline(in, line)) {
        const std::vector<std::string> values = cells(line);
        EXPECT_EQ(values.size(), names.size()) << line;
        Row row;
        for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = values[i];
        rows.push_back(row);
    }
    return rows;
}

class Sweeps : public testing::Test {
protected:
    std::string write_sweep(const std::string& methods) {
        const fs::path file = folder_ / "sweep.json";
        write_atomic_file(
            file, fmt::format(
                      R"({{"version": 1, "scenes": ["{}"], "spp": 4, "seeds": [1, 2], "methods": {},
                "set": {{"glass": {{"pointer": "/ball/bsdf/int_ior", "values": [1.3, 1.5]}}}},
                "reference": {{"method": "lighttrace", "param": {{"paths": 20000}}, "spp": 4}}}})",
                      ball_file, methods));
        return file;
    }
    ProgramResult sweep(const std::string& file, const std::vector<std::string>& more = {}) {
        std::vector<std::string> arguments = {"sweep", file, "-o", out_};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return causticbench(arguments);
    }
    std::vector<Row> rows() const { return read_rows(fs::path(out_) / "records.csv"); }
    /// Names and times of the trials' records.
    std::map<std::string, fs::file_time_type> records() const {
        std::map<std::string, fs::file_time_type> all;
        for (const auto& entry : fs::directory_iterator(fs::path(out_) / "trials"))
            all[entry.path().filename()] = fs::last_write_time(entry.path() / "record.json");
        return all;
    }

    support::TemporaryFolder folder_;
    std::string out_ = folder_ / "out";
};

const std::string two_methods =
    R"([{"method": "none"}, {"method": "photonmap", "param": {"photons": [500, 1000]}}])";

TEST_F(Sweeps, RecordCountsAndWhyACausticIsEmpty) {
    const std::string file = folder_ / "lamps.json";
    write_atomic_file(file, fmt::format(R"({{"version": 1, "scenes": ["{}"], "spp": 1, "seeds": [1],
        "set": {{"lamp": {{"pointer": "/light/intensity", "values": [0, 10]}}}},
        "methods": [{{"method": "photonmap", "param": {{"emitted": 500}}}}],
        "reference": {{"method": "lighttrace", "param": {{"paths": 500}}}}}})",
                                        ball_file));
    ASSERT_EQ(sweep(file).exit_code, 0);
    const std::vector<Row> table = rows();
    ASSERT_EQ(table.size(), 2U);
    for (const Row& row : table) {
        const bool dark = row.at("lamp") == "0";
        EXPECT_EQ(row.at("photons_emitted"), "500");
        EXPECT_EQ(row.at("photons_aimed") == "0", dark);
        EXPECT_EQ(row.at("photons_refracted") == "0", dark);
        EXPECT_EQ(row.at("lit_points") == "0", dark);
        EXPECT_EQ(row.at("empty_gathers") == row.at("gathers"), dark);
        EXPECT_EQ(row.at("why_empty").find("no light shines towards a caster") == 0, dark);
        EXPECT_EQ(row.at("why_empty").empty(), !dark);
        const fs::path trial = fs::path(out_) / "trials" / row.at("trial");
        EXPECT_EQ(
            read_whole_file(trial / "log.txt").find("the caustic is empty: ") != std::string::npos,
            dark);
        const auto record = nlohmann::json::parse(read_whole_file(trial / "record.json"));
        EXPECT_EQ(record.at("reference").contains("why_empty"), dark);
    }
}

TEST_F(Sweeps, LeaveATableAndPicturesBehind) {
    const ProgramResult result = sweep(write_sweep(two_methods));
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const std::vector<Row> table = rows();
    ASSERT_EQ(table.size(), 2U * 3 * 2);
    for (const Row& row : table) {
        EXPECT_EQ(row.at("status"), "done");
        EXPECT_EQ(row.at("scene"), "ball");
        EXPECT_GT(std::stod(row.at("rmse")), 0);
        EXPECT_GT(std::stod(row.at("total_s")), 0);
        EXPECT_GE(std::stoull(row.at("peak_rss_bytes")), std::stoull(row.at("rss_start_bytes")));
        EXPECT_EQ(row.at("beams"), "");
        EXPECT_TRUE(row.at("glass") == "1.3" || row.at("glass") == "1.5");
        EXPECT_EQ(row.at("reference").rfind("lighttrace:", 0), 0U);
        EXPECT_GT(std::stod(row.at("reference_stderr")), 0);
        const bool none = row.at("method") == "none";
        EXPECT_EQ(row.at("photons").empty(), none);
        EXPECT_EQ(row.at("variance") == "0", none) << "without a caustic all seeds agree";
        const fs::path trial = fs::path(out_) / "trials" / row.at("trial");
        for (const char* file : {"record.json", "image.exr", "log.txt"})
            EXPECT_TRUE(fs::exists(trial / file)) << file;
    }
    std::size_t figures = 0;
    for (const auto& entry : fs::directory_iterator(fs::path(out_) / "report/figures"))
        figures += entry.path().extension() == ".png" ? 1 : 0;
    EXPECT_EQ(figures, 2U * 3) << "one a cell";
    EXPECT_TRUE(fs::exists(fs::path(out_) / "environment.json"));
    EXPECT_EQ(std::ranges::count(result.out, '\n'), 8) << result.out;
}

TEST_F(Sweeps, RecordParametersWhoseNamesAreOtherColumns) {
    const std::string file =
        write_sweep(R"([{"method": "beamtree", "param": {"polygons": ["triangles", "quads"],
                                                        "mesh_resolution": 4}}])");
    ASSERT_EQ(sweep(file, {"--filter", "seed=1", "--filter", "glass=1.5"}).exit_code, 0);
    std::set<std::string> kinds, counts;
    for (const Row& row : rows()) {
        kinds.insert(row.at("method_polygons"));
        counts.insert(row.at("polygons"));
    }
    EXPECT_EQ(kinds, (std::set<std::string>{"triangles", "quads"}));
    EXPECT_EQ(counts.size(), 1U) << "triangles of the casters";
}

TEST_F(Sweeps, SkipWhatIsDone) {
    const std::string file = write_sweep(two_methods);
    ASSERT_EQ(sweep(file, {"--fail-fast"}).exit_code, 0) << "nothing fails";
    const auto before = records();
    const std::string table = read_whole_file(fs::path(out_) / "records.csv");

    EXPECT_EQ(sweep(file).exit_code, 0);
    EXPECT_EQ(records(), before);
    EXPECT_EQ(read_whole_file(fs::path(out_) / "records.csv"), table);

    // A trial that is gone, and one that a killed process had not finished, are run again.
    const std::string gone = before.begin()->first;
    fs::rename(fs::path(out_) / "trials" / gone, fs::path(out_) / "trials" / (".tmp-" + gone));
    EXPECT_EQ(sweep(file).exit_code, 0);
    auto after = records();
    EXPECT_EQ(after.size(), before.size());
    EXPECT_NE(after.at(gone), before.at(gone));
    after[gone] = before.at(gone);
    EXPECT_EQ(after, before);

    EXPECT_EQ(sweep(file, {"--force"}).exit_code, 0);
    for (const auto& [id, time] : records()) EXPECT_NE(time, before.at(id)) << id;
}

TEST_F(Sweeps, MakeARowOfAnUnsupportedPair) {
    const std::string file = write_sweep(R"([{"method": "pathtrace"}, {"method": "none"}])");
    EXPECT_EQ(sweep(file, {"--isa", "plain"}).exit_code, 0);
    int unsupported = 0;
    for (const Row& row : rows()) {
        EXPECT_EQ(row.at("isa"), "plain");
        EXPECT_EQ(row.at("status"), row.at("method") == "none" ? "done" : "unsupported");
        EXPECT_EQ(row.at("status") == "done", row.at("message").empty());
        unsupported += row.at("status") == "unsupported" ? 1 : 0;
    }
    EXPECT_EQ(unsupported, 4);
}

TEST_F(Sweeps, GoOnAfterAFailureAndTryItAgain) {
    const std::string file = write_sweep(R"([{"method": "none"}])");
    const ProgramResult listed = sweep(file, {"--list"});
    EXPECT_EQ(listed.exit_code, 0) << listed.err;
    EXPECT_EQ(std::ranges::count(listed.out, '\n'), 4);
    EXPECT_EQ(listed.out.rfind("todo ", 0), 0U) << listed.out;
    EXPECT_FALSE(fs::exists(out_)) << "listing runs nothing";

    // A reference that cannot be read is not the fault of the two trials of its scene: the same command runs them.
    const std::string key = read_plan({file}).trials[0].reference->key;
    const fs::path broken = fs::path(out_) / "references" / (key + ".exr");
    fs::create_directories(broken.parent_path());
    write_atomic_file(broken, "no picture");
    const ProgramResult result = sweep(file);
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_NE(result.err.find("; it is left to do"), std::string::npos) << result.err;
    for (const Row& row : rows()) EXPECT_EQ(row.at("glass") + row.at("status"), "1.5done");
    EXPECT_EQ(records().size(), 2U);

    fs::remove(broken);
    EXPECT_EQ(sweep(file).exit_code, 0);
    EXPECT_EQ(records().size(), 4U);
    for (const Row& row : rows()) EXPECT_EQ(row.at("status"), "done");
}

TEST_F(Sweeps, LeaveTrialsToDoWhoseReferenceFindsNoRoom) {
    const std::string file = write_sweep(R"([{"method": "none"}])");
    const ProgramResult full =
        support::shell("ulimit -f 4; $P sweep '" + file + "' -o '" + out_ + "'");
    EXPECT_EQ(full.exit_code, 1) << full.err;
    EXPECT_NE(full.err.find("2 trials of this reference are left to do"), std::string::npos)
        << full.err;
    EXPECT_TRUE(records().empty());
    const ProgramResult only =
        support::shell("ulimit -f 4; $P sweep '" + file + "' -o '" + out_ + "' --references only");
    EXPECT_EQ(only.exit_code, 1) << only.err;
    EXPECT_EQ(sweep(file, {"--references", "only"}).exit_code, 0);
    EXPECT_TRUE(records().empty());
    EXPECT_EQ(sweep(file).exit_code, 0);
    EXPECT_EQ(records().size(), 4U);
}

TEST_F(Sweeps, FailWhereNoReferenceCanBeRebuilt) {
    const std::string file = write_sweep(R"([{"method": "none"}])");
    ASSERT_EQ(sweep(file).exit_code, 0);
    const std::vector<Row> before = rows();
    const ProgramResult full = support::shell("ulimit -f 4; $P sweep '" + file + "' -o '" + out_ +
                                              "' --references rebuild");
    EXPECT_EQ(full.exit_code, 1) << full.err;
    EXPECT_NE(full.err.find("what was there of it stays"), std::string::npos) << full.err;
    EXPECT_EQ(sweep(file).exit_code, 0);
    EXPECT_EQ(rows(), before);
}

TEST_F(Sweeps, TakeErrorsAnewWhereTheReferenceIsAnotherPicture) {
    const std::string file = write_sweep(R"([{"method": "photonmap", "param": {"photons": 500}}])");
    ASSERT_EQ(sweep(file).exit_code, 0);
    const std::vector<Row> before = rows();
    for (const auto& entry : fs::directory_iterator(fs::path(out_) / "references")) {
        Film film = read_exr(entry.path());
        for (float& value : film.plane("caustic.R")) value *= 2;
        write_exr(film, entry.path());
    }
    const fs::path record = fs::path(out_) / "trials" / before[0].at("trial") / "record.json";
    nlohmann::json with_flip = nlohmann::json::parse(read_whole_file(record));
    with_flip["flip"] = 0.5;
    write_atomic_file(record, with_flip.dump());
    const ProgramResult again = sweep(file);
    EXPECT_EQ(again.exit_code, 0) << again.err;
    for (const char* note : {"note: 4 trials were judged by other pictures of their references: "
                             "their errors are taken anew",
                             "note: 1 of them have no flip any more"})
        EXPECT_NE(again.err.find(note), std::string::npos) << again.err;
    EXPECT_FALSE(nlohmann::json::parse(read_whole_file(record)).contains("flip"));
    const std::vector<Row> after = rows();
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t i = 0; i < after.size(); ++i) {
        EXPECT_NE(after[i].at("rmse"), before[i].at("rmse"));
        EXPECT_NE(after[i].at("reference_mean"), before[i].at("reference_mean"));
        EXPECT_EQ(after[i].at("elapsed_s"), before[i].at("elapsed_s")) << "was run again";
    }
    EXPECT_EQ(sweep(file).err.find("anew"), std::string::npos);

    // The same errors as of trials that know this picture alone.
    fs::create_directories(folder_ / "fresh");
    fs::copy(fs::path(out_) / "references", fs::path(folder_ / "fresh") / "references",
             fs::copy_options::recursive);
    out_ = folder_ / "fresh";
    ASSERT_EQ(sweep(file).exit_code, 0);
    const std::vector<Row> fresh = rows();
    for (std::size_t i = 0; i < fresh.size(); ++i)
        for (const char* column : {"rmse", "relmse", "mask_rmse", "bias", "reference_mean"})
            EXPECT_EQ(after[i].at(column), fresh[i].at(column)) << column;
}

// All trials are done, so that nothing else asks for it.
TEST_F(Sweeps, NameAReferenceThatIsAnotherOne) {
    const std::string file = write_sweep(R"([{"method": "photonmap", "param": {"photons": 500}}])");
    ASSERT_EQ(sweep(file).exit_code, 0);
    const std::vector<Row> before = rows();
    for (const auto& entry : fs::directory_iterator(fs::path(out_) / "references")) {
        Film film = read_exr(entry.path());
        film.metadata["reference_key"] = "0123456789abcdef";
        write_exr(film, entry.path());
    }
    const ProgramResult again = sweep(file);
    EXPECT_EQ(again.exit_code, 0) << again.err;
    EXPECT_NE(again.err.find("is the reference 0123456789abcdef, renamed (remake it with "
                             "--references rebuild): the errors of its trials are kept"),
              std::string::npos)
        << again.err;
    EXPECT_EQ(rows(), before);
}

TEST_F(Sweeps, WarnWhereThreadsAndInstructionSetsMix) {
    const std::string file = write_sweep(R"([{"method": "none"}])");
    ASSERT_EQ(sweep(file, {"--filter", "seed=1", "--isa", "plain", "--threads", "2"}).exit_code, 0);
    const ProgramResult mixed = sweep(file, {"--isa", "avx2", "--threads", "1"});
    EXPECT_NE(mixed.err.find("warning: trials of 1 and 2 threads, avx2 and plain are in one table"),
              std::string::npos)
        << mixed.err;
}

TEST_F(Sweeps, StopWhenInterruptedAndGoOnLater) {
    const std::string file = write_sweep(
        R"([{"method": "photonmap", "param": {"photons": [500, 1000, 2000, 4000, 300000]}}])");
    const std::vector<std::string> arguments = {"sweep", file, "-o", out_};
    const SweepPlan plan = read_plan({file});
    const std::string first = run_order(plan)[0]->id;
    const ProgramResult stopped = support::interrupted_causticbench(
        arguments, fs::path(out_) / "trials" / first / "record.json");
    EXPECT_EQ(stopped.exit_code, 130) << stopped.err;
    EXPECT_NE(stopped.err.find("interrupted"), std::string::npos) << stopped.err;
    const auto kept = records();
    ASSERT_LT(kept.size(), 20U) << "the signal came too late to show anything";
    std::size_t interrupted = 0;
    for (const Row& row : rows()) interrupted += row.at("status") == "interrupted" ? 1 : 0;
    EXPECT_LE(interrupted, 1U);
    EXPECT_EQ(rows().size(), kept.size() + interrupted);

    ASSERT_EQ(sweep(file).exit_code, 0);
    const auto all = records();
    EXPECT_EQ(all.size(), 20U);
    for (const auto& [id, time] : kept) EXPECT_EQ(all.at(id), time) << id << " was run again";
    for (const Row& row : rows()) EXPECT_EQ(row.at("status"), "done");
}

TEST_F(Sweeps, StopAtTheFirstFailureWhenAsked) {
    const std::string file = write_sweep(R"([{"method": "none"}])");
    const std::string key = read_plan({file}).trials[0].reference->key;
    fs::create_directories(fs::path(out_) / "references");
    write_atomic_file(fs::path(out_) / "references" / (key + ".exr"), "no picture");
    EXPECT_EQ(sweep(file, {"--fail-fast"}).exit_code, 1);
    EXPECT_LT(records().size(), 4U) << "it went on";
}

}  // namespace
}  // namespace caustics::experiments
