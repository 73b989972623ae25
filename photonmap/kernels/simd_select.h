#pragma once

#include <stddef.h>
#include <stdint.h>
#include <string.h>

namespace caustics::photonmap {

/// A value of given rank and its place among the others.
struct SimdSelect {
    float value;
    size_t less;       ///< how many are below it
    size_t not_above;  ///< how many are not above it
};

/// Selection without moving anything: counts the values not above a guess, and guesses again by
/// interpolation. Squared distances of photons in a disc are nearly uniform, so that a pass or two
/// over the values leave few to compare with each other.
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
        Bracket bracket{order_of(least) - 1, order_of(greatest), least, 0, within};
        for (unsigned step = 1; bracket.within > most && bracket.high - 1 > bracket.low; ++step) {
            if (bracket.within - bracket.below <= few_values)
                return among_few(values, count, rank, bracket);
            Guesses guesses = bracket.guess(rank, most);
            if (step % 4 == 0) guesses.first = guesses.second = bracket.halfway();
            bracket.narrow(
                guesses, rank,
                counts_not_above(values, count, float_of(guesses.first), float_of(guesses.second)));
        }
        return {float_of(bracket.high), bracket.within};
    }

    /// The value of rank `rank` (1 = the smallest), exactly.
    static SimdSelect kth(const float* values, size_t count, size_t rank, float least,
                          float greatest) {
        const Bound bound = bound_for(values, count, count, rank, rank, least, greatest);
        const float value = greatest_not_above(values, count, bound.value);
        return {value, count_less(values, count, value), bound.not_above};
    }

private:
    static constexpr size_t few_values = 32;

    /// Two numbers with which the values are compared in one pass, in the order of the floats.
    struct Guesses {
        int32_t first, second;
    };
    struct Counts {
        size_t first, second;
    };

    /// The answer lies in (low, high]: `below` values are not above low, `within` not above high.
    struct Bracket {
        int32_t low, high;
        float low_value;
        size_t below, within;

        int32_t halfway() const {
            return low + static_cast<int32_t>((static_cast<int64_t>(high) - low) / 2);
        }

        /// On both sides of where the answer is likely to be.
        Guesses guess(size_t rank, size_t most) const {
            const auto left = static_cast<float>(within - below + 1);
            const auto slack = static_cast<float>(most - rank);
            const float wanted = static_cast<float>(rank - below) + 0.5F * slack + 0.5F;
            const float reach = most > rank ? 0.25F * slack : 0.5F * __builtin_sqrtf(left) + 1;
            const float step = (float_of(high) - low_value) / left;
            return {inside(low_value + (wanted - reach) * step),
                    inside(low_value + (wanted + reach) * step)};
        }

        int32_t inside(float value) const {
            const int32_t order = order_of(value);
            return order <= low ? low + 1 : order >= high ? high - 1 : order;
        }

        void narrow(const Guesses& guesses, size_t rank, const Counts& found) {
            if (found.second < rank) return raise(guesses.second, found.second);
            const bool first = found.first >= rank;
            high = first ? guesses.first : guesses.second;
            within = first ? found.first : found.second;
            if (!first) raise(guesses.first, found.first);
        }
        void raise(int32_t guess, size_t not_above) {
            low = guess;
            low_value = float_of(guess);
            below = not_above;
        }
    };

    static Counts counts_not_above(const float* values, size_t count, float first, float second) {
        const auto first_limit = Lanes::all(first), second_limit = Lanes::all(second);
        Counts found{0, 0};
        for (size_t i = 0; i < count; i += Lanes::width) {
            const auto v = Lanes::load(values + i);
            const uint32_t real = real_lanes(count - i);
            found.first += Lanes::count(Lanes::not_above(v, first_limit) & real);
            found.second += Lanes::count(Lanes::not_above(v, second_limit) & real);
        }
        return found;
    }

    /// When few are left in the bracket, every one's rank is counted.
    static Bound among_few(const float* values, size_t count, size_t rank, const Bracket& bracket) {
        float few[few_values + Lanes::width];
        const size_t taken = take_between(values, count, bracket.low_value, bracket.below > 0,
                                          float_of(bracket.high), few);
        const auto wanted = Lanes::all(static_cast<float>(rank - bracket.below));
        const auto infinite = Lanes::all(__builtin_inff());
        auto answer = infinite;
        for (size_t i = 0; i < taken; i += Lanes::width) {
            const auto mine = Lanes::load(few + i);
            auto not_above = Lanes::all(0);
            for (size_t j = 0; j < taken; ++j)
                not_above =
                    Lanes::add(not_above, Lanes::where(Lanes::not_above(Lanes::all(few[j]), mine),
                                                       Lanes::all(1), Lanes::all(0)));
            const uint32_t enough = Lanes::not_above(wanted, not_above) & real_lanes(taken - i);
            answer = Lanes::min(answer, Lanes::where(enough, mine, infinite));
        }
        const float value = Lanes::least(answer);
        return {value, bracket.below + count_not_above(few, taken, value)};
    }

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

}  // namespace caustics::photonmap
