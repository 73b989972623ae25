#pragma once

#include <cstdint>
#include <variant>

#include "core/geometry/shape.h"

namespace caustics {

struct PointLight {
    Vec3 position = Vec3::Zero();
    Spectrum intensity = Spectrum::Ones();  ///< [W/sr]
};

struct DirectionalLight {
    Vec3 direction = Vec3::UnitZ();          ///< unit, the way the light travels
    Spectrum irradiance = Spectrum::Ones();  ///< on a plane across the direction [W/m^2]
};

/// The front side of a shape of the scene.
struct AreaLight {
    std::uint32_t shape = 0;
    Spectrum radiance = Spectrum::Ones();  ///< [W m^-2 sr^-1]
    AreaSampler sampler;
};

using Light = std::variant<PointLight, DirectionalLight, AreaLight>;

}  // namespace caustics
