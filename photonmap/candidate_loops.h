#pragma once

#include "photonmap/kth_smallest.h"
#include "photonmap/tree_kernels.h"

namespace caustics {

/// What every query does with its candidates.
template <typename Lanes>
struct CandidateLoops {
    /// Keeps those not above `bound`, in their order.
    static void keep_not_above(Candidates& found, float bound) {
        const auto limit = Lanes::all(bound);
        size_t kept = 0;
        for (size_t i = 0; i < found.count; i += Lanes::width) {
            const auto d2 = Lanes::load(found.squared_distance + i);
            const auto index = Lanes::load(found.index + i);
            const uint32_t mask =
                Lanes::not_above(d2, limit) & Selection<Lanes>::real_lanes(found.count - i);
            Lanes::compress(found.squared_distance + kept, mask, d2);
            Lanes::compress(found.index + kept, mask, index);
            kept += Lanes::count(mask);
        }
        found.count = kept;
    }

    static float shrink(Candidates& found, size_t nearest, size_t most, float bound) {
        const auto smaller = Selection<Lanes>::bound_for(found.squared_distance, found.count,
                                                         found.count, nearest, most, 0, bound);
        keep_not_above(found, smaller.value);
        return smaller.value;
    }

    static Farthest farthest(const Candidates& found) {
        const float greatest = Selection<Lanes>::greatest_not_above(found.squared_distance,
                                                                    found.count, __builtin_inff());
        const auto limit = Lanes::all(greatest);
        Farthest result{found.count, true};
        for (size_t i = 0; i < found.count; i += Lanes::width) {
            const uint32_t mask = Lanes::not_above(limit, Lanes::load(found.squared_distance + i)) &
                                  Selection<Lanes>::real_lanes(found.count - i);
            if (mask == 0) continue;
            if (result.place < found.count || (mask & (mask - 1)) != 0) result.alone = false;
            if (result.place == found.count)
                result.place = i + static_cast<size_t>(__builtin_ctz(mask));
        }
        return result;
    }
};

}  // namespace caustics
