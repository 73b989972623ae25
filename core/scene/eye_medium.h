#pragma once

#include "core/scene/scene.h"

namespace caustics {

/// The medium that the camera's eye is in (Scene::medium_around).
struct EyeMedium {
    Spectrum absorption = black();  ///< [1/m]; black also where the dielectrics disagree
    /// Whether some say one medium and some another: an interface that was given no `ext_absorption`
    /// where it lies in an absorbing medium, or an open surface seen from behind.
    bool ambiguous = false;
};

EyeMedium eye_medium(const Scene& scene);

/// Whether some dielectric absorbs, and there are mirrors that may lie in it, or lamps that do.
bool absorbs_at_mirrors_or_lamps(const Scene& scene);

}  // namespace caustics
