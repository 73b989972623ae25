#include "core/light_path/empty_caustic.h"

#include <algorithm>
#include <sstream>

#include "core/light_path/aimed_emission.h"

namespace caustics {
namespace {

const char* most_frequent_end(const LightPathCounts& counts) {
    if (counts.aimed == 0)
        return "no light path left its light towards a caster: all were thinned out";
    if (counts.missed == counts.aimed)
        return "no light path met a caster: other surfaces are in the way, or the casters are "
               "small";
    const std::uint64_t most = std::max({counts.depth_limited, counts.on_black_side,
                                         counts.absorbed, counts.misdirected, counts.escaped});
    if (most == counts.depth_limited) return "max_bounces cut the light paths among the casters";
    if (most == counts.on_black_side)
        return "light arrived only where receivers are black: on the back of one-sided ones";
    if (most == counts.absorbed)
        return counts.refracted + counts.reflected == 0
                   ? "the casters absorbed all light that met them"
                   : "light was absorbed on its way through the casters";
    if (most == counts.misdirected)
        return "smooth normals over hard edges sent the light to the wrong side of the casters "
               "(face_normals: true shades their triangles flat)";
    return counts.refracted == 0
               ? "all light was reflected at the casters, none refracted, and met no receiver"
               : "light that left the casters met no receiver; casters far larger than what they "
                 "light send most of it elsewhere: cut them to the part that lights it";
}

}  // namespace

std::optional<std::string> why_nothing_is_aimed(const Scene& scene) {
    if (scene.casters().empty())
        return "no shape is a caster, which needs a bsdf with a perfectly specular part "
               "(dielectric, conductor)";
    if (scene.lights().empty()) return "the scene has no light";
    if (AimedEmission(scene).empty())
        return "no light shines towards a caster (it is turned away, or has no power)";
    return {};
}

std::string ends_of(const LightPathCounts& counts) {
    std::ostringstream text;
    text << counts.emitted - counts.aimed << " thinned out at the light, " << counts.missed
         << " met no caster first, " << counts.escaped << " left the scene, " << counts.absorbed
         << " absorbed, " << counts.misdirected << " misdirected by smooth normals, "
         << counts.on_black_side << " on black sides, " << counts.depth_limited
         << " cut at max_bounces";
    return text.str();
}

std::string why_nothing_arrives(const LightPathCounts& counts) {
    return std::string(most_frequent_end(counts)) + " (" + std::to_string(counts.emitted) +
           " light paths: " + ends_of(counts) + ")";
}

}  // namespace caustics
