#include "core/lights/spot_light.h"

#include <fmt/format.h>

#include <utility>

#include "core/lights/light_text.h"
#include "core/lights/point_light.h"
#include "core/scene_file/strength.h"

namespace caustics {

using namespace scene_file;

namespace {

constexpr double degree = pi_d / 180;

double degrees(float radians) { return static_cast<double>(radians) / degree; }

// Keeps the cones that the light may shine into, or takes its own cone where that is smaller; returns
// their solid angle [sr].
double narrowed(const SpotCone& spot, double solid_angle, AimedSource& source) {
    const DirectionCone own =
        spot.cutoff < 1.5F
            ? cone_of_half_angle(spot.axis.cast<double>(), static_cast<double>(spot.cutoff) + 1e-6)
            : DirectionCone{};
    if (own.is_whole_sphere() || own.solid_angle() >= solid_angle) return solid_angle;
    source.cones = {{own, Frame(own.axis)}};
    source.cumulative = {1};
    source.boxes = {};
    return own.solid_angle();
}

}  // namespace

ObjectText SpotLight::text() {
    return {"spot",
            "A light, in the scene: from a point, about an axis.",
            {type_key(), transform("Where it is, and its axis: +z."),
             strength("intensity", "Power sent along the axis.", "W/sr"),
             number("cutoff_angle", "From the axis to where no light goes.", "degrees", "20",
                    "0.001 to 179"),
             number("beam_width", "From the axis to where the light begins to fall, linearly.",
                    "degrees", "0.75 times cutoff_angle", "0 to cutoff_angle")}};
}

SpotLight SpotLight::read(const JsonNode& node, const Vec3d& origin) {
    Transform to_world = Transform::Identity();
    if (const auto given = node.find("to_world")) to_world = read_transform(*given);
    double cutoff = 20;
    if (const auto angle = node.find("cutoff_angle")) cutoff = angle->as_number_in(1e-3, 179);
    double beam = 0.75 * cutoff;
    if (const auto width = node.find("beam_width")) beam = width->as_number_in(0, cutoff);
    const Vec3d place = to_world.translation();
    require_near(node, {place});
    return {Vec3d(place - origin).cast<float>(),
            read_strength(node, "intensity"),
            {.axis = Vec3d(to_world.linear().col(2)).normalized().cast<float>(),
             .beam_width = static_cast<float>(beam * degree),
             .cutoff = static_cast<float>(cutoff * degree)}};
}

std::string SpotLight::line(const Surroundings&, const Vec3d& origin) const {
    return fmt::format(
        "spot at {}, intensity {} W/sr along {}, whole up to {:.6g} degrees, none from {:.6g} on",
        in_brackets(origin + position.cast<double>()), rgb(intensity), in_brackets(cone.axis),
        degrees(cone.beam_width), degrees(cone.cutoff));
}

void SpotLight::add_to(ValueHash& hash) const {
    hash.add(position);
    hash.add(intensity);
    hash.add(cone.axis);
    hash.add(cone.beam_width);
    hash.add(cone.cutoff);
}

std::vector<AimedSource> SpotLight::aim(const Surroundings& scene) const {
    AimedSource source;
    const double solid_angle = narrowed(cone, aim_cones(scene, {position, 0}, source), source);
    source.power = intensity * static_cast<float>(solid_angle);
    return alone(std::move(source));
}

// Thinned by the falloff.
std::optional<Ray> SpotLight::send(const Surroundings&, const AimedSource& source,
                                   const AimedSample& sample, Rng& rng) const {
    if (!kept_in_union(source, sample, rng)) return {};
    if (!(rng.next() < cone.falloff(sample.direction))) return {};
    return Ray{position, sample.direction};
}

std::optional<LightArrival> SpotLight::arrival(const Surroundings& scene, const Vec3& at,
                                               Rng& rng) const {
    auto arrival = PointLight{position, intensity}.arrival(scene, at, rng);
    arrival->strength *= cone.falloff(-arrival->wi);
    return arrival;
}

MitsubaEmitter SpotLight::to_mitsuba() const {
    const Frame frame(cone.axis);
    Eigen::Matrix4d to_world = Eigen::Matrix4d::Identity();
    to_world.col(0).head<3>() = frame.s.cast<double>();
    to_world.col(1).head<3>() = frame.t.cast<double>();
    to_world.col(2).head<3>() = cone.axis.cast<double>();
    to_world.col(3).head<3>() = position.cast<double>();
    return {"spot",
            {{"float", "cutoff_angle", degrees(cone.cutoff)},
             {"float", "beam_width", degrees(cone.beam_width)},
             {"rgb", "intensity", Vec3(intensity.matrix())}},
            to_world};
}

PovrayLight SpotLight::to_povray(const Surroundings&) const {
    return {.name = "a spot light",
            .refused = "POV-Ray's falls off by another curve (a point light can be written)"};
}

}  // namespace caustics
