#pragma once

#include <span>

#include "photonmap/kernels/tree_kernels.h"
#include "photonmap/photons/photon.h"

namespace caustics::photonmap {

/// A cone that holds the directions from which a map's photons came, and one that holds the normals of
/// the surfaces they landed on. At most points of a receiver all that is in them counts, and then no
/// photon needs to be tested by itself.
class ArrivalDirections {
public:
    /// Throws InputError naming the first photon whose position is not finite.
    explicit ArrivalDirections(std::span<const Photon> photons, int threads = 1);

    /// Whether certainly all photons count at a point of that normal (unit): none came from behind
    /// it, or landed on another surface (is_same_surface).
    bool all_count(const Vec3& normal) const;

private:
    bool empty_ = true;
    Vec3 axis_ = Vec3::UnitZ();
    float sine_ = 1;  ///< of half the opening angle; at least 1 when that is not acute
    Vec3 facing_ = Vec3::UnitZ();
    /// Above this cosine to `facing_` a normal is that of every surface; below -1: of any known one.
    float facing_cosine_ = -2;
};

SideTest side_test(const Vec3& normal);

/// Whether the first `count` of these photons pass the test; they must have flags.
bool all_count(const SideTest& side, const CopiedPhotons& photons, std::size_t count);

}  // namespace caustics::photonmap
