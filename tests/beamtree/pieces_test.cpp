#include "beamtree/beams/pieces.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "core/base/parallel.h"
#include "core/math/rng.h"

namespace caustics::beamtree {
namespace {

// Numbers joined at random by several threads make up the sets of a search along the pairs, named by their least.
TEST(Pieces, AreTheConnectedNumbers) {
    constexpr std::uint32_t count = 20'000;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs(count - count / 8);
    Rng rng(1, Stage::test, 0);
    for (auto& [a, b] : pairs) {
        a = rng.next_word() % count;
        b = (a + rng.next_word() % 100) % count;
    }
    std::vector<std::uint32_t> least(count);
    std::iota(least.begin(), least.end(), 0U);
    for (bool changed = true; changed;) {
        changed = false;
        for (const auto& [a, b] : pairs) {
            const std::uint32_t both = std::min(least[a], least[b]);
            changed = changed || least[a] != both || least[b] != both;
            least[a] = least[b] = both;
        }
    }
    for (const int threads : {1, 4}) {
        Pieces pieces(count);
        parallel_chunks(threads, pairs.size(), 16, [&](const Chunk& chunk) {
            for (std::size_t i = chunk.first; i < chunk.end; ++i)
                pieces.join(pairs[i].first, pairs[i].second);
        });
        for (std::uint32_t i = 0; i < count; ++i) EXPECT_EQ(pieces.find(i), least[i]);
    }
}

}  // namespace
}  // namespace caustics::beamtree
