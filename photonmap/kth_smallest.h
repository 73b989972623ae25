#pragma once

#include <stddef.h>
#include <stdint.h>
#include <string.h>

namespace caustics {

/// A value of given rank and its place among the others.
struct KthSmallest {
    float value;
    size_t less;       ///< how many are below it
    size_t not_above;  ///< how many are not above it
};

/// Selection without moving anything: counts the values not above a guess, and guesses again by
/// interpolation. Squared distances of photons in a disc are nearly uniform, so that a few passes
/// over the values do, a register at a time.
template <typename Lanes>
struct Selection {
    /// The bits of the lanes that exist, in a register of which `left` >= 1 values are real.
    static uint32_t real_lanes(size_t left) {
        return left >= Lanes::width ? ~0U >> (32U - Lanes::width)
                                    : (1U << static_cast<unsigned>(left)) - 1U;
    }

    static size_t count_not_above(const float* values, size_t count, float bound) {
        const auto limit = Lanes::all(bound);
        size_t found = 0;
        size_t i = 0;
        for (; i + Lanes::width <= count; i += Lanes::width)
            found += Lanes::count(Lanes::not_above(Lanes::load(values + i), limit));
        if (i < count)
            found += Lanes::count(Lanes::not_above(Lanes::load(values + i), limit) &
                                  real_lanes(count - i));
        return found;
    }

    static size_t count_less(const float* values, size_t count, float bound) {
        const auto limit = Lanes::all(bound);
        size_t found = 0;
        size_t i = 0;
        for (; i + Lanes::width <= count; i += Lanes::width)
            found += Lanes::count(Lanes::less(Lanes::load(values + i), limit));
        if (i < count)
            found +=
                Lanes::count(Lanes::less(Lanes::load(values + i), limit) & real_lanes(count - i));
        return found;
    }

    /// The greatest value not above `bound`; there must be one.
    static float greatest_not_above(const float* values, size_t count, float bound) {
        const auto limit = Lanes::all(bound);
        const auto none = Lanes::all(-__builtin_inff());
        auto greatest = none;
        for (size_t i = 0; i < count; i += Lanes::width) {
            const auto v = Lanes::load(values + i);
            const uint32_t mask = Lanes::not_above(v, limit) & real_lanes(count - i);
            greatest = Lanes::max(greatest, Lanes::where(mask, v, none));
        }
        return Lanes::greatest(greatest);
    }

    /// A bound that at least `rank` and, unless values are equal, at most `most` of the values are
    /// not above. No value lies below `least`, `within` of them not above `greatest`;
    /// 1 <= rank <= most, rank <= within.
    struct Bound {
        float value;
        size_t not_above;
    };
    static Bound bound_for(const float* values, size_t count, size_t within, size_t rank,
                           size_t most, float least, float greatest) {
        // The answer lies in (low, high]; `below` values are not above low, `within` not above high.
        int32_t low = order_of(least) - 1, high = order_of(greatest);
        float low_value = least;
        size_t below = 0;
        // When few are left between the two, these are looked at by themselves.
        float few[few_values + Lanes::width];
        size_t left_out = 0;
        for (unsigned step = 1; within > most && high - 1 > low; ++step) {
            const float high_value = float_of(high);
            int32_t guess = low + static_cast<int32_t>((static_cast<int64_t>(high) - low) / 2);
            if (step % 4 != 0) {
                const double wanted = 0.5 * static_cast<double>(rank + most) + 0.5;
                const double share =
                    (wanted - static_cast<double>(below)) / static_cast<double>(within - below + 1);
                const double span =
                    static_cast<double>(high_value) - static_cast<double>(low_value);
                guess = order_of(static_cast<float>(static_cast<double>(low_value) + share * span));
                if (guess <= low) guess = low + 1;
                if (guess >= high) guess = high - 1;
            }
            const float guess_value = float_of(guess);
            const size_t found = left_out + count_not_above(values, count, guess_value);
            if (found >= rank) {
                high = guess;
                within = found;
            } else {
                low = guess;
                low_value = guess_value;
                below = found;
            }
            if (within - below <= few_values && count > 2 * few_values) {
                count = take_between(values, count, low_value, below > 0, float_of(high), few);
                values = few;
                left_out = below;
            }
        }
        return {float_of(high), within};
    }

    /// The value of rank `rank` (1 = the smallest), exactly.
    static KthSmallest kth(const float* values, size_t count, size_t rank, float least,
                           float greatest) {
        const Bound bound = bound_for(values, count, count, rank, rank, least, greatest);
        const float value = greatest_not_above(values, count, bound.value);
        return {value, count_less(values, count, value), bound.not_above};
    }

private:
    static constexpr size_t few_values = 32;

    /// Copies the values above `low` (or, where none counts as below, all) and not above `high`.
    static size_t take_between(const float* values, size_t count, float low, bool exclude_low,
                               float high, float* few) {
        const auto lower = Lanes::all(exclude_low ? low : -__builtin_inff());
        const auto upper = Lanes::all(high);
        size_t taken = 0;
        for (size_t i = 0; i < count; i += Lanes::width) {
            const auto v = Lanes::load(values + i);
            const uint32_t mask =
                Lanes::not_above(v, upper) & ~Lanes::not_above(v, lower) & real_lanes(count - i);
            Lanes::compress(few + taken, mask, v);
            taken += Lanes::count(mask);
        }
        return taken;
    }

    /// Whole numbers in the order of the floats.
    static int32_t order_of(float value) {
        int32_t bits;
        memcpy(&bits, &value, sizeof bits);
        return bits < 0 ? bits ^ 0x7FFFFFFF : bits;
    }
    static float float_of(int32_t order) {
        const int32_t bits = order < 0 ? order ^ 0x7FFFFFFF : order;
        float value;
        memcpy(&value, &bits, sizeof value);
        return value;
    }
};

}  // namespace caustics
