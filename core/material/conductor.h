#pragma once

#include "core/math/spectrum.h"

namespace caustics {

/// A perfect mirror (Mitsuba's `conductor` of material `none`).
struct Conductor {
    Spectrum specular_reflectance = Spectrum::Ones();
};

}  // namespace caustics
