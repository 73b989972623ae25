#pragma once

#include <vector>

#include "core/geometry/segment.h"
#include "core/lights/light.h"
#include "core/scene/intersector.h"
#include "core/scene/place_medium.h"

namespace caustics {

/// Finds the medium of a place, as the dielectrics say that are seen from there: rays are sent, and each that meets a
/// dielectric first asks for the medium on the side where it came from. An open surface serves as well as a closed
/// one: the eye under a pool's water sees its underside, and one between two nested balls sees both from the side of
/// the same medium.
class MediumFinder {
public:
    /// Keeps references to both.
    MediumFinder(const std::vector<Shape>& shapes, const Intersector& intersector);

    /// All round a place.
    PlaceMedium around(const Vec3& place) const;
    /// Absorption [1/m] on the side of a surface's normal at one of its points; null where none of 256 rays over the
    /// hemisphere meets a dielectric first.
    const Spectrum* before(const SegmentEnd& point) const;
    /// What a light shines into: about the place of a point or spot light, and before the front of an area light, at
    /// points spread over it. Light from infinitely far away starts in none.
    PlaceMedium of(const Light& light) const;

private:
    const Spectrum* along(const Ray& ray) const;
    PlaceMedium before_or_about(const SegmentEnd& point) const;
    PlaceMedium over(const AreaLight& light) const;

    const std::vector<Shape>& shapes_;
    const Intersector& intersector_;
    bool absorbs_;  ///< some dielectric does
};

/// Whether some dielectric absorbs.
bool absorbs_somewhere(const std::vector<Shape>& shapes);

}  // namespace caustics
