#include "core/base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include "core/scene/scene.h"
#include "tests/support/build_scene.h"

namespace caustics {
namespace {

TEST(ParallelFor, RunsEachIndexOnceWithAWorkerBelowTheThreads) {
    for (const int threads : {1, 2, 3, 8})
        for (const std::size_t count : {0U, 1U, 2U, 7U, 1000U}) {
            std::vector<std::atomic<int>> runs(count);
            std::vector<std::atomic<int>> busy(static_cast<std::size_t>(threads));
            std::atomic<bool> right{true};
            parallel_for(threads, count, [&](std::size_t index, std::size_t worker) {
                if (index >= count || worker >= busy.size() || busy[worker]++ != 0) {
                    right = false;
                    return;
                }
                ++runs[index];
                --busy[worker];
            });
            EXPECT_TRUE(right) << threads << " " << count;
            for (const std::atomic<int>& run : runs) EXPECT_EQ(run, 1);
        }
}

TEST(ParallelChunks, CoverAllNumbersOnce) {
    for (const int threads : {1, 3})
        for (const std::size_t count : {0U, 1U, 9U, 10U, 11U, 1000U}) {
            std::vector<std::atomic<int>> runs(count);
            std::vector<std::atomic<int>> chunks(chunk_count(count, 10));
            parallel_chunks(threads, count, 10, [&](const Chunk& chunk) {
                ++chunks.at(chunk.index);
                EXPECT_EQ(chunk.first, 10 * chunk.index);
                EXPECT_EQ(chunk.end, std::min(count, chunk.first + 10));
                for (std::size_t i = chunk.first; i < chunk.end; ++i) ++runs[i];
            });
            for (const std::atomic<int>& run : runs) EXPECT_EQ(run, 1);
            for (const std::atomic<int>& run : chunks) EXPECT_EQ(run, 1);
        }
}

TEST(ParallelFor, TakesNoThreadsAsOne) {
    for (const int threads : {0, -1}) {
        int runs = 0;
        parallel_for(threads, 5, [&](std::size_t, std::size_t worker) {
            EXPECT_EQ(worker, 0U);
            ++runs;
        });
        EXPECT_EQ(runs, 5);
    }
}

TEST(ParallelFor, RethrowsAnExceptionAfterAllHaveStopped) {
    for (const int threads : {1, 2, 4}) {
        std::atomic<int> inside{0};
        EXPECT_THROW(parallel_for(threads, 1000,
                                  [&](std::size_t index, std::size_t) {
                                      ++inside;
                                      if (index == 17) {
                                          --inside;
                                          throw std::out_of_range("17");
                                      }
                                      --inside;
                                  }),
                     std::out_of_range);
        EXPECT_EQ(inside, 0);
    }
}

// All bodies wait for each other, so the loop only ends early if the workers run at once; the
// wait is bounded in tries, not to hang where they do not.
bool workers_meet(int workers) {
    std::atomic<int> arrived{0};
    std::atomic<int> met{0};
    parallel_for(workers, static_cast<std::size_t>(workers), [&](std::size_t, std::size_t) {
        ++arrived;
        for (int i = 0; i < 20'000 && arrived < workers; ++i)
            std::this_thread::sleep_for(std::chrono::microseconds(100));
        if (arrived == workers) ++met;
    });
    return met == workers;
}

TEST(ParallelFor, UsesTwoWorkersAfterASceneWasBuilt) {
    if (available_threads() < 2) GTEST_SKIP() << "one processor";
    EXPECT_TRUE(workers_meet(2));
    SceneDesc desc;
    desc.shapes.push_back(support::sphere("ball", Vec3d::Zero(), 1, support::glass(1.5F)));
    const Scene scene(std::move(desc));
    EXPECT_TRUE(workers_meet(2));
}

TEST(ParallelFor, StartsMoreThreadsThanProcessorsWithoutAWordWhereAskedTo) {
    testing::internal::CaptureStderr();
    EXPECT_TRUE(workers_meet(available_threads() + 3));
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(ParallelFor, RunSingleThreadedRunsItsWorkAndPassesItsException) {
    int runs = 0;
    run_single_threaded([&] { ++runs; });
    EXPECT_EQ(runs, 1);
    EXPECT_THROW(run_single_threaded([] { throw std::runtime_error("inside"); }),
                 std::runtime_error);
    EXPECT_GE(available_threads(), 1);
}

}  // namespace
}  // namespace caustics
