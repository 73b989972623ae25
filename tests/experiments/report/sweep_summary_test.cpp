#include "experiments/report/sweep_summary.h"

#include <gtest/gtest.h>

namespace caustics::experiments {
namespace {

const std::vector<std::string> columns = {"scene",
                                          "method",
                                          "status",
                                          "alpha",
                                          "photons",
                                          "width",
                                          "rmse",
                                          "total_s",
                                          "peak_rss_bytes",
                                          "reference_stderr",
                                          "mean_ratio",
                                          "reference",
                                          "unreached_fraction"};
const std::vector<std::string> swept = {"alpha", "width", "photons"};

/// A row of the scene ring with one film size, judged by the reference of its alpha where that is reached.
TableRow row(const std::string& alpha, const std::string& photons, const std::string& rmse,
             const std::string& unreached = "0") {
    return {columns,
            {"ring", "photonmap", "done", alpha, photons, "64", rmse, "1.5", "72740864", "0.01",
             "1", "lighttrace:" + alpha, unreached}};
}

std::string text(const std::vector<TableRow>& rows) {
    SweepSummary summary(swept);
    for (const TableRow& each : rows) summary.add(each);
    return summary.text(rows.size(), rows.size(), 3);
}

TEST(SweepSummary, ErrorsOfOneReferenceAloneAreComparedForTheBest) {
    const std::string told = text({row("1", "1000", "0.2"), row("1", "10000", "0.1"),
                                   row("0.1", "1000", "0.9"), row("0.1", "10000", "0.7")});
    EXPECT_NE(told.find("ring, alpha 1: 0.1 (photonmap, photons 10000)\n"), std::string::npos)
        << told;
    EXPECT_NE(told.find("ring, alpha 0.1: 0.7 (photonmap, photons 10000)\n"), std::string::npos)
        << told;
}

TEST(SweepSummary, ErrorsOverOtherPixelsAreNotCompared) {
    const std::string told =
        text({row("1", "1000", "0.2"), row("1", "10000", "0.1"), row("1", "1000", "0.09", "0.25"),
              row("1", "10000", "0.05", "0.25")});
    for (const char* best :
         {"ring: 0.1 (photonmap, photons 10000)\n", "ring: 0.05 (photonmap, photons 10000)\n"})
        EXPECT_NE(told.find(best), std::string::npos) << told;
}

// A few pixels more or less that no particle met.
TEST(SweepSummary, ASeedsOwnUnreachedPixelsMakeNoOtherSetting) {
    const std::string told =
        text({row("1", "1000", "0.2", "0.2011"), row("1", "1000", "0.1", "0.1998")});
    EXPECT_NE(told.find("best RMSE  ring: 0.1 (photonmap)\nenergy"), std::string::npos) << told;
}

TEST(SweepSummary, WhatIsTheSameEverywhereIsLeftOut) {
    const std::string told = text({row("1", "1000", "0.2"), row("1", "10000", "0.1")});
    EXPECT_NE(told.find("best RMSE  ring: 0.1 (photonmap, photons 10000)\n"), std::string::npos)
        << told;
}

TEST(SweepSummary, ManySettingsAreCountedAndNotListed) {
    std::vector<TableRow> rows;
    for (int i = 0; i < 40; ++i) rows.push_back(row(std::to_string(100 + i), "1000", "0.5"));
    const std::string told = text(rows);
    EXPECT_NE(told.find("and 28 more settings"), std::string::npos) << told;
}

TEST(SweepSummary, MemoryIsInMiB) {
    const std::string told = text({row("1", "1000", "0.2")});
    EXPECT_NE(told.find("peak memory 69.37 to 69.37 MiB"), std::string::npos) << told;
}

TEST(SweepSummary, ASweepWithoutReferenceSaysSoInWords) {
    const std::vector<std::string> fields = {"ring", "photonmap", "done", "1", "1000", "64", "",
                                             "1.5",  "72740864",  "",     "",  "",     ""};
    const std::string told = text({TableRow(columns, fields)});
    EXPECT_NE(told.find("errors     none: the sweep has no reference"), std::string::npos) << told;
    EXPECT_EQ(told.find("best RMSE"), std::string::npos) << told;
    EXPECT_EQ(told.find("energy"), std::string::npos) << told;
    EXPECT_NE(told.find("time       a trial takes 1.5 to 1.5 s"), std::string::npos) << told;
    EXPECT_EQ(told.find(" -\n"), std::string::npos) << told;
}

TEST(SweepSummary, ASweepWithoutADoneTrialSaysSoInWords) {
    const std::vector<std::string> fields = {"ring", "photonmap", "failed", "1", "1000", "64", "",
                                             "",     "",          "",       "",  "",     ""};
    EXPECT_NE(text({TableRow(columns, fields)}).find("errors     none: no trial is done\n"),
              std::string::npos);
    EXPECT_NE(text({}).find("trials     0 planned: none;"), std::string::npos);
}

}  // namespace
}  // namespace caustics::experiments
