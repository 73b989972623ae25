#include "beamtree/slices/slice_hierarchy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace caustics::beamtree {
namespace {

// A small square about a place, the same on both planes.
BoxedBeam beam_at(float x, float y, std::size_t number) {
    BoxedBeam beam;
    beam.beam = static_cast<std::uint32_t>(number);
    for (const float side : {-0.005F, 0.005F})
        beam.box.extend({x + side, y + side, x + side, y + side});
    return beam;
}

/// How many beams are in so many even steps of x from 0 to 1.
using Counts = std::vector<std::size_t>;

std::vector<BoxedBeam> beams_along_x(const Counts& counts) {
    std::vector<BoxedBeam> beams;
    for (std::size_t i = 0; i < counts.size(); ++i)
        for (std::size_t k = 0; k < counts[i]; ++k)
            beams.push_back(beam_at(static_cast<float>(i) / static_cast<float>(counts.size() - 1),
                                    0, beams.size()));
    return beams;
}

bool holds_every_beam_once(const Hierarchy& tree) {
    std::vector<std::uint32_t> order = tree.order;
    std::ranges::sort(order);
    std::vector<std::uint32_t> all(order.size());
    std::iota(all.begin(), all.end(), 0U);
    return order == all;
}

TEST(SliceHierarchy, PartsBeamsAtTheGapBetweenThem) {
    for (Counts counts : {Counts{8, 3, 9, 9, 9, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 5},
                          Counts{3, 8, 9, 9, 9, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 5},
                          Counts{9, 9, 9, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 9, 9, 9},
                          Counts{2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 9, 9, 9, 9, 9}})
        for (const bool turned : {false, true}) {
            if (turned) std::ranges::reverse(counts);
            std::vector<BoxedBeam> beams = beams_along_x(counts);
            const auto left = static_cast<std::uint32_t>(
                std::accumulate(counts.begin(), counts.begin() + 8, std::size_t{0}));
            const auto all = static_cast<std::uint32_t>(beams.size());
            const Hierarchy tree = binned_slices(beams, std::max(left, all - left));
            ASSERT_EQ(tree.nodes.size(), 3U) << left << " of " << all;
            EXPECT_EQ(tree.nodes[1].beam_count, left) << "of " << all;
            EXPECT_EQ(tree.nodes[2].beam_count, all - left) << "of " << all;
            EXPECT_TRUE(holds_every_beam_once(tree));
        }
}

// Those that threads part together as well.
TEST(SliceHierarchy, PutsManyBeamsOnTheirSidesOfTheGap) {
    constexpr std::size_t count = 20'000;
    for (const int threads : {1, 2, 3}) {
        std::vector<BoxedBeam> beams;
        for (std::size_t i = 0; i < count; ++i)
            beams.push_back(beam_at(i % 3 == 0 ? 0.0F : 1.0F, 0, i));
        const Hierarchy tree = binned_slices(beams, count - 1, threads);
        ASSERT_EQ(tree.nodes.size(), 3U);
        const auto left = tree.nodes[1].beam_count;
        EXPECT_EQ(left, (count + 2) / 3);
        EXPECT_TRUE(holds_every_beam_once(tree));
        for (std::size_t i = 0; i < count; ++i)
            ASSERT_EQ(tree.order[i] % 3 == 0, i < left) << "with " << threads << " threads";
    }
}

TEST(SliceHierarchy, HalvesBeamsThatCannotBeParted) {
    for (const std::size_t count : {100U, 1000U, 20'000U}) {
        std::vector<BoxedBeam> beams;
        for (std::size_t i = 0; i < count; ++i) beams.push_back(beam_at(0, 0, i));
        const Hierarchy tree = binned_slices(beams, 8);
        EXPECT_TRUE(holds_every_beam_once(tree));
        std::uint32_t halvings = 0;
        while ((std::size_t{8} << halvings) < count) ++halvings;
        EXPECT_EQ(tree.height(), halvings + 1);
    }
}

}  // namespace
}  // namespace caustics::beamtree
