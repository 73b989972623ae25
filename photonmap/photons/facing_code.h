#pragma once

#include <stdint.h>

#include "core/scene/same_surface.h"

namespace caustics::photonmap {

/// Where the surface faces on which a photon landed, in the 13 bits of its flags between the tree's
/// two and the highest: the unit octahedron's net [Meyer et al. 2010] in 89 x 89 points, so that the
/// six axes are exact and others are off by 2.8 degrees at most. 0: not known.
constexpr unsigned facing_shift = 2;
constexpr unsigned facing_mask = 0x1FFFU << facing_shift;

/// A photon's flags for a surface of this normal (unit; not known when it is 0 or not finite).
uint16_t facing_flags(const float (&normal)[3]);

/// A place on the octahedron |x| + |y| + |z| = 44, in whole numbers.
struct Facing {
    int x, y, z;
};

static inline Facing facing_of(unsigned flags) {
    constexpr int half = 44;
    const auto cell = static_cast<int>((flags & facing_mask) >> facing_shift) - 1;
    const int u = cell / (2 * half + 1) - half, v = cell % (2 * half + 1) - half;
    const int across = u < 0 ? -u : u, along = v < 0 ? -v : v;
    const int z = half - across - along;
    if (z >= 0) return {u, v, z};
    return {u < 0 ? along - half : half - along, v < 0 ? across - half : half - across, z};
}

/// Whether a surface that faces so may be the one of that normal (unit): the same arithmetic on
/// every instruction set.
static inline bool is_same_surface(unsigned flags, const float (&normal)[3]) {
    if ((flags & facing_mask) == 0) return true;
    const Facing at = facing_of(flags);
    const auto x = static_cast<float>(at.x), y = static_cast<float>(at.y),
               z = static_cast<float>(at.z);
    const float cosine = x * normal[0] + (y * normal[1] + z * normal[2]);
    const float square = x * x + (y * y + z * z);
    return cosine > 0 && cosine * cosine > same_surface_cosine * same_surface_cosine * square;
}

}  // namespace caustics::photonmap
