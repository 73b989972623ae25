#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/material/ior.h"
#include "core/material/texture.h"

namespace caustics {

/// Why another program does not take a surface, and a scene key that it would take it with, as
/// "/bsdf/absorption=0"; empty: it does.
struct ExportRefusal {
    std::string reason = {};
    std::string setting = {};
};

/// A surface's model as Mitsuba writes it.
struct MitsubaBsdf {
    using Value = std::variant<double, std::string, Texture>;
    std::string type = {};
    std::vector<std::pair<std::string, Value>> values = {};
    ExportRefusal refused = {};
};

/// Glass between its surfaces, as POV-Ray knows it.
struct PovrayInterior {
    Ior outside = 1.0F;                     ///< one for a whole scene there
    double ior = 1;                         ///< inside over outside
    std::optional<double> dispersion = {};  ///< that of violet over that of red
    Spectrum absorption = black();          ///< [1/m]
};

/// A surface's model as POV-Ray knows it.
struct PovraySurface {
    std::optional<Texture> pigment = {};  ///< none: black
    float diffuse = 1;
    std::string highlight = {};  ///< words of `finish`
    std::optional<Spectrum> reflection = {};
    std::optional<PovrayInterior> interior = {};
    ExportRefusal refused = {};
};

}  // namespace caustics
