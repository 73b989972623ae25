#include "core/lights/light.h"

#include <stdexcept>

#include "core/base/each_kind.h"
#include "core/lights/ambient_light.h"

namespace caustics {
namespace {

/// A kind that a scene file holds as an object of its own.
template <class Kind>
concept StandsAlone = requires(const JsonNode& node, const Vec3d& origin) {
    { Kind::read(node, origin) } -> std::same_as<Kind>;
};

std::logic_error of_a_shape() { return std::logic_error("a light of a shape is the shape's"); }

}  // namespace

int family_of(const Light& light) {
    return std::visit([](const auto& kind) { return kind.family; }, light);
}

std::string type_of(const Light& light) {
    return std::visit([]<class Kind>(const Kind&) { return name_of<Kind>(); }, light);
}

std::string line_of(const Light& light, const Surroundings& scene, const Vec3d& origin) {
    return std::visit([&](const auto& kind) { return kind.line(scene, origin); }, light);
}

void add_to(ValueHash& hash, const Light& light) {
    std::visit([&](const auto& kind) { kind.add_to(hash); }, light);
}

std::vector<AimedSource> aim(const Light& light, const Surroundings& scene) {
    return std::visit([&](const auto& kind) { return kind.aim(scene); }, light);
}

SegmentEnd start_of(const Light& light, const Surroundings& scene, const AimedSource& source,
                    Rng& rng) {
    return std::visit(
        [&](const auto& kind) -> SegmentEnd {
            if constexpr (requires { kind.start(scene, source, rng); })
                return kind.start(scene, source, rng);
            else
                throw std::logic_error("a light without targets has no places");
        },
        light);
}

std::optional<Ray> send(const Light& light, const Surroundings& scene, const AimedSource& source,
                        const AimedSample& sample, Rng& rng) {
    return std::visit([&](const auto& kind) { return kind.send(scene, source, sample, rng); },
                      light);
}

std::optional<LightArrival> arrival_from(const Light& light, const Surroundings& scene,
                                         const Vec3& at, Rng& rng) {
    return std::visit(
        [&](const auto& kind) -> std::optional<LightArrival> {
            if constexpr (requires { kind.arrival(scene, at, rng); })
                return kind.arrival(scene, at, rng);
            else
                return {};
        },
        light);
}

std::optional<LightPoint> point_of(const Light& light) {
    return std::visit(
        [](const auto& kind) -> std::optional<LightPoint> {
            if constexpr (requires { kind.point(); })
                return kind.point();
            else
                return {};
        },
        light);
}

Spectrum background_of(const Light& light) {
    return std::visit(
        [](const auto& kind) -> Spectrum {
            if constexpr (requires { kind.background(); })
                return kind.background();
            else
                return black();
        },
        light);
}

bool surrounds(const Light& light) {
    return std::visit([](const auto& kind) { return requires { kind.background(); }; }, light);
}

bool has_extent(const Light& light) {
    return std::visit([](const auto& kind) { return !requires { kind.point(); }; }, light);
}

void scale(Light& light, const Spectrum& factor) {
    std::visit(
        [&](auto& kind) {
            if constexpr (requires { kind.scale(factor); })
                kind.scale(factor);
            else
                throw of_a_shape();
        },
        light);
}

MitsubaEmitter to_mitsuba(const Light& light) {
    return std::visit(
        [](const auto& kind) -> MitsubaEmitter {
            if constexpr (requires { kind.to_mitsuba(); })
                return kind.to_mitsuba();
            else
                throw of_a_shape();
        },
        light);
}

PovrayLight to_povray(const Light& light, const Surroundings& scene) {
    return std::visit(
        [&](const auto& kind) -> PovrayLight {
            if constexpr (requires { kind.to_povray(scene); })
                return kind.to_povray(scene);
            else
                throw of_a_shape();
        },
        light);
}

const std::vector<std::string>& light_types() {
    static const std::vector<std::string> types = [] {
        std::vector<std::string> all;
        each_kind(std::type_identity<Light>(), [&]<class Kind>(std::type_identity<Kind>) {
            if constexpr (StandsAlone<Kind>) all.push_back(name_of<Kind>());
        });
        return all;
    }();
    return types;
}

Light read_light(const std::string& type, const JsonNode& node, const Vec3d& origin) {
    std::optional<Light> light;
    each_kind(std::type_identity<Light>(), [&]<class Kind>(std::type_identity<Kind>) {
        if constexpr (StandsAlone<Kind>)
            if (name_of<Kind>() == type) light = Kind::read(node, origin);
    });
    if (!light) throw std::logic_error("no light of that type");
    node.finish();
    return *light;
}

scene_file::Objects light_keys() {
    scene_file::Objects all;
    each_kind(std::type_identity<Light>(), [&]<class Kind>(std::type_identity<Kind>) {
        if constexpr (StandsAlone<Kind>) all.push_back(Kind::text());
    });
    all.push_back(AmbientLight::text());
    all.push_back(AreaLight::text());
    return all;
}

}  // namespace caustics
