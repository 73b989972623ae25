#include "core/lights/aimed_source.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/base/interrupt.h"
#include "core/geometry/exact_shape.h"

namespace caustics {

std::vector<Vec3> to_world(const Shape& shape, const std::vector<Vec3d>& local) {
    std::vector<Vec3> points;
    for (const Vec3d& p : local) points.push_back(Vec3d(shape.to_world * p).cast<float>());
    return points;
}

namespace {

// A part of a caster that is aimed at by itself: a sphere, or the convex hull of some points.
struct Target {
    BoundingSphere bound;
    std::span<const Vec3> hull;  // empty: the sphere itself
};

// Hulls of the parts that it is better aimed at one by one; none where it has none.
std::vector<std::vector<Vec3>> parts_of(const Shape& shape) {
    std::vector<std::vector<Vec3>> parts;
    if (shape.primitive == Primitive::mesh) return parts;
    ask_exact(shape, [&](const auto& kind) {
        if constexpr (requires { kind.hulls(); })
            for (const std::vector<Vec3d>& local : kind.hulls())
                parts.push_back(to_world(shape, local));
    });
    return parts;
}

// A cone that holds all directions from the points of a sphere to a target. Round the target's
// middle: a direction to one of its corners turns by at most asin(radius / distance) as its start
// moves about the sphere, and a cone narrower than a right angle is convex, so it holds what the
// corners span. Throws Interrupted when somebody asked.
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
    constexpr std::size_t corners_between_looks = 1 << 16;
    for (std::size_t i = 0; i < target.hull.size(); ++i) {
        if (i % corners_between_looks == 0) throw_if_interrupted();
        const Vec3d to_corner = target.hull[i].cast<double>() - start;
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

// The cones from a sphere towards one caster, or towards its parts where that is less to fill.
std::vector<DirectionCone> cones_towards(const BoundingSphere& from, const Shape& caster) {
    std::vector<Vec3> corners;
    std::span<const Vec3> hull;
    if (caster.primitive != Primitive::sphere) hull = hull_points(caster, corners);
    const std::vector<DirectionCone> one = {cone_towards(from, {bounding_sphere(caster), hull})};
    std::vector<DirectionCone> cones;
    for (const std::vector<Vec3>& part : parts_of(caster))
        cones.push_back(cone_towards(from, {bounding_sphere(part), part}));
    return !cones.empty() && measure_of(cones) < measure_of(one) ? cones : one;
}

BoundingSphere sphere_round(const Box& box) { return {box.center(), 0.5F * box.diagonal().norm()}; }

// The unit vectors of a cone lie in a ball about its axis. Roundings of the box are below 1e-7.
Box box_of_cone(const DirectionCone& cone) {
    const Vec3 reach = Vec3::Constant(std::sqrt(2 * cone.one_minus_cos) * (1 + 1e-5F) + 4e-7F);
    return {cone.axis - reach, cone.axis + reach};
}

// True where a line meets a box, or comes so near that rounding may let it meet a sphere in the box.
bool line_meets(const Box& box, const Vec3& point, const Vec3& along) {
    const Vec3 offset = box.center() - point;
    const Vec3 half = 0.5F * box.sizes();
    const Vec3 a = along.cwiseAbs();
    const Vec3 aside = offset.cross(along).cwiseAbs();
    const Vec3 reach(half.y() * a.z() + half.z() * a.y(), half.z() * a.x() + half.x() * a.z(),
                     half.x() * a.y() + half.y() * a.x());
    const float rounding = 4e-6F * (offset.lpNorm<1>() + half.sum() + point.lpNorm<1>());
    return ((aside - reach).array() <= rounding).all();
}

// Counts the regions that hold a sample: only those are asked whose boxes meet it.
template <typename Meets, typename Holds>
Overlap overlap_of(const AimedSource& source, const AimedSample& sample, const Meets& meets,
                   const Holds& holds) {
    Overlap overlap;
    source.boxes.any_where(
        [&](const Box& box) {
            ++overlap.boxes_tested;
            return meets(box);
        },
        [&](std::uint32_t i) {
            if (i != sample.region && holds(i)) ++overlap.holding;
            return false;
        });
    return overlap;
}

void normalise(std::vector<double>& measures) {
    double sum = 0;
    for (double& measure : measures) measure = sum += measure;
    for (double& share : measures) share /= sum;
}

// A bound of how near a shape comes to a point.
float least_distance(const Shape& shape, const BoundingSphere& round, const Vec3& point) {
    float least = std::max((point - round.centre).norm() - round.radius,
                           bounds(shape).exteriorDistance(point));
    if (exact_is_flat(shape)) {
        const auto on = AreaSampler(shape).sample(shape, 0, 0);
        least = std::max(least, std::abs(on.normal.dot(point - on.position)));
    }
    return least;
}

void add_cones(const std::vector<DirectionCone>& cones, AimedSource& source) {
    std::vector<Box> boxes;
    for (const DirectionCone& cone : cones) {
        source.cones.push_back({cone, Frame(cone.axis)});
        source.cumulative.push_back(cone.solid_angle());
        if (cones.size() > 1) boxes.push_back(box_of_cone(cone));
    }
    source.boxes = BoxTree(std::move(boxes));
    normalise(source.cumulative);
}

}  // namespace

DirectionCone cone_of_half_angle(const Vec3d& axis, double half_angle) {
    const double sine = std::sin(half_angle / 2);
    return {axis.cast<float>(), static_cast<float>(2 * sine * sine)};
}

double aim_cones(const Surroundings& scene, const BoundingSphere& from, AimedSource& source) {
    std::vector<DirectionCone> cones;
    if (scene.everywhere) {
        cones.push_back(cone_towards(from, {sphere_round(scene.bounds), {}}));
    } else {
        for (const std::uint32_t caster : scene.casters)
            for (const DirectionCone& cone : cones_towards(from, scene.shapes[caster]))
                cones.push_back(cone);
    }
    // All directions hold every other cone: they alone are the union.
    for (const DirectionCone& cone : cones)
        if (cone.is_whole_sphere()) {
            cones = {DirectionCone{}};
            break;
        }
    add_cones(cones, source);
    return measure_of(cones);
}

double aim_discs(const Surroundings& scene, AimedSource& source) {
    double total = 0;
    std::vector<BoundingSphere> spheres;
    if (scene.everywhere) {
        spheres.push_back(sphere_round(scene.bounds));
    } else {
        for (const std::uint32_t caster : scene.casters)
            spheres.push_back(bounding_sphere(scene.shapes[caster]));
    }
    std::vector<Box> boxes;
    for (const BoundingSphere& sphere : spheres) {
        const float radius = sphere.radius * (1 + 1e-5F);
        source.discs.push_back({sphere.centre, radius});
        const Vec3 reach = Vec3::Constant(radius);
        if (spheres.size() > 1) boxes.emplace_back(sphere.centre - reach, sphere.centre + reach);
        source.cumulative.push_back(pi_d * static_cast<double>(radius) *
                                    static_cast<double>(radius));
        total += source.cumulative.back();
    }
    source.boxes = BoxTree(std::move(boxes));
    normalise(source.cumulative);
    return total;
}

DirectionCone cone_from(const Vec3& place, const BoundingSphere& sphere) {
    const Vec3 way = sphere.centre - place;
    const float distance = way.norm();
    return DirectionCone::from_sine(way / distance, sphere.radius / distance);
}

std::optional<double> aim_spheres(const Surroundings& scene, const Shape& from,
                                  AimedSource& source) {
    if (scene.everywhere) return {};
    const BoundingSphere round = bounding_sphere(from);
    std::vector<DirectionCone> cones;
    std::vector<AimedSphere> targets;
    for (const std::uint32_t caster : scene.casters) {
        BoundingSphere sphere = bounding_sphere(scene.shapes[caster]);
        sphere.radius *= 1 + 1e-5F;
        const float nearest = least_distance(from, round, sphere.centre) * (1 - 1e-5F);
        cones.push_back(cone_towards(round, {sphere, {}}));
        if (!(nearest > sphere.radius) || cones.back().is_whole_sphere()) return {};
        targets.push_back(
            {sphere,
             DirectionCone::from_sine(Vec3::UnitZ(), sphere.radius / nearest).one_minus_cos});
    }
    add_cones(cones, source);
    source.targets = std::move(targets);
    source.cumulative.clear();
    double measure = 0;
    for (const AimedSphere& target : source.targets) {
        const double solid_angle = DirectionCone{Vec3::UnitZ(), target.widest}.solid_angle();
        source.cumulative.push_back(solid_angle);
        measure += solid_angle;
    }
    normalise(source.cumulative);
    return measure;
}

Overlap cones_that_hold(const AimedSource& source, const AimedSample& sample) {
    return overlap_of(
        source, sample, [&](const Box& box) { return box.contains(sample.direction); },
        [&](std::uint32_t i) { return source.cones[i].cone.contains(sample.direction); });
}

Overlap targets_that_hold(const AimedSource& source, const AimedSample& sample) {
    return overlap_of(
        source, sample, [&](const Box& box) { return box.contains(sample.direction); },
        [&](std::uint32_t i) {
            return cone_from(sample.start.position, source.targets[i].sphere)
                .contains(sample.direction);
        });
}

Overlap discs_that_hold(const AimedSource& source, const AimedSample& sample, const Vec3& point,
                        const Vec3& along) {
    return overlap_of(
        source, sample, [&](const Box& box) { return line_meets(box, point, along); },
        [&](std::uint32_t i) {
            const AimedDisc& other = source.discs[i];
            const Vec3 offset = point - other.centre;
            return Vec3(offset - offset.dot(along) * along).norm() <= other.radius;
        });
}

// Thinning by the number of cones that hold the direction makes their union uniform.
bool kept_in_union(const AimedSource& source, const AimedSample& sample, Rng& rng) {
    const int holding = cones_that_hold(source, sample).holding;
    return holding == 1 || rng.next() * static_cast<float>(holding) < 1;
}

std::optional<Ray> through_disc(const Surroundings& scene, const AimedSource& source,
                                const AimedSample& sample, const Frame& across, Rng& rng) {
    const AimedDisc& disc = source.discs[sample.region];
    const Vec3& along = across.n;
    const Vec3 point =
        disc.centre + disc.radius * (across.s * sample.disc.x() + across.t * sample.disc.y());
    const int holding = discs_that_hold(source, sample, point, along).holding;
    if (holding > 1 && rng.next() * static_cast<float>(holding) >= 1) return {};
    return Ray{point + distance_to_entry(scene.bounds, point, along) * along, along};
}

}  // namespace caustics
