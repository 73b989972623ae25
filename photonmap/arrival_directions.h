#pragma once

#include <span>

#include "photonmap/photon.h"
#include "photonmap/tree_kernels.h"

namespace caustics {

/// A cone that holds the directions from which a map's photons came. Most points of a receiver have
/// all of it in front, and then no photon needs to be tested by itself.
class ArrivalDirections {
public:
    /// Throws InputError naming the first photon whose position is not finite.
    explicit ArrivalDirections(std::span<const Photon> photons);

    /// Whether certainly no photon came from behind `normal` (unit).
    bool all_in_front(const Vec3& normal) const;

private:
    bool empty_ = true;
    Vec3 axis_ = Vec3::UnitZ();
    float sine_ = 1;  ///< of half the opening angle; at least 1 when that is not acute
};

/// Whether the photon came from the side of `normal`, as every tree decides it.
bool came_from_front(const Photon& photon, const Vec3& normal);

SideTest side_test(const Vec3& normal);

/// Whether photons of all these direction codes came from the side of the test's normal.
bool all_in_front(const SideTest& side, std::span<const std::uint16_t> directions);

}  // namespace caustics
