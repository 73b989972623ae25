#pragma once

#include <cstdint>

#include "core/math/vec.h"

namespace caustics::photonmap {

/// A direction in two bytes: theta from +z in 256 cells of pi/256, phi from +x in 256 cells of
/// 2 pi/256. A code stands for the centre of its cell, so that decoding is wrong by at most
/// half a cell's diagonal (0.0137 rad, at the equator).
struct DirectionCode {
    std::uint8_t theta = 0;
    std::uint8_t phi = 0;
};

/// `direction` must be unit.
DirectionCode encode_direction(const Vec3& direction);
/// Unit.
Vec3 decode_direction(std::uint8_t theta, std::uint8_t phi);

}  // namespace caustics::photonmap
