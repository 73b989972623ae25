#include "core/math/rng.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "tests/support/statistics.h"

namespace caustics {
namespace {

using Counter = std::array<std::uint32_t, 4>;
using Key = std::array<std::uint32_t, 2>;

// The three known answers of Random123's distribution for philox4x32-10.
TEST(Rng, PhiloxGivesTheKnownAnswers) {
    EXPECT_EQ(philox4x32({0, 0, 0, 0}, {0, 0}),
              (Counter{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
    const std::uint32_t ones = 0xffffffff;
    EXPECT_EQ(philox4x32({ones, ones, ones, ones}, {ones, ones}),
              (Counter{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
    EXPECT_EQ(
        philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
        (Counter{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Rng, StreamsOfOtherSeedsStagesAndPathsDiffer) {
    std::set<std::uint64_t> seen;
    std::size_t streams = 0;
    for (const std::uint64_t seed : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{1} << 32U})
        for (const Stage stage : {Stage::eye, Stage::photons, Stage::light_trace, Stage::shading})
            for (const std::uint64_t path :
                 {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{1} << 32U}) {
                Rng rng(seed, stage, path);
                const std::uint64_t first = rng.next_word();
                seen.insert(first << 32U | rng.next_word());
                ++streams;
            }
    EXPECT_EQ(seen.size(), streams);
}

// Every bit of a path's and of a seed's number counts.
TEST(Rng, NoBitOfAStreamsNumberIsLost) {
    std::set<std::uint64_t> seen;
    const auto see = [&seen](std::uint64_t seed, std::uint64_t path) {
        Rng rng(seed, Stage::test, path);
        const std::uint64_t first = rng.next_word();
        return seen.insert(first << 32U | rng.next_word()).second;
    };
    EXPECT_TRUE(see(0, 0));
    for (unsigned bit = 0; bit < 64; ++bit) {
        EXPECT_TRUE(see(0, std::uint64_t{1} << bit)) << bit;
        EXPECT_TRUE(see(std::uint64_t{1} << bit, 0)) << bit;
    }
}

TEST(Rng, TheSameStreamRepeats) {
    Rng a(7, Stage::test, 99), b(7, Stage::test, 99);
    for (int i = 0; i < 100; ++i) EXPECT_EQ(a.next_word(), b.next_word());
}

TEST(Rng, NumbersAreEvenlySpreadInTheUnitInterval) {
    constexpr int cells = 64, draws = 200'000;
    std::vector<double> along(cells), across(cells), pairs(cells * cells);
    Rng stream(1, Stage::test, 0);
    for (int i = 0; i < draws; ++i) {
        const float x = stream.next();
        // The first number of consecutive paths must be as good as a stream.
        Rng path(1, Stage::test, static_cast<std::uint64_t>(i));
        const float y = path.next();
        ASSERT_GE(x, 0.0F);
        ASSERT_LT(x, 1.0F);
        const auto cell_x = static_cast<std::size_t>(x * cells);
        const auto cell_y = static_cast<std::size_t>(y * cells);
        along[cell_x] += 1;
        across[cell_y] += 1;
        pairs[cell_x * cells + cell_y] += 1;
    }
    const std::vector<double> each(cells, double{draws} / cells);
    const std::vector<double> each_pair(cells * cells, double{draws} / (cells * cells));
    EXPECT_GT(support::chi_square_p_value(along, each), 1e-3);
    EXPECT_GT(support::chi_square_p_value(across, each), 1e-3);
    EXPECT_GT(support::chi_square_p_value(pairs, each_pair), 1e-3);
}

}  // namespace
}  // namespace caustics
