#include "core/light_path/aimed_source.h"

#include <algorithm>
#include <cmath>

namespace caustics {
namespace {

constexpr int cylinder_sectors = 16;
constexpr int light_pieces = 8;  // of a large flat light, along each of its numbers

// A part of a caster that is aimed at by itself: a sphere, or the convex hull of some points.
struct Target {
    BoundingSphere bound;
    std::vector<Vec3> hull;  // empty: the sphere itself
};

std::vector<Vec3> to_world(const Shape& shape, const std::vector<Vec3d>& local) {
    std::vector<Vec3> points;
    for (const Vec3d& p : local) points.push_back(Vec3d(shape.to_world * p).cast<float>());
    return points;
}

// Corners of the prism round a sector of the unit disc's rim or, from radius r0 on, of its area.
std::vector<Vec3d> sector_hull(double from, double to, double r0, double height) {
    const double middle = (from + to) / 2;
    const double tangent = 1 / std::cos((to - from) / 2);
    std::vector<Vec3d> corners;
    for (const double z : {0.0, height})
        for (const Vec2d& p :
             {Vec2d(std::cos(from), std::sin(from)), Vec2d(std::cos(to), std::sin(to)),
              Vec2d(tangent * std::cos(middle), tangent * std::sin(middle)),
              Vec2d(r0 * std::cos(from), r0 * std::sin(from)),
              Vec2d(r0 * std::cos(to), r0 * std::sin(to))})
            corners.emplace_back(p.x(), p.y(), z);
    return corners;
}

Target whole(const Shape& shape) {
    if (shape.primitive == Primitive::sphere) return {bounding_sphere(shape), {}};
    return {bounding_sphere(shape), hull_points(shape)};
}

// The sectors of a tube.
std::vector<Target> sectors(const Shape& shape) {
    std::vector<Target> parts;
    for (int i = 0; i < cylinder_sectors; ++i) {
        const double step = 2 * pi_d / cylinder_sectors;
        const auto hull = to_world(shape, sector_hull(i * step, (i + 1) * step, 1, 1));
        parts.push_back({bounding_sphere(hull), hull});
    }
    return parts;
}

DirectionCone cone_of_half_angle(const Vec3d& axis, double half_angle) {
    const double sine = std::sin(half_angle / 2);
    return {axis.cast<float>(), static_cast<float>(2 * sine * sine)};
}

// A cone that holds all directions from the points of a sphere to a target. Round the target's
// middle: a direction to one of its corners turns by at most asin(radius / distance) as its start
// moves about the sphere, and a cone narrower than a right angle is convex, so it holds what the
// corners span.
DirectionCone cone_towards(const BoundingSphere& from, const Target& target) {
    const Vec3d start = from.centre.cast<double>();
    const Vec3d towards = target.bound.centre.cast<double>() - start;
    const double distance = towards.norm();
    if (distance == 0) return {};
    const Vec3d axis = towards / distance;
    const auto radius = static_cast<double>(from.radius);
    const double sine = (static_cast<double>(target.bound.radius) + radius) / distance * (1 + 1e-5);
    double half_angle = sine < 1 ? std::asin(sine) : pi_d;
    double by_corners = target.hull.empty() ? pi_d : 0;
    double widest_cosine = 2, widest_reach = 0;
    for (const Vec3& corner : target.hull) {
        const Vec3d to_corner = corner.cast<double>() - start;
        const double reach = to_corner.norm();
        if (reach <= radius) by_corners = pi_d;
        if (by_corners >= pi_d) break;
        const double cosine = axis.dot(to_corner) / reach;
        if (cosine >= widest_cosine && (radius == 0 || reach >= widest_reach)) continue;
        const double turned = std::atan2(axis.cross(to_corner).norm(), axis.dot(to_corner)) +
                              std::asin(radius / reach);
        if (turned <= by_corners) continue;
        by_corners = turned;
        widest_cosine = cosine;
        widest_reach = reach;
    }
    // Unit vectors are good to 1e-7: widened by a few times that.
    by_corners = by_corners * (1 + 1e-5) + 4e-7;
    half_angle = std::min(half_angle, by_corners);
    return half_angle < 1.55 ? cone_of_half_angle(axis, half_angle) : DirectionCone{};
}

double measure_of(const std::vector<DirectionCone>& cones) {
    double sum = 0;
    for (const DirectionCone& cone : cones) sum += cone.solid_angle();
    return sum;
}

// The cones from a sphere towards one caster. A tube is mostly air, so it is aimed at by sectors
// where that is less to fill.
std::vector<DirectionCone> cones_towards(const BoundingSphere& from, const Shape& caster) {
    const std::vector<DirectionCone> one = {cone_towards(from, whole(caster))};
    if (caster.primitive != Primitive::cylinder) return one;
    std::vector<DirectionCone> cones;
    for (const Target& sector : sectors(caster)) cones.push_back(cone_towards(from, sector));
    return measure_of(cones) < measure_of(one) ? cones : one;
}

void normalise(std::vector<double>& measures) {
    double sum = 0;
    for (double& measure : measures) measure = sum += measure;
    for (double& share : measures) share /= sum;
}

// Fills the cones from a sphere to all casters; returns their solid angle [sr].
double aim_cones(const Scene& scene, const BoundingSphere& from, AimedSource& source) {
    std::vector<DirectionCone> cones;
    for (const std::uint32_t caster : scene.casters())
        for (const DirectionCone& cone : cones_towards(from, scene.shapes()[caster]))
            cones.push_back(cone);
    // All directions hold every other cone: they alone are the union.
    for (const DirectionCone& cone : cones)
        if (cone.is_whole_sphere()) {
            cones = {DirectionCone{}};
            break;
        }
    for (const DirectionCone& cone : cones) {
        source.cones.push_back({cone, Frame(cone.axis)});
        source.cumulative.push_back(cone.solid_angle());
    }
    normalise(source.cumulative);
    return measure_of(cones);
}

// Keeps the cones that a spot light may shine into, or takes its own cone where that is smaller; returns
// their solid angle [sr].
double narrowed(const SpotCone& spot, double solid_angle, AimedSource& source) {
    const DirectionCone own =
        spot.cutoff < 1.5F
            ? cone_of_half_angle(spot.axis.cast<double>(), static_cast<double>(spot.cutoff) + 1e-6)
            : DirectionCone{};
    if (own.is_whole_sphere() || own.solid_angle() >= solid_angle) return solid_angle;
    source.cones = {{own, Frame(own.axis)}};
    source.cumulative = {1};
    return own.solid_angle();
}

// Fills the discs of a light from far away; returns their area [m^2].
double aim_discs(const Scene& scene, AimedSource& source) {
    double total = 0;
    for (const std::uint32_t caster : scene.casters()) {
        const BoundingSphere sphere = bounding_sphere(scene.shapes()[caster]);
        const float radius = sphere.radius * (1 + 1e-5F);
        source.discs.push_back({sphere.centre, radius});
        source.cumulative.push_back(pi_d * static_cast<double>(radius) *
                                    static_cast<double>(radius));
        total += source.cumulative.back();
    }
    normalise(source.cumulative);
    return total;
}

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
    std::vector<Vec3d> local;
    if (shape.primitive == Primitive::disk) {
        // The sampler's radius is the root of the first number; its inner corners lie closer in.
        const double from = 2 * pi_d * static_cast<double>(low.y());
        const double to = 2 * pi_d * static_cast<double>(high.y());
        const auto outer = std::sqrt(static_cast<double>(high.x()));
        const auto inner = std::sqrt(static_cast<double>(low.x())) / outer;
        for (const Vec3d& p : sector_hull(from, to, inner, 0)) local.push_back(outer * p);
    } else {
        for (const float x : {low.x(), high.x()})
            for (const float y : {low.y(), high.y()})
                local.emplace_back(2 * static_cast<double>(x) - 1, 2 * static_cast<double>(y) - 1,
                                   0);
    }
    BoundingSphere bound = bounding_sphere(to_world(shape, local));
    bound.radius *= 1 + 1e-5F;
    return bound;
}

bool is_flat(const Shape& shape) {
    return shape.primitive == Primitive::rectangle || shape.primitive == Primitive::disk;
}

// Whether the light is so large that it is better aimed piece by piece.
bool is_large(const Scene& scene, const Shape& shape) {
    const BoundingSphere light = bounding_sphere(shape);
    const auto near = [&](std::uint32_t caster) {
        const BoundingSphere other = bounding_sphere(scene.shapes()[caster]);
        return light.radius > 0.25F * ((other.centre - light.centre).norm() - other.radius);
    };
    return is_flat(shape) && std::ranges::any_of(scene.casters(), near);
}

// One source, or one a piece where the light is large.
void add_area_light(const Scene& scene, std::uint32_t index, std::vector<AimedSource>& sources) {
    const auto& light = std::get<AreaLight>(scene.lights()[index]);
    const Shape& shape = scene.shapes()[light.shape];
    const int n = is_large(scene, shape) ? light_pieces : 1;
    for (int i = 0; i < n * n; ++i) {
        AimedSource source;
        source.light = index;
        source.low =
            Vec2(static_cast<float>(i % n), static_cast<float>(i / n)) / static_cast<float>(n);
        source.high = Vec2(static_cast<float>(i % n + 1), static_cast<float>(i / n + 1)) /
                      static_cast<float>(n);
        const BoundingSphere from =
            n == 1 ? bounding_sphere(shape) : piece_bound(shape, source.low, source.high);
        const double measure = aim_cones(scene, from, source);
        double area = light.sampler.area() / (n * n);
        if (shape.primitive == Primitive::sphere && !shape.flip_normals) {
            source.facing_sphere = from;
            area /= 4;
        }
        if (is_flat(shape)) {
            const Vec3 normal = light.sampler.sample(shape, 0, 0).normal;
            source.max_cosine = max_cosine(normal, source.cones);
        }
        source.power = light.radiance * static_cast<float>(area * measure) * source.max_cosine;
        sources.push_back(std::move(source));
    }
}

}  // namespace

