#include "beamtree/tracing/next_beams.h"

#include <algorithm>

#include "beamtree/tracing/cut_edge.h"

namespace caustics::beamtree {
namespace {

// Where corners' weights do not give the mean, this many parts of a side do.
constexpr int parts = 5;

// What media have left of a beam's light. Where they absorb much, all light that passes is weak.
double left_of(const BeamCorners& corners) {
    double left = 0;
    for (const BeamCorner& corner : corners)
        left = std::max(left, static_cast<double>(corner.origin->left) *
                                  static_cast<double>(corner.arrival->left));
    return left;
}

// How far the surface may lie off the triangle of the corners, as LitCaster::offset. Facets of a
// mesh turn by steps.
float bulge(const BeamCorners& corners) {
    float largest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const RayArrival& a = *corners[i].arrival;
        const RayArrival& b = *corners[(i + 1) % 3].arrival;
        const float turn = std::max((a.shading_normal - b.shading_normal).norm(),
                                    (a.geometric_normal - b.geometric_normal).norm());
        largest = std::max(largest, (a.position - b.position).norm() * turn);
    }
    return largest / 4;
}

// Beams that meet in a ray of the parent's share the one it goes on as.
std::uint32_t ray_of(Level& level, const BeamCorner& corner, Event event) {
    const bool shared = corner.parent_ray != Beam::none;
    if (shared && level.ray_of_parent[corner.parent_ray] != Beam::none)
        return level.ray_of_parent[corner.parent_ray];
    const RayArrival& arrival = *corner.arrival;
    const auto ray = static_cast<std::uint32_t>(level.traced.set.rays.size());
    level.traced.set.rays.push_back({arrival.position, arrival.direction[event]});
    RayOrigin origin = *corner.origin;
    origin.weight *= arrival.weight[event];
    origin.left *= arrival.left;
    if (!shared) origin.vertex = RayOrigin::no_vertex;
    level.traced.origins.push_back(origin);
    level.departures.push_back({arrival.shape, arrival.geometric_normal, arrival.offset});
    if (shared) level.ray_of_parent[corner.parent_ray] = ray;
    return ray;
}

}  // namespace

NextBeams::NextBeams(const Scene& scene, const LitCaster& surface, Level& level,
                     const LeastLight& least, FluxBalance& balance)
    : scene_(scene),
      surface_(surface),
      level_(level),
      set_(level.traced.set),
      least_(least),
      balance_(balance) {}

double NextBeams::flux(const Piece& piece) const {
    const auto& [a, b, c] = piece;
    const Spectrum weight = (a.origin.weight + b.origin.weight + c.origin.weight) / 3;
    return static_cast<double>(weight.mean()) *
           measure(set_.light, a.origin.position, b.origin.position, c.origin.position);
}

// Its corners' light is a bound to a few times: between them a surface may reflect less.
bool NextBeams::is_too_weak(const Piece& piece) const {
    constexpr double slack = 4;
    if (least_.budget.least() == 0) return false;
    double strength = 0;
    for (const PathPoint& corner : piece)
        strength = std::max(strength, static_cast<double>(corner.origin.weight.mean()) /
                                          static_cast<double>(corner.origin.left));
    const auto& [a, b, c] = piece;
    return slack * strength *
               measure(set_.light, a.origin.position, b.origin.position, c.origin.position) <
           least_.budget.least();
}

// As LightBender::flux: by the corners' weights where they are alike; near total reflection the way is
// gone from places inside as well.
Spectrum NextBeams::flux(std::uint32_t parent, const BeamCorners& corners, Event event) const {
    std::array<Spectrum, 3> weights;
    for (std::size_t i = 0; i < 3; ++i)
        weights[i] = corners[i].origin->weight * corners[i].arrival->weight[event];
    const std::array<const RayOrigin*, 3> at = {corners[0].origin, corners[1].origin,
                                                corners[2].origin};
    const float whole =
        static_cast<float>(measure(set_.light, at[0]->position, at[1]->position, at[2]->position));
    if (!weights_differ({weights[0].mean(), weights[1].mean(), weights[2].mean()}))
        return (weights[0] + weights[1] + weights[2]) * (whole / 3);
    const Path path(scene_, surface_, level_, parent);
    Spectrum sum = black();
    const auto add = [&](int i, int j, float to_middle) {
        const float u = (static_cast<float>(i) + to_middle) / parts;
        const float v = (static_cast<float>(j) + to_middle) / parts;
        const PathPoint point = path.inside(at, {1 - u - v, u, v});
        if (goes_on(point) && same_piece(point.next, *corners[0].arrival))
            sum += point.origin.weight * point.next.weight[event];
    };
    for (int i = 0; i < parts; ++i)
        for (int j = 0; i + j < parts; ++j) {
            add(i, j, 1.0F / 3);
            if (i + j + 2 <= parts) add(i, j, 2.0F / 3);
        }
    return sum * (whole / (parts * parts));
}

void NextBeams::add(std::uint32_t parent, const BeamCorners& corners, Event event, float share) {
    const RayArrival& first = *corners[0].arrival;
    Beam beam;
    beam.flux = flux(parent, corners, event);
    const auto mean = static_cast<double>(beam.flux.mean());
    if (!(mean > 0)) return;
    const double clear = mean / left_of(corners);
    const double worth = clear / static_cast<double>(share);
    if (worth < least_.of_polygon || clear < least_.budget.least()) {
        balance_.lost += mean;
        (worth < least_.of_polygon ? balance_.pruned : balance_.over_budget) += mean;
        return;
    }
    least_.budget.count(clear);
    Level& level = level_of(first.shape, event);
    beam.triangle = set_.beams[parent].triangle;
    beam.inside = first.front == (event == refraction);
    for (const BeamCorner& corner : corners)
        beam.offset = std::max(beam.offset, 2 * corner.arrival->offset);
    beam.offset += bulge(corners);
    beam.corners.fill(Beam::none);
    for (std::size_t i = 0; i < 3; ++i) beam.corners[i] = ray_of(level, corners[i], event);
    level.traced.set.beams.push_back(beam);
    level.worth += worth;
    level.shares.push_back(share);
    level.parents.push_back(parent);
    level.places.push_back(first);
}

Level& NextBeams::level_of(std::uint32_t shape, Event event) {
    for (Level& level : levels_)
        if (level.traced.set.path.back().shape == shape && level.event == event) return level;
    Level& level = levels_.emplace_back();
    level.parent = &level_;
    level.event = event;
    level.ray_of_parent.assign(set_.rays.size(), Beam::none);
    BeamSet& set = level.traced.set;
    set.light = set_.light;
    set.caster = set_.caster;
    set.refracted = event == refraction;
    set.path = set_.path;
    set.path.push_back({shape, event == refraction});
    if (const auto* medium = std::get_if<Dielectric>(&scene_.shapes()[shape].bsdf.model))
        set.absorption = {medium->ext_absorption, medium->absorption};
    return level;
}

}  // namespace caustics::beamtree
