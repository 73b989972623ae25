#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "core/pixel_cell.h"

namespace caustics::photonmap {

/// The photons a query found, as arrays that shading and filters read a register at a time: plain
/// data, so that code for any instruction set can share it. Arrays are aligned to 64 bytes and may be
/// read (not trusted) up to the next multiple of 16 entries.
struct GatheredPhotons {
    const float* squared_distance = nullptr;   ///< from the query's point [m^2]
    const std::uint32_t* energy = nullptr;     ///< Rgbe, its four bytes in order of address
    const std::uint16_t* direction = nullptr;  ///< DirectionCode: theta, then phi, by address
    std::size_t count = 0;
    /// Index of a photon at the N-th distance, the largest where no margin was asked for; where there are fewer than
    /// N, at the largest distance, with a margin 0.
    std::size_t farthest = 0;
    /// World frame [m]; null unless GatherLimits::positions asked for them.
    const float* position[3] = {nullptr, nullptr, nullptr};
    bool full = false;  ///< whether N photons lie within the maximum radius
    /// Of the photons' own discs [m] (photon_discs.h); null: the estimate has one disc for all.
    const float* radius = nullptr;
    /// What their discs reach, in place of the point; null: the point.
    const PixelCell* cell = nullptr;
};

}  // namespace caustics::photonmap
