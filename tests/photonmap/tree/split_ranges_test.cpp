#include "photonmap/tree/split_ranges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <mutex>

namespace caustics::photonmap {
namespace {

/// Numbers first, ..., end - 1.
struct Numbers {
    std::size_t first = 0, end = 0;

    auto operator<=>(const Numbers&) const = default;
};

/// The parts of `count` numbers, in their order.
std::vector<Numbers> parts_of(std::size_t count, int threads) {
    std::vector<Numbers> parts;
    std::mutex mutex;
    split_on_threads(
        Numbers{0, count}, count, threads,
        [](Numbers& range) {
            const Numbers left{range.first, range.first + (range.end - range.first) / 2};
            range.first = left.end;
            return left;
        },
        [&](const Numbers& part) {
            const std::lock_guard lock(mutex);
            parts.push_back(part);
        });
    std::ranges::sort(parts);
    return parts;
}

// Halves down to 32,768 numbers, as long as there are fewer than eight parts a thread.
TEST(SplitOnThreads, MakesPartsThatAreWorthSharingAndNotTooMany) {
    constexpr std::size_t least = 32'768;
    EXPECT_EQ(parts_of(100 * least, 1).size(), 1U);
    EXPECT_EQ(parts_of(2 * least - 1, 2).size(), 1U);
    EXPECT_EQ(parts_of(2 * least, 2).size(), 2U);
    EXPECT_EQ(parts_of(8 * least, 2).size(), 8U);
    EXPECT_EQ(parts_of(1'000 * least, 2).size(), 16U);
    EXPECT_EQ(parts_of(1'000 * least, 3).size(), 32U);
}

TEST(SplitOnThreads, FinishesEveryNumberOnce) {
    for (const int threads : {1, 2, 3})
        for (const std::size_t count : {0U, 1U, 65'537U, 3'000'001U}) {
            std::size_t next = 0;
            for (const Numbers& part : parts_of(count, threads)) {
                EXPECT_EQ(part.first, next);
                next = part.end;
            }
            EXPECT_EQ(next, count) << threads;
        }
}

}  // namespace
}  // namespace caustics::photonmap
