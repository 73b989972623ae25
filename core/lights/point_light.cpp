#include "core/lights/point_light.h"

#include <fmt/format.h>

#include <utility>

#include "core/lights/light_text.h"
#include "core/scene_file/strength.h"

namespace caustics {

using namespace scene_file;

ObjectText PointLight::text() {
    return {"point",
            "A light, in the scene.",
            {type_key(), vector("position", "Where it is.", "[0, 0, 0]"),
             transform("Where it is, in place of position."),
             strength("intensity", "Power sent into a direction.", "W/sr")}};
}

PointLight PointLight::read(const JsonNode& node, const Vec3d& origin) {
    const auto position = node.find("position");
    const auto to_world = node.find("to_world");
    if (position && to_world) to_world->fail("give either position or to_world");
    Vec3d place = Vec3d::Zero();
    if (position) place = read_vector(*position);
    if (to_world) place = read_transform(*to_world).translation();
    require_near(node, {place});
    return {Vec3d(place - origin).cast<float>(), read_strength(node, "intensity")};
}

std::string PointLight::line(const Surroundings&, const Vec3d& origin) const {
    return fmt::format("point at {}, intensity {} W/sr",
                       in_brackets(origin + position.cast<double>()), rgb(intensity));
}

void PointLight::add_to(ValueHash& hash) const {
    hash.add(position);
    hash.add(intensity);
}

std::vector<AimedSource> PointLight::aim(const Surroundings& scene) const {
    AimedSource source;
    const double solid_angle = aim_cones(scene, {position, 0}, source);
    source.power = intensity * static_cast<float>(solid_angle);
    return alone(std::move(source));
}

std::optional<Ray> PointLight::send(const Surroundings&, const AimedSource& source,
                                    const AimedSample& sample, Rng& rng) const {
    if (!kept_in_union(source, sample, rng)) return {};
    return Ray{position, sample.direction};
}

std::optional<LightArrival> PointLight::arrival(const Surroundings&, const Vec3& at, Rng&) const {
    const Vec3 towards = position - at;
    const float distance2 = towards.squaredNorm();
    return LightArrival{towards / std::sqrt(distance2), SegmentEnd{position}, intensity, distance2};
}

MitsubaEmitter PointLight::to_mitsuba() const {
    return {"point",
            {{"point", "position", position}, {"rgb", "intensity", Vec3(intensity.matrix())}}};
}

PovrayLight PointLight::to_povray(const Surroundings& scene) const {
    const double fade = 1e-5 * static_cast<double>(scene.bounds.diagonal().norm());
    return {.from = position,
            .colour = intensity.cast<double>() / (2 * pi_d * fade * fade),
            .fade_distance = fade};
}

}  // namespace caustics
