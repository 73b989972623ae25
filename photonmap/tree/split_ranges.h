#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "core/base/parallel.h"

namespace caustics::photonmap {

/// Splits a range of `count` photons into halves, quarters and so on, those of a round side by side on up to `threads`
/// threads, and then calls finish(part) for each, side by side as well. take_left(range) splits off and returns the
/// range's left half. What is done to a part must depend on nothing outside it: then threads make no difference.
template <typename Range, typename TakeLeft, typename Finish>
void split_on_threads(const Range& range, std::size_t count, int threads, const TakeLeft& take_left,
                      const Finish& finish) {
    constexpr std::size_t least_part = 32768;  // a thread's work below that is not worth sharing
    constexpr std::size_t parts_of_a_thread = 8;
    std::vector<Range> parts = {range};
    while (threads > 1 && count / parts.size() >= 2 * least_part &&
           parts.size() < parts_of_a_thread * static_cast<std::size_t>(threads)) {
        std::vector<Range> halves(2 * parts.size());
        parallel_for(threads, parts.size(), [&](std::size_t i, std::size_t) {
            halves[2 * i] = take_left(parts[i]);
            halves[2 * i + 1] = parts[i];
        });
        parts = std::move(halves);
    }
    parallel_for(threads, parts.size(), [&](std::size_t i, std::size_t) { finish(parts[i]); });
}

}  // namespace caustics::photonmap
