#pragma once

#include "core/math/vec.h"

namespace caustics {

/// How a ray changes with one parameter of its start: a light path's differential (Shinya, Takahashi and Naito 1987, Igehy 1999).
struct RayChange {
    Vec3d place = Vec3d::Zero();      ///< of the point that the ray has come to
    Vec3d direction = Vec3d::Zero();  ///< of its unit direction
};

/// The change at the surface that a ray meets after `distance` [m]; `across` is the surface's geometric normal there.
inline RayChange at_surface(const RayChange& before, const Vec3d& direction, double distance,
                            const Vec3d& across) {
    const Vec3d moved = before.place + distance * before.direction;
    return {moved - across.dot(moved) / across.dot(direction) * direction, before.direction};
}

/// One event by the law of reflection or of refraction. Directions and normal are on the side of arrival.
struct SpecularBend {
    Vec3d w;        ///< unit, towards where the light comes from
    Vec3d n;        ///< unit shading normal
    double cosine;  ///< of the two
    bool refracts;
    double eta = 1;  ///< of refraction: refractive index of the far side over that of the near side
    double inner = 1;  ///< cosine of the refracted direction and -n

    /// How the direction behind the event changes, as w and n do: the laws, differentiated.
    Vec3d direction_change(const Vec3d& by_w, const Vec3d& by_n) const {
        const double by_cosine = by_n.dot(w) + n.dot(by_w);
        if (!refracts) return 2 * (by_cosine * n + cosine * by_n) - by_w;
        const double by_inner = cosine * by_cosine / (eta * eta * inner);
        return (by_cosine * n + cosine * by_n - by_w) / eta - by_inner * n - inner * by_n;
    }
};

}  // namespace caustics
