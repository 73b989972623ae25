#include "core/scene/eye_medium.h"

#include <algorithm>

#include "core/material/optics.h"
#include "core/scene/medium_finder.h"

namespace caustics {

EyeMedium eye_medium(const Scene& scene) {
    const PlaceMedium medium = scene.medium_around(scene.camera().position());
    return {medium.absorption != nullptr ? *medium.absorption : black(), medium.ambiguous};
}

bool absorbs_at_mirrors_or_lamps(const Scene& scene) {
    if (!absorbs_somewhere(scene.shapes())) return false;
    const auto is_mirror = [&](std::uint32_t caster) {
        return !std::holds_alternative<Dielectric>(scene.shapes()[caster].bsdf.model);
    };
    return std::ranges::any_of(scene.casters(), is_mirror) ||
           std::ranges::any_of(scene.light_media(), [](const PlaceMedium& medium) {
               return !is_clear(medium.absorption);
           });
}

}  // namespace caustics
