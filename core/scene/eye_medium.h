#pragma once

#include "core/scene/place_medium.h"
#include "core/scene/scene.h"

namespace caustics {

/// The medium that the camera's eye is in, as the dielectrics about it say: rays are sent from the eye
/// all round, and each that meets a dielectric first asks for the medium on the side where it came
/// from. An open surface serves as well as a closed one: the eye under a pool's water sees its
/// underside, and one between two nested balls sees both from the side of the same medium.
struct EyeMedium {
    Spectrum absorption = black();  ///< [1/m]; black also where the dielectrics disagree
    /// Whether some say one medium and some another: an interface that was given no `ext_absorption`
    /// where it lies in an absorbing medium, or an open surface seen from behind.
    bool ambiguous = false;
};

EyeMedium eye_medium(const Scene& scene);

/// The same of any place in a scene.
PlaceMedium medium_around(const Scene& scene, const Vec3& place);
/// Whether some dielectric of the scene absorbs.
bool absorbs_somewhere(const Scene& scene);

/// Absorption [1/m] on the side of a surface's normal at one of its points, as a dielectric that is seen from
/// there says; null where none of 256 rays over the hemisphere meets one first.
const Spectrum* medium_at(const Scene& scene, const SegmentEnd& point);

}  // namespace caustics