std::vector<AimedSource> aimed_sources(const Scene& scene) {
    std::vector<AimedSource> sources;
    if (scene.casters().empty()) return sources;
    for (std::uint32_t i = 0; i < scene.lights().size(); ++i) {
        const Light& light = scene.lights()[i];
        if (std::holds_alternative<AreaLight>(light)) {
            add_area_light(scene, i, sources);
            continue;
        }
        AimedSource source;
        source.light = i;
        if (const auto* directional = std::get_if<DirectionalLight>(&light)) {
            source.across = Frame(directional->direction);
            const double area = aim_discs(scene, source);
            source.power = directional->irradiance * static_cast<float>(area);
        } else if (const auto* constant = std::get_if<ConstantLight>(&light)) {
            const double area = aim_discs(scene, source);
            source.power = constant->radiance * static_cast<float>(4 * pi_d * area);
        } else {
            const auto& point = std::get<PointLight>(light);
            double solid_angle = aim_cones(scene, {point.position, 0}, source);
            if (point.spot) solid_angle = narrowed(*point.spot, solid_angle, source);
            source.power = point.intensity * static_cast<float>(solid_angle);
        }
        sources.push_back(std::move(source));
    }
    std::erase_if(sources, [](const AimedSource& source) { return is_black(source.power); });
    return sources;
}

}  // namespace caustics
