#include "core/lights/ambient_light.h"

namespace caustics {

using namespace scene_file;

ObjectText AmbientLight::text() {
    return {"ambient",
            "A light, in the scene: on every receiver, times its albedo, without shadows; no "
            "caustics.",
            {type_key(), colour("radiance", "From all around.", "W/(m^2 sr)", "1", "0 to 1e+30")}};
}

Spectrum AmbientLight::read(const JsonNode& node) {
    return read_colour(node, "radiance", 1, unlimited);
}

}  // namespace caustics
