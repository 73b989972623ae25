#pragma once

#include <vector>

#include "core/scene/eye_medium.h"

namespace caustics {

/// The medium that each of Scene::lights shines into, as the dielectrics about it say (medium_around): about the place
/// of a point or spot light, and before the front of an area light, at points spread over it. Light from infinitely
/// far away starts in none. The scene asks for it once it can intersect, and keeps it (Scene::light_media).
std::vector<PlaceMedium> light_media(const Scene& scene);

/// Whether some dielectric absorbs, and there are mirrors that may lie in it, or lamps that do.
bool absorbs_at_mirrors_or_lamps(const Scene& scene);

}  // namespace caustics
