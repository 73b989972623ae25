#pragma once

#include "core/math/spectrum.h"

namespace caustics {

/// What the dielectrics about a place say of the medium there.
struct PlaceMedium {
    const Spectrum* absorption = nullptr;  ///< [1/m]; null: no dielectric is seen, or they disagree
    bool ambiguous = false;

    /// Takes what one more dielectric says; null says nothing. False where it says another medium than those before.
    bool agrees_with(const Spectrum* said) {
        if (said == nullptr) return true;
        if (absorption == nullptr) absorption = said;
        if ((*said == *absorption).all()) return true;
        *this = {nullptr, true};
        return false;
    }
};

}  // namespace caustics
