#pragma once

#include <algorithm>

namespace caustics {

/// Most specular events of a light path, by default and at all. Fewer cut the caustics of gems: a Diamond of n = 2.4
/// loses 11.7 % of its light after 16 events, 2 % after 64, 0.01 % after 256.
inline constexpr int most_bounces = 1'000;

/// The limit of the papers' presets. Roulette of long paths starts after so many events, so that it changes none of
/// their bits.
inline constexpr int preset_bounces = 16;

/// Roulette of long paths: the probability to go on after so many events, with 1 / probability times the weight. `share`
/// is the path's weight over the one that it set out with. Light paths in absorbing media keep a weight of 1/64 or more;
/// half of all end after 64 events, half of the rest after 128 and so on, so that light held inside by total
/// reflection costs little.
inline float chance_to_go_on(int bounces, float share) {
    constexpr float lightest = 1.0F / 64;
    constexpr int first_halving = 64;
    if (bounces < preset_bounces) return 1;
    const bool is_power_of_two = (bounces & (bounces - 1)) == 0;
    const float by_weight = std::min(1.0F, share / lightest);
    return bounces >= first_halving && is_power_of_two ? by_weight / 2 : by_weight;
}

}  // namespace caustics
