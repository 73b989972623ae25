#include "core/lights/ambient_light.h"

#include "core/scene_file/strength.h"

namespace caustics {

using namespace scene_file;

ObjectText AmbientLight::text() {
    return {"ambient",
            "A light, in the scene: on every receiver, times its albedo, without shadows; no "
            "caustics.",
            {type_key(), strength("radiance", "From all around.", "W/(m^2 sr)")}};
}

Spectrum AmbientLight::read(const JsonNode& node) { return read_strength(node, "radiance"); }

}  // namespace caustics
