#include "photonmap/kd_tree.h"

#include <algorithm>
#include <bit>
#include <tuple>

namespace caustics {

namespace {

constexpr std::uint16_t axis_mask = 3U;
constexpr std::uint16_t placed_flag = 0x8000U;

/// The depth of the last level of a left-balanced tree; the root's is 0.
unsigned last_level(std::uint64_t count) {
    return static_cast<unsigned>(std::bit_width(count)) - 1;
}

std::uint64_t nodes_on_last_level(std::uint64_t count) {
    return count - ((std::uint64_t{1} << last_level(count)) - 1);
}

auto all_but_flags(const Photon& p) {
    return std::tie(p.position[0], p.position[1], p.position[2], p.energy.mantissa,
                    p.energy.exponent, p.theta, p.phi);
}

unsigned widest_axis(std::span<const Photon> photons) {
    Box box;
    for (const Photon& photon : photons) box.extend(position(photon));
    Vec3::Index axis = 0;
    box.sizes().maxCoeff(&axis);
    return static_cast<unsigned>(axis);
}

/// Orders the photons as an in-order walk of their tree meets them.
void order_subtree(std::span<Photon> photons) {
    while (photons.size() > 1) {
        const unsigned axis = widest_axis(photons);
        const std::size_t middle = left_size(photons.size());
        const auto median = photons.begin() + static_cast<std::ptrdiff_t>(middle);
        std::nth_element(photons.begin(), median, photons.end(),
                         [axis](const Photon& a, const Photon& b) {
                             if (a.position[axis] != b.position[axis])
                                 return a.position[axis] < b.position[axis];
                             return all_but_flags(a) < all_but_flags(b);
                         });
        median->flags = static_cast<std::uint16_t>(axis);
        order_subtree(photons.first(middle));
        photons = photons.subspan(middle + 1);
    }
    if (!photons.empty()) photons.front().flags = 0;
}

/// Moves every photon from its place in order to its place in the heap, cycle by cycle of the
/// permutation; a bit of the flags marks the places that are done.
void move_to_heap(std::span<Photon> photons) {
    for (std::size_t start = 0; start < photons.size(); ++start) {
        if ((photons[start].flags & placed_flag) != 0) continue;
        const Photon first = photons[start];
        std::size_t place = start;
        for (;;) {
            const std::size_t source = in_order_rank(place + 1, photons.size());
            photons[place] = source == start ? first : photons[source];
            photons[place].flags |= placed_flag;
            if (source == start) break;
            place = source;
        }
    }
    for (Photon& photon : photons) photon.flags &= axis_mask;
}

}  // namespace

std::uint64_t left_size(std::uint64_t count) {
    if (count < 2) return 0;
    const std::uint64_t half_of_last = std::uint64_t{1} << (last_level(count) - 1);
    return half_of_last - 1 + std::min(nodes_on_last_level(count), half_of_last);
}

std::uint64_t in_order_rank(std::uint64_t node, std::uint64_t count) {
    // In a full tree node j of a level has before it j whole subtrees with their separators and
    // its own left subtree; every second node in order is one of the last level. Then those of
    // the last level that are missing are taken out.
    const unsigned level = static_cast<unsigned>(std::bit_width(node)) - 1;
    const std::uint64_t index = node - (std::uint64_t{1} << level);
    const std::uint64_t full_rank = ((2 * index + 1) << (last_level(count) - level)) - 1;
    const std::uint64_t last_before = (full_rank + 1) / 2;
    const std::uint64_t present = nodes_on_last_level(count);
    return full_rank - (last_before > present ? last_before - present : 0);
}

void balance(std::span<Photon> photons) {
    order_subtree(photons);
    move_to_heap(photons);
}

}  // namespace caustics
