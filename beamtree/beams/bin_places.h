#pragma once

#include <array>

#include "core/material/ior.h"

namespace caustics::beamtree {

/// The wavelengths of a bin by their places in it, -1 for the shortest and 1 for the longest: linear in a glass's
/// index of refraction (to 16 steps), because then beams move nearly linearly with the place.
class BinPlaces {
public:
    BinPlaces() = default;
    BinPlaces(const WavelengthBin& bin, const Ior& glass);

    double wavelength_at(double place) const;  ///< [nm]
    double place_of(double wavelength) const;

private:
    static constexpr int steps = 16;
    std::array<double, steps + 1> nm_{};
};

}  // namespace caustics::beamtree
