#include "photonmap/tree/select_photons.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace caustics::photonmap {

namespace {

constexpr std::size_t block = 128;

/// Moves the photons for which `goes_left` holds before the others and returns their number. Whether a
/// photon must change sides is noted block by block without branching, because a branch on it
/// would be guessed wrong half of the time (Edelkamp and Weiss, BlockQuicksort, 2016).
template <typename GoesLeft>
std::size_t partition(std::span<Photon> photons, const GoesLeft& goes_left) {
    std::array<std::uint8_t, block> left_misplaced, right_misplaced;
    std::size_t left_count = 0, right_count = 0, left_first = 0, right_first = 0;
    Photon* left = photons.data();
    Photon* right = left + photons.size();  // one past the block
    while (static_cast<std::size_t>(right - left) > 2 * block) {
        if (left_count == 0) {
            left_first = 0;
            for (std::size_t i = 0; i < block; ++i) {
                left_misplaced[left_count] = static_cast<std::uint8_t>(i);
                left_count += goes_left(left[i]) ? 0 : 1;
            }
        }
        if (right_count == 0) {
            right_first = 0;
            for (std::size_t i = 0; i < block; ++i) {
                right_misplaced[right_count] = static_cast<std::uint8_t>(i);
                right_count += goes_left(right[-1 - static_cast<std::ptrdiff_t>(i)]) ? 1 : 0;
            }
        }
        const std::size_t swaps = std::min(left_count, right_count);
        for (std::size_t i = 0; i < swaps; ++i)
            std::swap(left[left_misplaced[left_first + i]],
                      right[-1 - static_cast<std::ptrdiff_t>(right_misplaced[right_first + i])]);
        left_count -= swaps;
        right_count -= swaps;
        left_first += swaps;
        right_first += swaps;
        if (left_count == 0) left += block;
        if (right_count == 0) right -= block;
    }
    Photon* const middle = std::partition(left, right, goes_left);
    return static_cast<std::size_t>(middle - photons.data());
}

/// A key of the range such that rank `rank` lies on the pivot's short side of it, most likely.
float pivot(std::span<const Photon> photons, std::size_t rank, unsigned axis, bool& above) {
    constexpr std::size_t most = 2048;
    std::array<float, most> sample;
    const std::size_t count = std::clamp<std::size_t>(photons.size() / 16, 32, most);
    // An odd stride meets no pattern of the order of arrival.
    const std::size_t stride = ((photons.size() - 1) / count) | 1U;
    std::size_t taken = 0;
    for (std::size_t i = 0; i < photons.size() && taken < count; i += stride)
        sample[taken++] = photons[i].position[axis];
    const double share = (static_cast<double>(rank) + 0.5) / static_cast<double>(photons.size());
    const double scatter = std::sqrt(share * (1 - share) / static_cast<double>(taken));
    above = share <= 0.5;
    const double place = (share + (above ? 2.5 : -2.5) * scatter) * static_cast<double>(taken);
    const auto chosen =
        static_cast<std::ptrdiff_t>(std::clamp(place, 0.0, static_cast<double>(taken - 1)));
    std::nth_element(sample.begin(), sample.begin() + chosen,
                     sample.begin() + static_cast<std::ptrdiff_t>(taken));
    return sample[static_cast<std::size_t>(chosen)];
}

}  // namespace

void select_photon(std::span<Photon> photons, std::size_t rank, unsigned axis) {
    constexpr std::size_t small = 256;
    while (photons.size() > small) {
        bool above = false;
        const float key = pivot(photons, rank, axis, above);
        const auto below_key = [=](const Photon& p) { return p.position[axis] < key; };
        const auto not_above_key = [=](const Photon& p) { return p.position[axis] <= key; };
        std::size_t left =
            above ? partition(photons, not_above_key) : partition(photons, below_key);
        if (left == 0 || left == photons.size()) {
            // The pivot is the range's end: those equal to it come apart from the others.
            const bool all_left = left != 0;
            left = all_left ? partition(photons, below_key) : partition(photons, not_above_key);
            if (all_left ? rank >= left : rank < left) return;
        }
        if (rank < left) {
            photons = photons.first(left);
        } else {
            photons = photons.subspan(left);
            rank -= left;
        }
    }
    std::nth_element(
        photons.begin(), photons.begin() + static_cast<std::ptrdiff_t>(rank), photons.end(),
        [axis](const Photon& a, const Photon& b) { return a.position[axis] < b.position[axis]; });
}

}  // namespace caustics::photonmap
