#pragma once

#include "photonmap/kernels/simd_select.h"
#include "photonmap/kernels/tree_kernels.h"

namespace caustics::photonmap {

/// What every query does with its candidates.
template <typename Lanes>
struct CandidateLoops {
    /// Keeps those not above `bound`, in their order.
    static void keep_not_above(Candidates& found, float bound) {
        const Candidates all = found;
        const auto limit = Lanes::all(bound);
        size_t kept = 0;
        for (size_t i = 0; i < all.count; i += Lanes::width) {
            const auto d2 = Lanes::load(all.squared_distance + i);
            const auto index = Lanes::load(all.index + i);
            const uint32_t mask =
                Lanes::not_above(d2, limit) & Selection<Lanes>::real_lanes(all.count - i);
            Lanes::compress(all.squared_distance + kept, mask, d2);
            Lanes::compress(all.index + kept, mask, index);
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
        float* const squared_distance = found.squared_distance;
        const auto none = Lanes::all(-1);
        Lanes::store(squared_distance + found.count, none);
        auto greatest = none;
        for (size_t i = 0; i < found.count; i += Lanes::width)
            greatest = Lanes::max(greatest, Lanes::load(squared_distance + i));
        const auto limit = Lanes::all(Lanes::greatest(greatest));
        size_t place = found.count, as_far = 0;
        for (size_t i = found.count; i > 0;) {
            i = (i - 1) / Lanes::width * Lanes::width;
            const uint32_t mask = Lanes::not_above(limit, Lanes::load(squared_distance + i));
            as_far += Lanes::count(mask);
            if (mask != 0) place = i + static_cast<size_t>(__builtin_ctz(mask));
        }
        return {place, as_far == 1};
    }
};

}  // namespace caustics::photonmap
