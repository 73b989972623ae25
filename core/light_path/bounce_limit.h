#pragma once

namespace caustics {

/// Most specular events of a light path, by default and at all. Roulette by the path's weight ends light paths long
/// before. Fewer cut the caustics of gems: a Diamond of n = 2.4 loses 11.7 % of its light after 16 events, 2 % after
/// 64, 0.01 % after 256.
inline constexpr int most_bounces = 1'000;

/// The limit of the papers' presets. Roulette by weight starts after so many events, so that it changes none of their
/// bits.
inline constexpr int preset_bounces = 16;

/// Least weight of a long light path, as a share of the weight that it set out with. One with less goes on with a
/// probability of (its share / this), and then with this share, so that its mean stays.
inline constexpr float lightest_long_path = 1.0F / 64;

}  // namespace caustics
