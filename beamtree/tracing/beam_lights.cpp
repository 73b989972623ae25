#include "beamtree/tracing/beam_lights.h"

#include <cmath>

#include "core/base/error.h"

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

}  // namespace

std::vector<LightSample> beam_lights(const Scene& scene, const std::string& method,
                                     const BeamParams& params, const RunOptions& options) {
    for (const Light& light : scene.lights())
        if (surrounds(light))
            throw UnsupportedScene(
                method + ": beams start from points or directions, and a " + type_of(light) +
                " light shines from everywhere (photonmap and the references take it)");
    std::vector<LightSample> lights = sample_lights(scene, params.light_samples, options.seed);
    if (!disperses(scene)) return lights;
    return params.dispersion == Dispersion::intervals
               ? drifting(lights, params.wavelengths, most_dispersive_glass(scene))
               : dispersed(lights, params.wavelengths);
}

}  // namespace caustics::beamtree
