#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/parallel.h"

namespace caustics {

/// Sorts items by a number below `count` that `number(item)` gives, and those of one number by `less`, which must tell
/// apart all that differ: counting, then small sorts on up to `threads` threads. For numbers that few items share.
template <typename Item, typename Number, typename Less>
std::vector<Item> sort_by_number(std::span<const Item> items, std::size_t count, int threads,
                                 const Number& number, const Less& less) {
    std::vector<std::uint32_t> end(count + 1, 0);
    for (const Item& item : items) ++end[number(item) + 1];
    for (std::size_t i = 1; i <= count; ++i) end[i] += end[i - 1];
    std::vector<Item> sorted(items.size());
    for (const Item& item : items) sorted[end[number(item)]++] = item;
    constexpr std::size_t together = 4096;
    parallel_chunks(threads, count, together, [&](const Chunk& chunk) {
        for (std::size_t i = chunk.first; i < chunk.end; ++i) {
            const std::uint32_t first = i == 0 ? 0 : end[i - 1];
            if (end[i] - first > 1)
                std::sort(sorted.begin() + first, sorted.begin() + end[i], less);
        }
    });
    return sorted;
}

}  // namespace caustics
