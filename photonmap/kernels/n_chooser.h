#pragma once

#include "photonmap/kernels/n_choice.h"
#include "photonmap/kernels/simd_select.h"

namespace caustics::photonmap {

/// NChooser for registers of one kind. Directions are kept as whole numbers, so that sums, and
/// with them choices, depend neither on the photons' order nor on the instruction set.
template <typename Lanes>
class NChoiceOf {
public:
    static NChoice choose(const PhotonsAround& photons) {
        NChoice choice;
        find_directions(photons);
        float bound[2] = {0, 0};
        Sums sums[2], now;
        float below = -1;
        for (size_t i = 0; i < count_ladder.size && count_ladder.rank[i] <= photons.count; ++i) {
            const size_t rank = count_ladder.rank[i];
            const float reach =
                Selection<Lanes>::bound_for(photons.squared_distance, photons.count, photons.count,
                                            rank, rank, 0, photons.greatest_squared_distance)
                    .value;
            add_between(photons, below, reach, now);
            below = reach;
            choice.rungs = i + 1;
            if (i == 0) bound[0] = bound[1] = reach, sums[0] = sums[1] = now;
            if (now.leans()) {
                choice.stopped = true;
                choice.squared_radius = Selection<Lanes>::greatest_not_above(
                    photons.squared_distance, photons.count, bound[0]);
                choice.lean = sums[0].lean();
                return choice;
            }
            bound[0] = bound[1], sums[0] = sums[1];
            bound[1] = reach, sums[1] = now;
        }
        return choice;
    }

private:
    static constexpr float unit = 16'384;  ///< a direction's length

    struct Sums {
        int64_t x = 0, y = 0;                  ///< of directions
        int64_t doubled_x = 0, doubled_y = 0;  ///< of directions at twice their angle
        int64_t count = 0;

        /// Whether directions are spread too unevenly for chance: |sum|^2 / count, of mean 1 and
        /// nearly exponential where they are even, exceeds 6; at twice the angle 9.
        bool leans() const {
            const int64_t mean_square = count << 28;
            return x * x + y * y > 6 * mean_square ||
                   doubled_x * doubled_x + doubled_y * doubled_y > 9 * mean_square;
        }
        double lean() const {
            const auto square = static_cast<double>(x * x + y * y);
            return __builtin_sqrt(square) /
                   (static_cast<double>(unit) * static_cast<double>(count));
        }
    };

    static auto dot(const float* v, const typename Lanes::Floats* offset) {
        return Lanes::add(Lanes::mul(Lanes::all(v[0]), offset[0]),
                          Lanes::add(Lanes::mul(Lanes::all(v[1]), offset[1]),
                                     Lanes::mul(Lanes::all(v[2]), offset[2])));
    }

    static void find_directions(const PhotonsAround& photons) {
        const auto tiny = Lanes::all(1e-30F);
        for (size_t i = 0; i < photons.count; i += Lanes::width) {
            typename Lanes::Floats offset[3];
            for (unsigned axis = 0; axis < 3; ++axis)
                offset[axis] = Lanes::sub(Lanes::load(photons.position[axis] + i),
                                          Lanes::all(photons.point[axis]));
            const auto across = dot(photons.tangent, offset);
            const auto aside = dot(photons.bitangent, offset);
            const auto length = Lanes::max(
                Lanes::sqrt(Lanes::add(Lanes::mul(across, across), Lanes::mul(aside, aside))),
                tiny);
            const auto x = Lanes::div(across, length), y = Lanes::div(aside, length);
            const auto xy = Lanes::mul(x, y);
            store(photons.direction[0] + i, x);
            store(photons.direction[1] + i, y);
            store(photons.direction[2] + i, Lanes::sub(Lanes::mul(x, x), Lanes::mul(y, y)));
            store(photons.direction[3] + i, Lanes::add(xy, xy));
        }
    }

    static void store(uint32_t* to, typename Lanes::Floats value) {
        Lanes::store(to, Lanes::whole(Lanes::mul(value, Lanes::all(unit))));
    }

    /// Adds the photons beyond `below` and not beyond `reach`.
    static void add_between(const PhotonsAround& photons, float below, float reach, Sums& sums) {
        const auto lower = Lanes::all(below), upper = Lanes::all(reach);
        auto x = Lanes::no_words(), y = x, doubled_x = x, doubled_y = x;
        size_t count = 0;
        for (size_t i = 0; i < photons.count; i += Lanes::width) {
            const auto d2 = Lanes::load(photons.squared_distance + i);
            const uint32_t mask = Lanes::not_above(d2, upper) & ~Lanes::not_above(d2, lower) &
                                  Selection<Lanes>::real_lanes(photons.count - i);
            if (mask == 0) continue;
            count += Lanes::count(mask);
            const auto add = [&](auto& sum, size_t part) {
                sum = Lanes::add_where(mask, sum, Lanes::load(photons.direction[part] + i));
            };
            add(x, 0);
            add(y, 1);
            add(doubled_x, 2);
            add(doubled_y, 3);
        }
        sums.x += signed_sum(x);
        sums.y += signed_sum(y);
        sums.doubled_x += signed_sum(doubled_x);
        sums.doubled_y += signed_sum(doubled_y);
        sums.count += static_cast<int64_t>(count);
    }

    static int64_t signed_sum(typename Lanes::Words words) {
        return static_cast<int32_t>(Lanes::sum(words));
    }
};

}  // namespace caustics::photonmap
