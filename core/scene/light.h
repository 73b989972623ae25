#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include "core/geometry/shape.h"
#include "core/scene/spot_cone.h"

namespace caustics {

/// Shines alike all round, or, as a spot light, about an axis.
struct PointLight {
    Vec3 position = Vec3::Zero();
    Spectrum intensity = Spectrum::Ones();  ///< [W/sr]
    std::optional<SpotCone> spot = {};

    /// Intensity along a unit direction away from the light [W/sr].
    Spectrum intensity_along(const Vec3& direction) const {
        return spot ? intensity * spot->falloff(direction) : intensity;
    }
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

/// The same radiance from everywhere, from infinitely far away (Mitsuba's `constant`).
struct ConstantLight {
    Spectrum radiance = Spectrum::Ones();  ///< [W m^-2 sr^-1]
};

using Light = std::variant<PointLight, DirectionalLight, ConstantLight, AreaLight>;

}  // namespace caustics
