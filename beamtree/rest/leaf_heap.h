#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/parallel.h"
#include "core/math/vec.h"

namespace caustics::beamtree {

/// A binary tree over items that lie in space: a power of two leaves, each with its share of the items, and the nodes in
/// a heap: the children of i are 2 i and 2 i + 1, the root is 1, leaves come last.

/// The first item of a leaf of so many leaves.
inline std::size_t first_of_leaf(std::size_t leaf, std::size_t items, std::size_t leaves) {
    return leaf * items / leaves;
}

/// Puts items with a `position` into the order of the leaves: halves their number across the longest side, level by level.
template <typename Item>
void sort_into_leaves(std::vector<Item>& items, std::size_t leaves, int threads) {
    // Moves these in place of the items, which are large.
    struct Place {
        Vec3 position;
        std::uint32_t item;
    };
    std::vector<Place> places;
    places.reserve(items.size());
    for (const Item& item : items)
        places.push_back({item.position, static_cast<std::uint32_t>(places.size())});
    const auto at = [&](std::size_t leaf) {
        return places.begin() +
               static_cast<std::ptrdiff_t>(first_of_leaf(leaf, places.size(), leaves));
    };
    for (std::size_t width = leaves; width > 1; width /= 2)
        parallel_chunks(threads, leaves / width, 1, [&](const Chunk& chunk) {
            const std::size_t leaf = chunk.first * width;
            if (at(leaf) == at(leaf + width)) return;
            Vec3 low = at(leaf)->position, high = low;
            for (auto place = at(leaf); place != at(leaf + width); ++place) {
                low = low.cwiseMin(place->position);
                high = high.cwiseMax(place->position);
            }
            Eigen::Index axis = 0;
            (high - low).maxCoeff(&axis);
            std::nth_element(at(leaf), at(leaf + width / 2), at(leaf + width),
                             [axis](const Place& a, const Place& b) {
                                 return a.position[axis] < b.position[axis];
                             });
        });
    std::vector<Item> sorted;
    sorted.reserve(items.size());
    for (const Place& place : places) sorted.push_back(items[place.item]);
    items = std::move(sorted);
}

/// Finds the boxes of a heap's nodes from those of its leaves.
inline void unite(std::vector<Box>& boxes) {
    for (std::size_t i = boxes.size() / 2; i-- > 1;)
        boxes[i] = boxes[2 * i].merged(boxes[2 * i + 1]);
}

/// The boxes of the positions of items that are in the order of the leaves.
template <typename Item>
std::vector<Box> boxes_of_positions(const std::vector<Item>& items, std::size_t leaves) {
    std::vector<Box> boxes(2 * leaves);
    for (std::size_t leaf = 0; leaf < leaves; ++leaf)
        for (std::size_t i = first_of_leaf(leaf, items.size(), leaves);
             i < first_of_leaf(leaf + 1, items.size(), leaves); ++i)
            boxes[leaves + leaf].extend(items[i].position);
    unite(boxes);
    return boxes;
}

/// Calls take(leaf) for each leaf where `touches` holds of its box and of all boxes above it. `stack` is scratch.
template <typename Touches, typename Take>
void for_each_leaf(const std::vector<Box>& boxes, std::vector<std::uint32_t>& stack,
                   const Touches& touches, const Take& take) {
    const std::size_t leaves = boxes.size() / 2;
    stack.assign(1, 1);
    while (!stack.empty()) {
        const std::size_t node = stack.back();
        stack.pop_back();
        if (!touches(boxes[node])) continue;
        if (node >= leaves) {
            take(node - leaves);
            continue;
        }
        stack.push_back(static_cast<std::uint32_t>(2 * node + 1));
        stack.push_back(static_cast<std::uint32_t>(2 * node));
    }
}

}  // namespace caustics::beamtree
