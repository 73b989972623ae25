#pragma once

#include "photonmap/kernels/left_balanced.h"
#include "photonmap/kernels/simd_select.h"
#include "photonmap/kernels/tree_kernels.h"

namespace caustics::photonmap {

/// Builds the subtrees of small ranges: the positions lie in columns, and every level of the tree moves
/// them from one set of columns to the other, a register at a time.
template <typename Lanes>
class SimdSubtreeBuild {
public:
    static void bounds(const unsigned char* photons, size_t count, float least[3],
                       float greatest[3]) {
        // A photon has five words, so that five registers hold as many photons as one has lanes,
        // and each lane of each register always meets the same word of a photon.
        const auto* const words = reinterpret_cast<const float*>(photons);
        constexpr size_t step = Lanes::width;
        auto low0 = Lanes::all(__builtin_inff()), low1 = low0, low2 = low0, low3 = low0,
             low4 = low0;
        auto high0 = Lanes::all(-__builtin_inff()), high1 = high0, high2 = high0, high3 = high0,
             high4 = high0;
        size_t i = 0;
        for (; i + step <= count; i += step) {
            const float* const at = words + 5 * i;
            const auto a = Lanes::load(at), b = Lanes::load(at + step),
                       c = Lanes::load(at + 2 * step), d = Lanes::load(at + 3 * step),
                       e = Lanes::load(at + 4 * step);
            low0 = Lanes::min(a, low0), high0 = Lanes::max(a, high0);
            low1 = Lanes::min(b, low1), high1 = Lanes::max(b, high1);
            low2 = Lanes::min(c, low2), high2 = Lanes::max(c, high2);
            low3 = Lanes::min(d, low3), high3 = Lanes::max(d, high3);
            low4 = Lanes::min(e, low4), high4 = Lanes::max(e, high4);
        }
        float low[5 * step], high[5 * step];
        Lanes::store(low, low0), Lanes::store(high, high0);
        Lanes::store(low + step, low1), Lanes::store(high + step, high1);
        Lanes::store(low + 2 * step, low2), Lanes::store(high + 2 * step, high2);
        Lanes::store(low + 3 * step, low3), Lanes::store(high + 3 * step, high3);
        Lanes::store(low + 4 * step, low4), Lanes::store(high + 4 * step, high4);
        for (size_t axis = 0; axis < 3; ++axis) {
            least[axis] = __builtin_inff();
            greatest[axis] = -__builtin_inff();
            for (size_t word = axis; word < 5 * step; word += 5)
                extend(low[word], high[word], least[axis], greatest[axis]);
            for (size_t j = i; j < count; ++j)
                extend(words[5 * j + axis], words[5 * j + axis], least[axis], greatest[axis]);
        }
    }

    static void order(unsigned char* photons, size_t count, OrderScratch& scratch) {
        SimdSubtreeBuild(photons, count, scratch).order_subtree(0, 0, count);
    }

    static void fill_buckets(const BucketRange& range, OrderScratch& scratch) {
        SimdSubtreeBuild order(range.photons, range.count, scratch);
        order.range_ = &range;
        order.fill(0, 0, range.count, range.node, range.leaves);
    }

private:
    using Columns = OrderScratch::Columns;

    SimdSubtreeBuild(unsigned char* photons, size_t count, OrderScratch& scratch)
        : photons_(photons), scratch_(scratch) {
        Columns& columns = scratch.columns[0];
        for (size_t i = 0; i < count; ++i) {
            float position[3];
            memcpy(position, photons + 20 * i, sizeof position);
            memcpy(&scratch.payload[i], photons + 20 * i + 12, sizeof scratch.payload[i]);
            for (unsigned axis = 0; axis < 3; ++axis) columns.position[axis][i] = position[axis];
            columns.source[i] = static_cast<uint32_t>(i);
        }
    }

    static void extend(float low, float high, float& least, float& greatest) {
        least = low < least ? low : least;
        greatest = high > greatest ? high : greatest;
    }

    /// The columns' part begin .. begin + count, cut along its widest side at a rank.
    struct Cut {
        unsigned axis;
        float value;  ///< of the photon of that rank
    };
    Cut cut(unsigned from, size_t begin, size_t count, size_t rank) {
        const Columns& columns = scratch_.columns[from];
        unsigned axis = 0;
        float least = 0, greatest = 0;
        for (unsigned a = 0; a < 3; ++a) {
            float low = 0, high = 0;
            range_of(columns.position[a] + begin, count, low, high);
            if (a == 0 || high - low > greatest - least) {
                axis = a;
                least = low;
                greatest = high;
            }
        }
        const SimdSelect kth =
            Selection<Lanes>::kth(columns.position[axis] + begin, count, rank + 1, least, greatest);
        move_lower(from, begin, count, axis, kth);
        move_others(from, begin, count, axis, kth);
        return {axis, kth.value};
    }

    static void range_of(const float* values, size_t count, float& least, float& greatest) {
        auto low = Lanes::all(__builtin_inff());
        auto high = Lanes::all(-__builtin_inff());
        size_t i = 0;
        for (; i + Lanes::width <= count; i += Lanes::width) {
            const auto v = Lanes::load(values + i);
            low = Lanes::min(low, v);
            high = Lanes::max(high, v);
        }
        if (i < count) {
            const auto v = Lanes::load(values + i);
            const uint32_t mask = Selection<Lanes>::real_lanes(count - i);
            low = Lanes::min(low, Lanes::where(mask, v, low));
            high = Lanes::max(high, Lanes::where(mask, v, high));
        }
        least = Lanes::least(low);
        greatest = Lanes::greatest(high);
    }

