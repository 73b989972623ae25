#include "beamtree/tracing/ray_arrival.h"

#include <cmath>
#include <optional>

#include "core/material/optics.h"

namespace caustics::beamtree {
namespace {

constexpr float crease = 0.766F;          // cosine of its angle
constexpr float facet_cosine = 0.99999F;  // of the angle between normals
constexpr float flat_turn = 1e-5F;        // between a facet's normal and the one it is shaded by
constexpr float most_step = 0.3F;  // sine of the way from one ray to the other to the surface

}  // namespace

RayArrival land(const Scene& scene, const VertexRay& ray, const Departure& from, float nm) {
    RayArrival arrival;
    const SegmentEnd start{ray.position, from.normal, from.offset};
    const std::optional<SurfacePoint> hit = scene.intersect(spawn_ray(start, ray.direction));
    if (!hit || !is_caster(scene.shape_at(*hit).bsdf)) return arrival;
    const Bsdf& bsdf = scene.shape_at(*hit).bsdf;
    const Vec3 w = -ray.direction;
    arrival.shape = hit->shape;
    arrival.front = hit->geometric_normal.dot(w) > 0;
    arrival.position = hit->position;
    arrival.geometric_normal = hit->geometric_normal;
    arrival.shading_normal = hit->shading_normal;
    arrival.offset = hit->offset;
    arrival.flat = scene.shape_at(*hit).primitive == Primitive::mesh &&
                   (hit->geometric_normal - hit->shading_normal).norm() < flat_turn;
    const SpecularSplit split =
        split_specular(bsdf, hit->geometric_normal, hit->shading_normal, w, nm);
    const Spectrum left = segment_transmittance(
        from.medium, medium_absorption(bsdf, hit->geometric_normal, w), hit->distance);
    arrival.direction = {split.reflected, split.refracted};
    for (const Event event : events)
        arrival.medium[event] =
            medium_after(bsdf, hit->geometric_normal, arrival.direction[event], from.medium);
    arrival.weight = {split.reflected_weight * left, split.refracted_weight * left};
    arrival.left = left.mean();
    return arrival;
}

bool same_piece(const RayArrival& a, const RayArrival& b) {
    if (a.shape != b.shape) return false;
    if (!a.goes_on()) return true;
    if (a.front != b.front) return false;
    const bool facets = a.flat && b.flat;
    const float turn = facets ? a.geometric_normal.dot(b.geometric_normal)
                              : a.shading_normal.dot(b.shading_normal);
    if (turn < (facets ? facet_cosine : crease)) return false;
    const Vec3 way = b.position - a.position;
    const Vec3 normal = a.shading_normal + b.shading_normal;
    return std::abs(way.dot(normal)) <= most_step * way.norm() * normal.norm() + 4 * a.offset;
}

bool same_facet(const RayArrival& a, const RayArrival& b) {
    constexpr float rounding = 1e-5F;
    return !a.flat || (a.geometric_normal - b.geometric_normal).norm() < rounding;
}

}  // namespace caustics::beamtree
