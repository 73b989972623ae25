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

// Sets the bound of the cosine, and the power, by the area times the solid angle of a source's regions [m^2 sr].
void set_power(const AreaLight& light, const Shape& on, double extent, AimedSource& source) {
    if (exact_is_flat(on))
        source.max_cosine = max_cosine(light.sampler.sample(on, 0, 0).normal, source.cones);
    source.power = light.radiance * static_cast<float>(extent) * source.max_cosine;
}

// Thinned by the cosine, by how much narrower the cone is than from the nearest place, and by the number of cones there.
std::optional<Ray> send_from(const AimedSource& source, const AimedSample& sample, Rng& rng) {
    const AimedSphere& target = source.targets[sample.region];
    const float cosine = sample.start.geometric_normal.dot(sample.direction);
    const float narrower = sample.width / target.widest;
    const auto holding = static_cast<float>(targets_that_hold(source, sample).holding);
    if (cosine * narrower <= rng.next() * source.max_cosine * holding) return {};
    return spawn_ray(sample.start, sample.direction);
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

// The source whose rays are drawn by cones from a sphere that holds so much of its area.
AimedSource AreaLight::cones_from(const Surroundings& scene, const BoundingSphere& from,
                                  double area) const {
    const Shape& on = scene.shapes[shape];
    AimedSource source;
    const double measure = aim_cones(scene, from, source);
    if (on.primitive == Primitive::sphere && !on.flip_normals) {
        source.facing_sphere = from;
        area /= 4;
    }
    set_power(*this, on, area * measure, source);
    return source;
}

// The source whose rays are drawn by cones from each place.
std::optional<AimedSource> AreaLight::spheres_from_places(const Surroundings& scene) const {
    const Shape& on = scene.shapes[shape];
    if (on.primitive == Primitive::sphere) return {};
    AimedSource source;
    const auto measure = aim_spheres(scene, on, source);
    if (!measure) return {};
    set_power(*this, on, sampler.area() * *measure, source);
    return source;
}

// Sources of equal parts of a flat light.
std::vector<AimedSource> AreaLight::pieces_of(const Surroundings& scene) const {
    std::vector<AimedSource> sources;
    for (int i = 0; i < pieces * pieces; ++i) {
        const Vec2 low = Vec2(static_cast<float>(i % pieces), static_cast<float>(i / pieces)) /
                         static_cast<float>(pieces);
        const Vec2 high =
            Vec2(static_cast<float>(i % pieces + 1), static_cast<float>(i / pieces + 1)) /
            static_cast<float>(pieces);
        sources.push_back(cones_from(scene, piece_bound(scene.shapes[shape], low, high),
                                     sampler.area() / (pieces * pieces)));
        sources.back().low = low;
        sources.back().high = high;
    }
    return sources;
}

// Aims from each point of the light if those cones are narrower than the cones from the light or from its pieces.
std::vector<AimedSource> AreaLight::aim(const Surroundings& scene) const {
    const Shape& on = scene.shapes[shape];
    const BoundingSphere from = bounding_sphere(on);
    const auto by_cones = [&] {
        return needs_pieces(scene, on) ? pieces_of(scene)
                                       : alone(cones_from(scene, from, sampler.area()));
    };
    std::optional<AimedSource> by_spheres = spheres_from_places(scene);
    if (!by_spheres) return by_cones();
    double from_middle = 0;
    for (const AimedSphere& target : by_spheres->targets)
        from_middle += cone_from(from.centre, target.sphere).solid_angle();
    std::vector<AimedSource> sources = by_cones();
    double by_pieces = 0;
    for (const AimedSource& source : sources)
        for (const AimedCone& aim : source.cones)
            by_pieces += aim.cone.solid_angle() / static_cast<double>(sources.size());
    return from_middle <= by_pieces ? alone(*std::move(by_spheres)) : std::move(sources);
}

SegmentEnd AreaLight::start(const Surroundings& scene, const AimedSource& source, Rng& rng) const {
    const Vec2 size = source.high - source.low;
    const float u0 = source.low.x() + size.x() * rng.next();
    const float u1 = source.low.y() + size.y() * rng.next();
    const auto from = sampler.sample(scene.shapes[shape], u0, u1);
    return {from.position, from.normal, from.offset};
}

std::optional<Ray> AreaLight::send(const Surroundings& scene, const AimedSource& source,
                                   const AimedSample& sample, Rng& rng) const {
    const Vec3& direction = sample.direction;
    if (!source.targets.empty()) return send_from(source, sample, rng);
    if (!kept_in_union(source, sample, rng)) return {};
    if (source.facing_sphere)
        return spawn_ray(facing_point(*source.facing_sphere, direction, rng), direction);
    const SegmentEnd from = start(scene, source, rng);
    const float cosine = from.geometric_normal.dot(direction);
    if (cosine <= rng.next() * source.max_cosine) return {};
    return spawn_ray(from, direction);
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
