#pragma once

#include <optional>
#include <string>

#include "core/light_path/light_path.h"
#include "core/scene/scene.h"

namespace caustics {

/// Why no light path can be aimed at a caster: there is none, or no light, or no light shines towards
/// one. Empty when one can.
std::optional<std::string> why_nothing_is_aimed(const Scene& scene);

/// Why light paths that were traced and stored nothing (counts.stored is 0) brought no light to any
/// receiver: the most frequent end of those that reached a caster, and how many came to each end.
std::string why_nothing_arrives(const LightPathCounts& counts);

/// "12 thinned out at the light, 3 met no caster first, ...": how many light paths came to each end.
std::string ends_of(const LightPathCounts& counts);

}  // namespace caustics
