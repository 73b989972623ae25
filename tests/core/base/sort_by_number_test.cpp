#include "core/base/sort_by_number.h"

#include <gtest/gtest.h>

#include "core/math/rng.h"

namespace caustics {
namespace {

using Pair = std::pair<std::uint32_t, std::uint32_t>;

TEST(SortByNumber, SortsAsAnyOtherSort) {
    Rng rng(1, Stage::test, 0);
    for (const std::size_t count : {0U, 1U, 50U, 20'000U}) {
        std::vector<Pair> items(count);
        for (Pair& item : items) item = {rng.next_word() % 9'000, rng.next_word() % 50};
        std::vector<Pair> expected = items;
        std::sort(expected.begin(), expected.end());
        for (const int threads : {1, 3})
            EXPECT_EQ(sort_by_number(
                          std::span<const Pair>(items), 9'000, threads,
                          [](const Pair& item) { return item.first; },
                          [](const Pair& a, const Pair& b) { return a.second < b.second; }),
                      expected);
    }
}

}  // namespace
}  // namespace caustics
