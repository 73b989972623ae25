#include "core/lights/directional_light.h"

#include <fmt/format.h>

#include <utility>

#include "core/lights/light_text.h"
#include "core/scene_file/strength.h"

namespace caustics {

using namespace scene_file;

ObjectText DirectionalLight::text() {
    return {"directional",
            "A light, in the scene: parallel rays from far away.",
            {type_key(),
             {.key = "direction",
              .meaning = "Where the light goes, of any length.",
              .type = "[x, y, z]",
              .usual = "[0, 0, 1]"},
             transform("The light goes along its +z, in place of direction."),
             strength("irradiance", "On a surface across the light.", "W/m^2")}};
}

DirectionalLight DirectionalLight::read(const JsonNode& node, const Vec3d&) {
    Vec3d towards = Vec3d::UnitZ();
    const auto direction = node.find("direction");
    const auto to_world = node.find("to_world");
    if (direction && to_world) to_world->fail("give either direction or to_world");
    if (direction) {
        towards = read_vector(*direction);
        if (towards.norm() == 0) direction->fail("must not be zero");
    }
    if (to_world) towards = read_transform(*to_world).linear().col(2);
    return {towards.normalized().cast<float>(), read_strength(node, "irradiance")};
}

std::string DirectionalLight::line(const Surroundings&, const Vec3d&) const {
    return fmt::format("directional along {}, irradiance {} W/m^2", in_brackets(direction),
                       rgb(irradiance));
}

void DirectionalLight::add_to(ValueHash& hash) const {
    hash.add(direction);
    hash.add(irradiance);
}

std::vector<AimedSource> DirectionalLight::aim(const Surroundings& scene) const {
    AimedSource source;
    source.across = Frame(direction);
    source.power = irradiance * static_cast<float>(aim_discs(scene, source));
    return alone(std::move(source));
}

std::optional<Ray> DirectionalLight::send(const Surroundings& scene, const AimedSource& source,
                                          const AimedSample& sample, Rng& rng) const {
    return through_disc(scene, source, sample, source.across, rng);
}

std::optional<LightArrival> DirectionalLight::arrival(const Surroundings&, const Vec3&,
                                                      Rng&) const {
    return LightArrival{.wi = -direction, .strength = irradiance};
}

MitsubaEmitter DirectionalLight::to_mitsuba() const {
    return {"directional",
            {{"vector", "direction", direction}, {"rgb", "irradiance", Vec3(irradiance.matrix())}}};
}

PovrayLight DirectionalLight::to_povray(const Surroundings& scene) const {
    const Vec3 centre = scene.bounds.center();
    return {.from = centre - 2 * scene.bounds.diagonal().norm() * direction,
            .colour = irradiance.cast<double>() / pi_d,
            .point_at = centre};
}

}  // namespace caustics
