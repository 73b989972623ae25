#pragma once

#include <cstdint>

#include "core/math/vec.h"
#include "photonmap/photons/direction_code.h"
#include "photonmap/photons/rgbe.h"

namespace caustics::photonmap {

/// The 20-byte photon of [J96 sec. 2].
struct Photon {
    float position[3];   ///< world frame [m]
    Rgbe energy;         ///< flux in the map's unit (see TracedPhotons)
    std::uint8_t theta;  ///< direction code of wi, from the surface to where the photon came from
    std::uint8_t phi;
    /// Low two bits: axis of the splitting plane; 13 bits: where the surface faces that it landed on
    /// (facing_code.h); the highest is the balanced tree's while it is built.
    std::uint16_t flags;
};
static_assert(sizeof(Photon) == 20);

constexpr std::uint16_t axis_mask = 3U;
/// While a global map is traced, the highest bit of the flags: the photon came from a diffuse surface.
constexpr std::uint16_t from_diffuse_mark = 0x8000U;

inline void set_axis(Photon& photon, unsigned axis) {
    photon.flags = static_cast<std::uint16_t>((photon.flags & ~unsigned{axis_mask}) | axis);
}
inline Vec3 position(const Photon& photon) {
    return {photon.position[0], photon.position[1], photon.position[2]};
}
/// Unit, away from the surface; within the direction code's error.
inline Vec3 incoming(const Photon& photon) { return decode_direction(photon.theta, photon.phi); }

}  // namespace caustics::photonmap
