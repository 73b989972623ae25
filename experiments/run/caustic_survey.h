#pragma once

#include <cstdint>
#include <string>

#include "core/light_path/light_path.h"
#include "core/scene/scene.h"

namespace caustics::experiments {

/// Where light paths of a scene arrive and whether its camera sees them there, by some paths traced to
/// find out. What arrives is of one of the kinds below the counts.
struct CausticSurvey {
    LightPathCounts counts;
    std::uint64_t on_black = 0;       ///< the receiver reflects nothing there
    std::uint64_t outside = 0;        ///< of the picture
    std::uint64_t turned_away = 0;    ///< on the side that the camera does not see
    std::uint64_t hidden = 0;         ///< behind a receiver
    std::uint64_t behind_caster = 0;  ///< which may let the camera see it, bent
    std::uint64_t seen = 0;           ///< in a straight line
};

/// The same for every call with the same arguments.
CausticSurvey survey_caustic(const Scene& scene, int max_bounces);

/// Why the camera sees none of the light that arrives (`seen` is 0): its most frequent kind.
std::string why_unseen(const CausticSurvey& survey);

}  // namespace caustics::experiments
