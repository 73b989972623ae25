#include "experiments/report/record_table.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/render/film.h"
#include "experiments/base/child_process.h"
#include "experiments/base/file_io.h"
#include "experiments/plan/record.h"
#include "experiments/report/trial_rows.h"
#include "tests/support/temporary_folder.h"

namespace caustics::experiments {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

/// Two cells, "x" with the seeds 1 to 3 (trials x1, x2, x3) and "y" with one (y1).
class RecordTables : public testing::Test {
protected:
    void SetUp() override {
        store_.prepare();
        for (const std::uint64_t seed : {1U, 2U, 3U})
            plan_.trials.push_back({fmt::format("x{}", seed), "x", seed, true});
        plan_.trials.push_back({"y1", "y", 1, true});
        for (const char* id : {"x1", "x2", "x3", "y1"}) add(id, 1);
    }
    static void write_picture(const Film& film, const fs::path& file) {
        fs::create_directories(file.parent_path());
        run_in_child([&](const ChildProcess::Tell&) {  // for it may begin threads
            write_exr(film, file);
            return std::string();
        });
    }
    /// A row of pixels of which some are marked `unreached`, where `unreached` is not empty.
    static Film picture(const std::vector<float>& greys, const std::vector<float>& unreached = {}) {
        Film film(static_cast<int>(greys.size()), 1);
        for (std::size_t i = 0; i < greys.size(); ++i)
            film.set_rgb("caustic", i, Spectrum::Constant(greys[i]));
        if (!unreached.empty()) film.plane("unreached.Y") = unreached;
        return film;
    }
    /// Of the second row, in the index.
    void set_offset(std::size_t offset) const {
        json index = json::parse(text(".table"));
        index["rows"][1][2] = offset;
        write_atomic_file(folder_ / ".table", index.dump());
    }
    /// A done trial.
    void add(const std::string& id, const Film& film, const std::string& reference = "") {
        write_picture(film, store_.begin(id) / "image.exr");
        json record = {{"trial", id},
                       {"status", "done"},
                       {"scene", {{"name", "a, \"b\"\nc"}}},
                       {"method", {{"name", "none"}}},
                       {"swept", {{"key", id}}},
                       {"elapsed_s", 0.25},
                       {"picture_hash", fmt::format("{}", film.rgb("caustic", 0)[0])}};
        if (!reference.empty()) record["reference"] = {{"name", "lighttrace:" + reference}};
        store_.commit(id, record);
    }
    void add(const std::string& id, float grey) { add(id, picture({grey})); }
    void write(const std::map<std::string, json>& unfinished = {}) {
        visited_.clear();
        lacks_ = write_records(folder_.path(), store_, plan_, unfinished, [&](const TableRow& row) {
            visited_ += row.text("trial") + " " + row.text("variance") + "\n";
        });
    }
    std::string text(const std::string& file) const { return read_whole_file(folder_ / file); }
    std::string tables() const { return text("records.csv") + text("records.jsonl"); }
    /// What the tables are when nothing is known from before.
    std::string tables_made_anew() {
        fs::remove(folder_ / ".table");
        write();
        return tables();
    }
    std::string stamps() const {
        return file_stamp(folder_ / "records.csv") + file_stamp(folder_ / "records.jsonl");
    }
    std::string variance_of_x() const {
        const std::string lines = text("records.jsonl");
        return json::parse(lines.substr(0, lines.find('\n'))).at("variance").dump();
    }
    support::TemporaryFolder folder_;
    TrialStore store_{folder_.path()};
    PlanFile plan_{{}, {"key"}, {"sweep.json"}, {}, "/"};
    std::string visited_;  ///< trials and their variances
    std::vector<std::string> lacks_;
};

TEST_F(RecordTables, AreLeftAsTheyAreWhenNothingChanged) {
    write();
    const std::string made = stamps();
    const std::string seen = visited_;
    EXPECT_EQ(seen, "x1 0\nx2 0\nx3 0\ny1 \n");
    write();
    EXPECT_EQ(stamps(), made);
    EXPECT_EQ(visited_, seen);
}

TEST_F(RecordTables, NoticeWhateverChanges) {
    const fs::path record = store_.record_of("x2");
    const std::vector<std::pair<std::string, std::function<void()>>> changes = {
        {"a record of the same size and date",
         [&] {
             std::string other = read_whole_file(record);
             other.replace(other.find("0.25"), 4, "0.75");
             struct stat before{};
             ASSERT_EQ(stat(record.c_str(), &before), 0);
             std::FILE* const out = std::fopen(record.c_str(), "r+b");
             std::fwrite(other.data(), 1, other.size(), out);
             std::fclose(out);
             const timespec times[] = {before.st_atim, before.st_mtim};
             ASSERT_EQ(utimensat(AT_FDCWD, record.c_str(), times, 0), 0);
         }},
        {"another trial in its place", [&] { add("x2", 3); }},
        {"a trial is gone", [&] { store_.remove("y1"); }},
        {"it is back", [&] { add("y1", 1); }},
        {"a table that somebody edited",
         [&] { write_atomic_file(folder_ / "records.csv", text("records.csv") + "x\n"); }},
        {"a table that is gone", [&] { fs::remove(folder_ / "records.jsonl"); }},
        {"a table cut short",
         [&] { fs::resize_file(folder_ / "records.csv", text("records.csv").size() - 5); }},
        {"an index cut short", [&] { fs::resize_file(folder_ / ".table", 100); }},
        {"an index by other code",
         [&] {
             json index = json::parse(text(".table"));
             index["code_version"] = "another";
             write_atomic_file(folder_ / ".table", index.dump());
         }},
        {"an index whose offsets lead out of the table", [&] { set_offset(1'000'000'000); }},
        {"an index whose offsets lead into a row", [&] { set_offset(1); }},
        {"an index of other trials' rows",
         [&] {
             json index = json::parse(text(".table"));
             std::swap(index["rows"][0][2], index["rows"][1][2]);
             write_atomic_file(folder_ / ".table", index.dump());
         }},
        {"an index nested so deep that reading it would end the stack",
         [&] {
             write_atomic_file(folder_ / ".table",
                               std::string(1'000'000, '[') + std::string(1'000'000, ']'));
         }},
        {"another order of the plan", [&] { std::swap(plan_.trials[0], plan_.trials[1]); }},
        {"another column", [&] { plan_.swept.emplace_back("other"); }},
        {"a plan of fewer trials", [&] { plan_.trials.pop_back(); }}};
    write();
    for (const auto& [name, change] : changes) {
        const std::string before = stamps();
        change();
        write();
        EXPECT_NE(stamps(), before) << name;
        const std::string made = tables();
        EXPECT_EQ(made, tables_made_anew()) << name;
    }
}

TEST_F(RecordTables, ComputeAVarianceAgainWhenItsPicturesDiffer) {
    write();
    EXPECT_EQ(variance_of_x(), "0.0");
    add("x3", 4);
    write();
    EXPECT_EQ(variance_of_x(), "3.0") << "of 1, 1 and 4";
    add("x1", 1);
    fs::remove(store_.image_of("x2"));
    write();
    EXPECT_EQ(variance_of_x(), "3.0") << "the same pictures need not be read";
    std::erase_if(plan_.trials, [](const auto& trial) { return trial.id == "x2"; });
    write();
    EXPECT_EQ(variance_of_x(), "4.5") << "of 1 and 4, when a seed is no longer in the plan";
}

TEST_F(RecordTables, DoWithoutPicturesThatAreGone) {
    write();
    for (const char* id : {"x1", "x2", "x3", "y1"}) fs::remove(store_.image_of(id));
    store_.remove("y1");  // so that the table is made again
    write();
    EXPECT_EQ(visited_, "x1 0\nx2 0\nx3 0\n") << "what was known stays";
    EXPECT_TRUE(lacks_.empty());
    fs::remove(folder_ / ".table");
    for (int time = 0; time < 2; ++time) {
        write();
        EXPECT_EQ(visited_, "x1 \nx2 \nx3 \n");
        ASSERT_EQ(lacks_.size(), 1U) << "each time";
        EXPECT_NE(lacks_[0].find("variance of 1 cell stays empty"), std::string::npos) << lacks_[0];
        EXPECT_NE(
            lacks_[0].find(store_.image_of("x1").string() + ": cannot be read (no such file)"),
            std::string::npos)
            << lacks_[0];
    }
}

TEST_F(RecordTables, DoWithoutPicturesThatAreBroken) {
    const auto break_picture = [&](int width, const char* layer) {
        run_in_child([&](const ChildProcess::Tell&) {
            Film film(width, 1);
            film.set_rgb(layer, 0, Spectrum::Constant(1));
            write_exr(film, store_.image_of("x2"));
            return std::string();
        });
        fs::remove(folder_ / ".table");
        write();
        ASSERT_EQ(lacks_.size(), 1U);
        EXPECT_NE(lacks_[0].find(store_.image_of("x2").string() + ": "), std::string::npos)
            << lacks_[0];
    };
    break_picture(1, "");
    EXPECT_NE(lacks_[0].find("no layer \"caustic\""), std::string::npos) << lacks_[0];
    break_picture(2, "caustic");
    EXPECT_NE(lacks_[0].find("of another size"), std::string::npos) << lacks_[0];
}

TEST_F(RecordTables, VaryOverThePixelsThatAllPicturesReach) {
    // A pixel's variances: 1 of (1, 2, 3), 12 of (0, 0, 6), 27 of (0, 9, 0), 0 of (5, 5, 5).
    add("x1", picture({1, 0, 0, 5}));
    add("x2", picture({2, 0, 9, 5}));
    add("x3", picture({3, 6, 0, 5}));
    write();
    EXPECT_EQ(variance_of_x(), "10.0");
    add("x1", picture({1, 0, 0, 5}, {0, 0, 0.25F, 0}));
    add("x2", picture({2, 0, 9, 5}, {0, 0, 0, 0}));
    add("x3", picture({4, 6, 0, 5}, {0, 0.5F, 0, 0}));
    write();
    EXPECT_NEAR(std::stod(variance_of_x()), 7.0 / 6, 1e-12)
        << "7/3 of (1, 2, 4), and 0, by two pixels";
}

TEST_F(RecordTables, VaryOverThePixelsThatTheReferenceReaches) {
    const std::string key = "00c0ffee00c0ffee";
    add("x1", picture({1, 0}), key);
    add("x2", picture({2, 0}), key);
    add("x3", picture({3, 6}), key);
    write();
    EXPECT_EQ(variance_of_x(), "null") << "without the reference none knows what counts";
    write_picture(picture({9, 9}, {0, 1}), folder_ / "references" / (key + ".exr"));
    add("y1", 2);
    write();
    EXPECT_EQ(variance_of_x(), "1.0") << "of (1, 2, 3): errors leave the other pixel out";

    fs::create_directories(folder_ / "beside" / "sweeps");
    fs::rename(folder_ / "references", folder_ / "beside" / "references");
    plan_.sweeps = {(folder_ / "beside" / "sweeps" / "sweep.json").string()};
    fs::remove(folder_ / ".table");
    write();
    EXPECT_EQ(variance_of_x(), "1.0") << "a reference kept beside the sweep files";
}

TEST_F(RecordTables, KeepNoRowOfWhatLeftNothing) {
    store_.remove("x2");
    write({{"x2", {{"trial", "x2"}, {"status", "interrupted"}}}});
    EXPECT_EQ(visited_, "x1 0\nx2 \nx3 0\ny1 \n");
    EXPECT_FALSE(TrialRows(folder_.path(), store_).row("x2"));
    write();
    EXPECT_EQ(visited_, "x1 0\nx3 0\ny1 \n");
}

TEST_F(RecordTables, SayWhatTheRecordsSay) {
    const std::vector<std::string> columns = record_columns({});
    const auto rows = [&] {
        const TrialRows all(folder_.path(), store_);
        std::string texts;
        for (const PlanFile::Entry& trial : plan_.trials)
            for (const std::string& column : columns)
                if (column != "variance") texts += all.row(trial.id)->text(column) + "|";
        return texts;
    };
    const std::string from_records = rows();
    write();
    EXPECT_TRUE(TrialRows(folder_.path(), store_).are_the_table_of(plan_));
    EXPECT_EQ(rows(), from_records);
    EXPECT_EQ(TrialRows(folder_.path(), store_).row("x1")->number("elapsed_s"), 0.25);
}

TEST_F(RecordTables, SayWhenARecordIsBroken) {
    write();
    write_atomic_file(store_.record_of("x2"), "{");
    const TrialRows rows(folder_.path(), store_);
    EXPECT_THROW(rows.row("x2"), InputError);
    EXPECT_TRUE(rows.row("x1"));
}

}  // namespace
}  // namespace caustics::experiments
