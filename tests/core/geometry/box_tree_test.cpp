#include "core/geometry/box_tree.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/math/rng.h"

namespace caustics {
namespace {

Box random_box(Rng& rng, float most_size) {
    const Vec3 corner(rng.next(), rng.next(), rng.next());
    const Vec3 size(rng.next(), rng.next(), rng.next());
    return {corner, corner + most_size * size};
}

std::vector<Box> random_boxes(std::size_t count, float most_size) {
    Rng rng(1, Stage::test, count);
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < count; ++i) boxes.push_back(random_box(rng, most_size));
    return boxes;
}

std::vector<std::uint32_t> met(const BoxTree& tree, const Box& box) {
    std::vector<std::uint32_t> all;
    EXPECT_FALSE(tree.any_at(box, [&](std::uint32_t i) {
        all.push_back(i);
        return false;
    }));
    std::ranges::sort(all);
    return all;
}

std::vector<std::uint32_t> met_by_brute_force(const std::vector<Box>& boxes, const Box& box) {
    std::vector<std::uint32_t> all;
    for (std::uint32_t i = 0; i < boxes.size(); ++i)
        if (boxes[i].intersects(box)) all.push_back(i);
    return all;
}

TEST(BoxTree, FindsWhatBruteForceFinds) {
    for (const std::size_t count : {0U, 1U, 4U, 5U, 100U, 2000U}) {
        const std::vector<Box> boxes = random_boxes(count, 0.2F);
        const BoxTree tree(boxes);
        Rng rng(2, Stage::test, count);
        for (int i = 0; i < 200; ++i) {
            const Box box = random_box(rng, i % 2 == 0 ? 0.01F : 0.5F);
            EXPECT_EQ(met(tree, box), met_by_brute_force(boxes, box)) << count << " " << i;
        }
    }
}

TEST(BoxTree, TakesBoxesAtOnePlace) {
    const std::vector<Box> boxes(100, Box(Vec3::Zero(), Vec3::Ones()));
    const BoxTree tree(boxes);
    EXPECT_EQ(met(tree, Box(Vec3::Ones(), Vec3(2, 2, 2))).size(), boxes.size());
    EXPECT_EQ(met(tree, Box(Vec3(1.1F, 0, 0), Vec3(2, 2, 2))).size(), 0U);
}

TEST(BoxTree, EndsWithTheFirstThatFits) {
    const std::vector<Box> boxes = random_boxes(100, 1);
    int asked = 0;
    EXPECT_TRUE(BoxTree(boxes).any_at(Box(Vec3::Zero(), Vec3(2, 2, 2)),
                                      [&](std::uint32_t) { return ++asked == 3; }));
    EXPECT_EQ(asked, 3);
}

}  // namespace
}  // namespace caustics
