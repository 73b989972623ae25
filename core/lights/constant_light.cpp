#include "core/lights/constant_light.h"

#include <fmt/format.h>

#include <utility>

#include "core/lights/light_text.h"
#include "core/scene_file/strength.h"

namespace caustics {

using namespace scene_file;

ObjectText ConstantLight::text() {
    return {"constant",
            "A light, in the scene, once: the same from all around, from infinitely far away.",
            {type_key(), strength("radiance", "Of every direction.", "W/(m^2 sr)")}};
}

ConstantLight ConstantLight::read(const JsonNode& node, const Vec3d&) {
    return {read_strength(node, "radiance")};
}

std::string ConstantLight::line(const Surroundings&, const Vec3d&) const {
    return fmt::format("constant all around, radiance {} W/(m^2 sr)", rgb(radiance));
}

std::vector<AimedSource> ConstantLight::aim(const Surroundings& scene) const {
    AimedSource source;
    source.power = radiance * static_cast<float>(4 * pi_d * aim_discs(scene, source));
    return alone(std::move(source));
}

// From any direction.
std::optional<Ray> ConstantLight::send(const Surroundings& scene, const AimedSource& source,
                                       const AimedSample& sample, Rng& rng) const {
    const float u0 = rng.next();
    const float u1 = rng.next();
    return through_disc(scene, source, sample, Frame(uniform_cap(2, u0, u1)), rng);
}

MitsubaEmitter ConstantLight::to_mitsuba() const {
    return {"constant", {{"rgb", "radiance", Vec3(radiance.matrix())}}};
}

PovrayLight ConstantLight::to_povray(const Surroundings&) const {
    return {.name = "a constant light",
            .refused =
                "POV-Ray's sky lights nothing without radiosity; take point or directional "
                "lights"};
}

}  // namespace caustics
