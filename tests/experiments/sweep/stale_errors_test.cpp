#include "experiments/sweep/stale_errors.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "experiments/base/file_io.h"
#include "tests/support/temporary_folder.h"

namespace caustics::experiments {
namespace {

Film even_picture(float grey) {
    Film film(2, 2);
    for (const char* layer : {"", "caustic"})
        for (std::size_t i = 0; i < film.pixel_count(); ++i)
            film.set_rgb(layer, i, Spectrum::Constant(grey));
    return film;
}

/// A trial whose picture is 3 everywhere, and a reference of 2.
class StaleErrorsOfTrials : public testing::Test {
protected:
    void SetUp() override {
        trial_.id = "a";
        store_.prepare();
    }
    /// What is there of the trial.
    void add(bool picture, bool log) {
        const std::filesystem::path folder = store_.begin(trial_.id);
        if (picture) write_exr(even_picture(3), folder / "image.exr");
        if (log) write_atomic_file(folder / "log.txt", "its log");
        store_.commit(trial_.id, {{"trial", "a"},
                                  {"status", "done"},
                                  {"reference", {{"name", "lighttrace:key"}}},
                                  {"metrics", {{"rmse", 9}}}});
    }
    ErrorsAnew take() { return take_errors_anew(trial_, store_, reference_); }
    double rmse() const { return store_.record("a")->at("metrics").at("rmse").get<double>(); }

    support::TemporaryFolder folder_;
    TrialStore store_{folder_.path()};
    Trial trial_;
    Reference reference_{"key", even_picture(2), {2, {}}, {}};
};

TEST_F(StaleErrorsOfTrials, AreTakenAnewOfThePictureThatIsKept) {
    add(true, true);
    EXPECT_EQ(take(), ErrorsAnew::taken);
    EXPECT_EQ(rmse(), 1);
    EXPECT_EQ(store_.record("a")->at("reference").at("mean"), 2);
    EXPECT_EQ(read_whole_file(store_.folder_of("a") / "log.txt"), "its log");
    EXPECT_EQ(read_exr(store_.image_of("a")).rgb("caustic", 0)[0], 3);
}

TEST_F(StaleErrorsOfTrials, AreTakenAnewWithoutALog) {
    add(true, false);
    EXPECT_EQ(take(), ErrorsAnew::taken);
    EXPECT_EQ(rmse(), 1);
    EXPECT_FALSE(std::filesystem::exists(store_.folder_of("a") / "log.txt"));
}

TEST_F(StaleErrorsOfTrials, AreKeptWhereThePictureOrTheRecordIsGone) {
    EXPECT_EQ(take(), ErrorsAnew::picture_is_gone);
    add(false, true);
    EXPECT_EQ(take(), ErrorsAnew::picture_is_gone);
    EXPECT_EQ(rmse(), 9);
    add(true, true);
    std::filesystem::remove(store_.record_of("a"));
    EXPECT_EQ(take(), ErrorsAnew::picture_is_gone);
    EXPECT_FALSE(store_.record("a"));
    EXPECT_TRUE(std::filesystem::exists(store_.image_of("a")));
}

}  // namespace
}  // namespace caustics::experiments
