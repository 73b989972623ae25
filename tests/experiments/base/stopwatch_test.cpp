#include "experiments/base/stopwatch.h"

#include <gtest/gtest.h>

namespace caustics::experiments {
namespace {

TEST(Stopwatch, CountsAsWorkWhatIsInPhasesThatEnded) {
    Stopwatch watch;
    EXPECT_EQ(watch.worked().wall, 0);
    watch.begin("a");
    watch.begin("b");
    watch.begin("a");
    watch.stop();
    const Seconds worked = watch.worked();
    EXPECT_GT(worked.wall, 0);
    EXPECT_EQ(worked.wall, watch.of("a").wall + watch.of("b").wall);
    EXPECT_EQ(worked.cpu, watch.of("a").cpu + watch.of("b").cpu);
    while (!(watch.total().wall > 2 * worked.wall)) {}
    EXPECT_EQ(watch.worked().wall, worked.wall);
    watch.begin("c");
    EXPECT_EQ(watch.worked().wall, worked.wall);
}

TEST(Stopwatch, AddsUpAStage) {
    Stopwatch stopwatch;
    for (const char* phase : {"render", "render/tiles", "rendering", "precompute"})
        stopwatch.begin(phase);
    stopwatch.stop();
    EXPECT_DOUBLE_EQ(stopwatch.of_stage("render").wall,
                     stopwatch.of("render").wall + stopwatch.of("render/tiles").wall);
    EXPECT_DOUBLE_EQ(stopwatch.of_stage("precompute").cpu, stopwatch.of("precompute").cpu);
}

}  // namespace
}  // namespace caustics::experiments
