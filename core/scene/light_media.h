#pragma once

#include <cstdint>
#include <vector>

#include "core/scene/eye_medium.h"
#include "core/scene/scene.h"

namespace caustics {

/// The media that lights shine into, as the dielectrics about them say (medium_around): about the place of a point or
/// spot light, and before the front of an area light, at points spread over it. Light from infinitely far away starts
/// in none.
class LightMedia {
public:
    explicit LightMedia(const Scene& scene);

    /// Absorption [1/m] where a light of Scene::lights starts; null: none is known.
    const Spectrum* of(std::size_t light) const { return media_[light].absorption; }
    /// Likewise of the area light on a shape; null where there is none.
    const Spectrum* of_shape(std::uint32_t shape) const;
    /// Whether the dielectrics about the light disagree (EyeMedium::ambiguous).
    bool is_ambiguous(std::size_t light) const { return media_[light].ambiguous; }

private:
    std::vector<PlaceMedium> media_;           // one a light
    std::vector<std::size_t> light_of_shape_;  // empty where no light starts in a medium
};

/// Whether some dielectric absorbs, and there are mirrors that may lie in it, or lamps that do.
bool absorbs_at_mirrors_or_lamps(const Scene& scene);

}  // namespace caustics
