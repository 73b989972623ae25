#include "core/lights/area_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/geometry/exact_shape.h"
#include "core/geometry/surface_offset.h"
#include "core/lights/light_text.h"
#include "core/scene_file/strength.h"

namespace caustics {

using namespace scene_file;

namespace {

constexpr int pieces = 8;  // of a large flat light, along each of its numbers

// Bound of n . w over the directions w of some cones.
float max_cosine(const Vec3& n, const std::vector<AimedCone>& cones) {
    float bound = 0;
    for (const AimedCone& aim : cones) {
        const float to_axis = std::acos(std::clamp(n.dot(aim.cone.axis), -1.0F, 1.0F));
        // acos of a float is good to 4e-4 rad near 0.
        bound = std::max(bound, std::cos(std::max(0.0F, to_axis - aim.cone.angle() - 1e-3F)));
    }
    return bound;
}

// A sphere round the points of a flat light whose numbers lie between low and high.
BoundingSphere piece_bound(const Shape& shape, const Vec2& low, const Vec2& high) {
    const auto local = ask_exact(shape, [&](const auto& kind) -> std::vector<Vec3d> {
        if constexpr (requires { kind.piece(low, high); })
            return kind.piece(low, high);
        else
            throw std::logic_error("only flat lights have pieces");
    });
    BoundingSphere bound = bounding_sphere(to_world(shape, local));
    bound.radius *= 1 + 1e-5F;
    return bound;
}

// Whether the light is so large that it is better aimed piece by piece.
bool needs_pieces(const Surroundings& scene, const Shape& shape) {
    const BoundingSphere light = bounding_sphere(shape);
    const auto near = [&](std::uint32_t caster) {
        const BoundingSphere other = bounding_sphere(scene.shapes[caster]);
        return light.radius > 0.25F * ((other.centre - light.centre).norm() - other.radius);
    };
    return exact_is_flat(shape) && std::ranges::any_of(scene.casters, near);
}

// A point of a sphere, uniform across `direction`, on the side that shines along it.
SegmentEnd facing_point(const BoundingSphere& sphere, const Vec3& direction, Rng& rng) {
    const float u0 = rng.next();
    const float u1 = rng.next();
    const Vec2 disc = concentric_disc(u0, u1);
    const float height = std::sqrt(std::max(0.0F, 1 - disc.squaredNorm()));
    const Vec3 normal = Frame(direction).to_world({disc.x(), disc.y(), height});
    const Vec3 position = sphere.centre + sphere.radius * normal;
    return {position, normal, rounding_offset(position)};
}

}  // namespace

ObjectText AreaLight::text() {
    return {"area",
            "A light, in a shape that shines from its front side.",
            {type_key(), strength("radiance", "Of the surface.", "W/(m^2 sr)")}};
}

Spectrum AreaLight::read(const JsonNode& node) { return read_strength(node, "radiance"); }

std::string AreaLight::line(const Surroundings& scene, const Vec3d&) const {
    return fmt::format("area on {}, {:.6g} m^2, radiance {} W/(m^2 sr)", scene.shapes[shape].name,
                       sampler.area(), rgb(radiance));
}

void AreaLight::add_to(ValueHash& hash) const {
    hash.add(shape);
    hash.add(radiance);
}

// One source, or one a piece where the light is large.
std::vector<AimedSource> AreaLight::aim(const Surroundings& scene) const {
    std::vector<AimedSource> sources;
    const Shape& on = scene.shapes[shape];
    const int n = needs_pieces(scene, on) ? pieces : 1;
    for (int i = 0; i < n * n; ++i) {
        AimedSource source;
        source.low =
            Vec2(static_cast<float>(i % n), static_cast<float>(i / n)) / static_cast<float>(n);
        source.high = Vec2(static_cast<float>(i % n + 1), static_cast<float>(i / n + 1)) /
                      static_cast<float>(n);
        const BoundingSphere from =
            n == 1 ? bounding_sphere(on) : piece_bound(on, source.low, source.high);
        const double measure = aim_cones(scene, from, source);
        double area = sampler.area() / (n * n);
        if (on.primitive == Primitive::sphere && !on.flip_normals) {
            source.facing_sphere = from;
            area /= 4;
        }
        if (exact_is_flat(on)) {
            const Vec3 normal = sampler.sample(on, 0, 0).normal;
            source.max_cosine = max_cosine(normal, source.cones);
        }
        source.power = radiance * static_cast<float>(area * measure) * source.max_cosine;
        sources.push_back(std::move(source));
    }
    return sources;
}

std::optional<Ray> AreaLight::send(const Surroundings& scene, const AimedSource& source,
                                   const AimedSample& sample, Rng& rng) const {
    if (!kept_in_union(source, sample, rng)) return {};
    const Vec3& direction = sample.direction;
    if (source.facing_sphere)
        return spawn_ray(facing_point(*source.facing_sphere, direction, rng), direction);
    const Vec2 size = source.high - source.low;
    const float u0 = source.low.x() + size.x() * rng.next();
    const float u1 = source.low.y() + size.y() * rng.next();
    const auto start = sampler.sample(scene.shapes[shape], u0, u1);
    const float cosine = start.normal.dot(direction);
    if (cosine <= rng.next() * source.max_cosine) return {};
    return spawn_ray({start.position, start.normal, start.offset}, direction);
}

std::optional<LightArrival> AreaLight::arrival(const Surroundings& scene, const Vec3& at,
                                               Rng& rng) const {
    const float u0 = rng.next();
    const float u1 = rng.next();
    const auto from = sampler.sample(scene.shapes[shape], u0, u1);
    const Vec3 towards = from.position - at;
    const float distance2 = towards.squaredNorm();
    if (distance2 == 0) return {};
    const Vec3 wi = towards / std::sqrt(distance2);
    const float cos_light = -from.normal.dot(wi);
    if (cos_light <= 0) return {};
    return LightArrival{wi, SegmentEnd{from.position, from.normal, from.offset}, radiance,
                        pdf_w(distance2, cos_light), false};
}

}  // namespace caustics
