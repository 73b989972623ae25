#pragma once

#include <functional>
#include <optional>

#include "core/math/vec.h"

namespace caustics::experiments {

/// Where light that stays in a plane through the axis lands on a plane across the axis.
struct Landing {
    double radius = 0;  ///< from the axis; negative on the far side
    double share = 1;   ///< of the light's flux that is left
};

/// Light round an axis by one number u of its rays, the angle to the axis or the distance from it.
struct Meridian {
    /// Where ray u lands, or nothing.
    std::function<std::optional<Landing>(double)> land;
    std::function<double(double)> flux;  ///< before the event, per u, all round the axis [W]
    double first = 0;                    ///< u of the innermost ray
    double last = 1;                     ///< and of the outermost

    /// Flux that lands at `radius` per length [W/m]: the sum over all u that land there of
    /// flux(u) share(u) / |d radius / du|. They are sought on a fine grid of u and bisected to rounding;
    /// the derivative is a five-point difference. Good to 1e-8 away from folds.
    double density(double radius) const;
    /// Irradiance at a distance r > 0 from the axis: density, from both sides, / (2 pi r).
    double irradiance(double r) const;
};

/// A ray in the plane through the axis, (across, along), with what is left of its light.
struct PlaneRay {
    Vec2d origin;
    Vec2d direction;  ///< unit
    double share = 1;

    /// To the line along = z.
    bool reach_plane(double z);
    /// To the circle round (0, z): its nearer or farther crossing.
    bool reach_circle(double z, double radius, bool nearer);
    /// Through a surface with this unit normal, on either side; n: the far side's ior over the near
    /// one's. Snell's law, and Fresnel's for unpolarised light, written apart from core/material/optics. False
    /// at total reflection.
    bool refract(const Vec2d& normal, double n);
};

/// Share of unpolarised light that a smooth surface reflects.
double fresnel_reflectance(double cos_i, double n);

}  // namespace caustics::experiments