    /// Registers are stored whole: what a store writes past its lanes is written over later, or
    /// belongs to ranges further right, which are done before those to their left.
    void move_lower(unsigned from, size_t begin, size_t count, unsigned axis,
                    const SimdSelect& kth) {
        const auto value = Lanes::all(kth.value);
        const float* const keys = scratch_.columns[from].position[axis] + begin;
        size_t to = begin;
        for (size_t i = 0; i < count; i += Lanes::width) {
            const uint32_t mask =
                Lanes::less(Lanes::load(keys + i), value) & Selection<Lanes>::real_lanes(count - i);
            move(from, begin + i, to, mask);
            to += Lanes::count(mask);
        }
    }

    void move_others(unsigned from, size_t begin, size_t count, unsigned axis,
                     const SimdSelect& kth) {
        const auto value = Lanes::all(kth.value);
        const float* const keys = scratch_.columns[from].position[axis] + begin;
        size_t to = begin + kth.not_above;
        size_t equal_to = begin + kth.less;
        for (size_t i = 0; i < count; i += Lanes::width) {
            const auto v = Lanes::load(keys + i);
            const uint32_t real = Selection<Lanes>::real_lanes(count - i);
            const uint32_t not_above = Lanes::not_above(v, value) & real;
            uint32_t equal = not_above & ~Lanes::less(v, value);
            move(from, begin + i, to, real & ~not_above);
            to += Lanes::count(real & ~not_above);
            for (; equal != 0; equal &= equal - 1)
                move_one(from, begin + i + static_cast<size_t>(__builtin_ctz(equal)), equal_to++);
        }
    }

    void move(unsigned from, size_t i, size_t to, uint32_t mask) {
        const Columns& source = scratch_.columns[from];
        Columns& target = scratch_.columns[1 - from];
        for (unsigned a = 0; a < 3; ++a)
            Lanes::compress(target.position[a] + to, mask, Lanes::load(source.position[a] + i));
        Lanes::compress(target.source + to, mask, Lanes::load(source.source + i));
    }

    void move_one(unsigned from, size_t i, size_t to) {
        const Columns& source = scratch_.columns[from];
        Columns& target = scratch_.columns[1 - from];
        for (unsigned a = 0; a < 3; ++a) target.position[a][to] = source.position[a][i];
        target.source[to] = source.source[i];
    }

    void order_subtree(unsigned from, size_t begin, size_t count) {
        while (count > 1) {
            const size_t middle = left_size(count);
            const Cut at = cut(from, begin, count, middle);
            from = 1 - from;
            write_photon(from, begin + middle, at.axis);
            order_subtree(from, begin + middle + 1, count - middle - 1);
            count = middle;
        }
        if (count == 1) write_photon(from, begin, 0);
    }

    void write_photon(unsigned from, size_t i, unsigned axis) {
        const Columns& columns = scratch_.columns[from];
        unsigned char* const to = photons_ + 20 * i;
        for (unsigned a = 0; a < 3; ++a) memcpy(to + 4 * a, &columns.position[a][i], 4);
        const uint64_t payload = scratch_.payload[columns.source[i]];
        // The axis takes the lowest two bits of the flags, the last two bytes.
        const uint64_t with_axis = (payload & ~(uint64_t{3} << 48U)) | uint64_t{axis} << 48U;
        memcpy(to + 12, &with_axis, sizeof with_axis);
    }

    void fill(unsigned from, size_t begin, size_t count, uint64_t node, uint64_t leaves) {
        while (leaves > 1) {
            const uint64_t on_left = left_leaves(leaves);
            const size_t middle = on_left * bucket_photons;
            const Cut at = cut(from, begin, count, middle);
            from = 1 - from;
            uint32_t bits;
            memcpy(&bits, &at.value, sizeof bits);
            range_->planes[node] = (bits & ~3U) | at.axis;
            fill(from, begin + middle, count - middle, 2 * node + 1, leaves - on_left);
            count = middle;
            node = 2 * node;
            leaves = on_left;
        }
        write_bucket(from, begin, count);
    }

    void write_bucket(unsigned from, size_t begin, size_t count) {
        const Columns& columns = scratch_.columns[from];
        unsigned char* const bucket = photons_ + 20 * begin;
        float position[bucket_photons];
        for (unsigned a = 0; a < 3; ++a) {
            for (size_t i = 0; i < bucket_photons; ++i)
                position[i] = i < count ? columns.position[a][begin + i] : __builtin_inff();
            memcpy(bucket + 4 * bucket_photons * a, position, sizeof position);
        }
        for (size_t i = 0; i < bucket_photons; ++i) {
            const uint64_t payload =
                i < count ? scratch_.payload[columns.source[begin + i]] : uint64_t{0};
            const auto* const bytes = reinterpret_cast<const unsigned char*>(&payload);
            memcpy(bucket + 12 * bucket_photons + 4 * i, bytes, 4);
            memcpy(bucket + 16 * bucket_photons + 2 * i, bytes + 4, 2);
            memcpy(bucket + 18 * bucket_photons + 2 * i, bytes + 6, 2);
        }
    }

    unsigned char* photons_;
    OrderScratch& scratch_;
    const BucketRange* range_ = nullptr;
};

}  // namespace caustics::photonmap
