#include "beamtree/light/light_chain.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "core/geometry/surface_offset.h"
#include "core/light_path/ray_change.h"
#include "core/material/optics.h"

namespace caustics::beamtree {

struct LightChain::Bend : SpecularBend {
    Vec3d direction;  ///< in which the light leaves
    double side;  ///< -1 where the light comes to the back: n is the surface's normal times this
};

namespace {

using Place = SpecularSurface::Place;

SegmentEnd segment_end(const Place& place, float offset) {
    return {place.position.cast<float>(), place.across.cast<float>(), offset};
}

}  // namespace

LightChain::LightChain(const Scene& scene, const BeamSet& set)
    : scene_(scene), set_(set), light_(set.light), bender_(scene, set.caster, set.light) {
    for (const SpecularEvent& event : set.path) {
        const Shape& shape = scene.shapes()[event.shape];
        exact_.emplace_back();
        least_.push_back(0);
        if (shape.primitive == Primitive::mesh) continue;
        exact_.back().emplace(shape);
        least_.back() = static_cast<double>(least_offset(shape));
    }
}

// The laws of reflection and of refraction.
std::optional<LightChain::Bend> LightChain::bend(const Arrival& arrival) const {
    Bend bend;
    bend.w = arrival.w;
    bend.side = arrival.place.across.dot(arrival.w) > 0 ? 1 : -1;
    bend.n = bend.side * arrival.place.normal;
    bend.cosine = bend.n.dot(bend.w);
    if (!(bend.cosine > 0)) return {};
    bend.refracts = set_.path[arrival.number].refracted;
    if (!bend.refracts) {
        bend.direction = 2 * bend.cosine * bend.n - bend.w;
        return bend;
    }
    const auto* const glass = std::get_if<Dielectric>(&arrival.shape->bsdf.model);
    if (glass == nullptr) return {};
    const double ratio = glass->int_ior.at(light_.bin.nm) / glass->ext_ior.at(light_.bin.nm);
    bend.eta = bend.side > 0 ? ratio : 1 / ratio;
    const double squared = 1 - (1 - bend.cosine * bend.cosine) / (bend.eta * bend.eta);
    if (!(squared > 0)) return {};
    bend.inner = std::sqrt(squared);
    bend.direction = (bend.cosine * bend.n - bend.w) / bend.eta - bend.inner * bend.n;
    return bend;
}

// By derivatives: a light may be much nearer to the surface than any step over which differences of directions would be
// taken.
bool LightChain::leave(const Arrival& arrival, const Bend& bend, ChainRay& ray) const {
    for (std::size_t i = 0; i < 2; ++i)
        ray.by_direction[i] =
            bend.direction_change(arrival.by_w[i], bend.side * arrival.by_normal[i]);
    ray.position = arrival.place.position;
    ray.across = arrival.place.across;
    ray.offset = arrival.offset;
    ray.direction = bend.direction;
    return ray.direction.allFinite();
}

LightChain::Arrival LightChain::first_arrival(const ChainStart& start, ChainRay& ray) const {
    Arrival arrival{.shape = &scene_.shapes()[set_.path[0].shape],
                    .place = start.surface.beside(start.local),
                    .w = -light_.travel.cast<double>(),
                    .distance = 1,
                    .offset = start.offset,
                    .number = 0,
                    .is_seen = false,
                    .by_w = {Vec3d::Zero(), Vec3d::Zero()},
                    .by_normal = {}};
    const bool directional = light_.kind == LightSample::Kind::directional;
    if (!directional) {
        arrival.w = light_.position.cast<double>() - arrival.place.position;
        arrival.distance = arrival.w.norm();
    }
    arrival.w.normalize();
    for (std::size_t i = 0; i < 2; ++i) {
        const SpecularSurface::Change change =
            start.surface.beside_change(start.local, arrival.place, start.ways[i]);
        ray.by_position[i] = change.position;
        arrival.by_normal[i] = change.normal;
        if (!directional)
            arrival.by_w[i] =
                (arrival.w.dot(change.position) * arrival.w - change.position) / arrival.distance;
    }
    ray.first = arrival.place;
    ray.to_light = arrival.w;
    ray.light_area = std::abs(arrival.w.dot(ray.by_position[0].cross(ray.by_position[1]))) /
                     (arrival.distance * arrival.distance);
    return arrival;
}

// Exact shapes are asked alone: weight() sees what stands before them.
std::optional<LightChain::Arrival> LightChain::next_arrival(const Arrival& before,
                                                            ChainRay& ray) const {
    const std::size_t number = before.number + 1;
    const std::uint32_t shape = set_.path[number].shape;
    std::optional<SpecularSurface> facet;
    if (!exact_[number]) {
        const auto hit = scene_.intersect(
            spawn_ray(segment_end(before.place, before.offset), ray.direction.cast<float>()));
        if (!hit || hit->shape != shape) return {};
        facet.emplace(scene_.shapes()[shape].mesh, hit->triangle);
        ray.offset = hit->offset;
    }
    const SpecularSurface& surface = facet ? *facet : *exact_[number];
    if (surface.is_flat_facet()) ray.facets += static_cast<double>(number) * surface.facet_normal();
    const auto place = surface.first_along(ray.position, ray.direction, least_[number]);
    if (!place) return {};
    if (!facet)
        ray.offset = std::max(rounding_offset(place->position.cast<float>()),
                              static_cast<float>(least_[number]));
    const double way = ray.direction.dot(place->position - ray.position);
    Arrival arrival{.shape = &scene_.shapes()[shape],
                    .place = *place,
                    .w = -ray.direction,
                    .distance = way,
                    .offset = ray.offset,
                    .number = number,
                    .is_seen = facet.has_value(),
                    .by_w = {-ray.by_direction[0], -ray.by_direction[1]},
                    .by_normal = {}};
    for (std::size_t i = 0; i < 2; ++i) {
        ray.by_position[i] =
            at_surface({ray.by_position[i], ray.by_direction[i]}, ray.direction, way, place->across)
                .place;
        arrival.by_normal[i] = surface.normal_change(*place, ray.by_position[i]);
    }
    return arrival;
}

template <typename Visit>
std::optional<ChainRay> LightChain::go(const ChainStart& start, const Visit& visit) const {
    ChainRay ray;
    std::optional<Arrival> arrival = first_arrival(start, ray);
    if (start.side * arrival->place.across.dot(arrival->w) < 0) return {};
    while (arrival) {
        const auto bent = bend(*arrival);
        if (!bent || !leave(*arrival, *bent, ray) || !visit(*arrival, *bent)) return {};
        if (arrival->number + 1 == set_.path.size()) return ray;
        arrival = next_arrival(*arrival, ray);
    }
    return {};
}

std::optional<ChainRay> LightChain::ray(const ChainStart& start) const {
    return go(start, [](const Arrival&, const Bend&) { return true; });
}

Spectrum LightChain::weight(const ChainStart& start) const {
    Spectrum weight = black();
    const Spectrum* medium = nullptr;
    SegmentEnd before;
    const auto ended = go(start, [&](const Arrival& arrival, const Bend& bend) {
        const Event event = bend.refracts ? refraction : reflection;
        const SegmentEnd here = segment_end(arrival.place, arrival.offset);
        const Vec3 w = arrival.w.cast<float>();
        const Vec3 normal = arrival.place.normal.cast<float>();
        const SpecularSplit split =
            split_specular(arrival.shape->bsdf, here.geometric_normal, normal, w, light_.bin.nm);
        Spectrum part = event == refraction ? split.refracted_weight : split.reflected_weight;
        // In float, an angle just below that of total reflection may lie above it.
        if (bend.refracts && split.refracted_weight.isZero(0) && split.lost_weight.isZero(0))
            part = std::get<Dielectric>(arrival.shape->bsdf.model).specular_transmittance *
                   static_cast<float>(1 - fresnel_reflectance(bend.cosine, bend.inner, bend.eta));
        if (is_black(part)) return false;
        if (arrival.number == 0) {
            if (!sees(scene_, here, light_)) return false;
            // A light may be so near that the place in float does not tell where it lies.
            const float distance = light_.kind == LightSample::Kind::directional
                                       ? distance_from(light_, here.position)
                                       : static_cast<float>(arrival.distance);
            weight = part * bender_.arriving(here.geometric_normal, w, distance);
            medium = light_.medium;
        } else {
            if (!arrival.is_seen && scene_.occluded(before, here)) return false;
            weight *=
                part * segment_transmittance(
                           medium, medium_absorption(arrival.shape->bsdf, here.geometric_normal, w),
                           static_cast<float>(arrival.distance));
        }
        medium = medium_after(arrival.shape->bsdf, here.geometric_normal,
                              bend.direction.cast<float>(), medium);
        before = here;
        return !is_black(weight);
    });
    return ended ? weight : black();
}

}  // namespace caustics::beamtree
