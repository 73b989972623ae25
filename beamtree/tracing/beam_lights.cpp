#include "beamtree/tracing/beam_lights.h"

#include <fmt/format.h>

#include <cmath>

#include "core/base/error.h"
#include "core/scene/lights_on_casters.h"

namespace caustics::beamtree {
namespace {

Ior most_dispersive_glass(const Scene& scene) {
    const auto spread = [](const Ior& ior) {
        return std::abs(ior.at(static_cast<float>(shortest_wavelength)) -
                        ior.at(static_cast<float>(longest_wavelength)));
    };
    Ior most = 1;
    for (const Shape& shape : scene.shapes())
        if (const auto* glass = std::get_if<Dielectric>(&shape.bsdf.model))
            for (const Ior& ior : {glass->int_ior, glass->ext_ior})
                if (spread(ior) > spread(most)) most = ior;
    return most;
}

// Its rays start on the surface and would not meet it.
void refuse_light_on_caster(const Scene& scene, const std::string& method) {
    const std::vector<LightOnCaster> lights = lights_on_casters(scene);
    if (lights.empty()) return;
    const Vec3d at = scene.origin() + lights[0].position.cast<double>();
    throw UnsupportedScene(
        fmt::format("{}: the light at ({:g}, {:g}, {:g}) lies on {}, and on which of its sides it "
                    "shines is not "
                    "known (move it to one side, by a millionth of its coordinates or more)",
                    method, at.x(), at.y(), at.z(), scene.shapes()[lights[0].caster].name));
}

}  // namespace

std::vector<LightSample> beam_lights(const Scene& scene, const std::string& method,
                                     const BeamParams& params, const RunOptions& options) {
    for (const Light& light : scene.lights())
        if (surrounds(light))
            throw UnsupportedScene(
                method + ": beams start from points or directions, and a " + type_of(light) +
                " light shines from everywhere (photonmap and the references take it)");
    refuse_light_on_caster(scene, method);
    std::vector<LightSample> lights = sample_lights(scene, params.light_samples, options.seed);
    if (!disperses(scene)) return lights;
    return params.dispersion == Dispersion::intervals
               ? drifting(lights, params.wavelengths, most_dispersive_glass(scene))
               : dispersed(lights, params.wavelengths);
}

}  // namespace caustics::beamtree
