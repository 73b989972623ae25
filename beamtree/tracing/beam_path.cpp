#include "beamtree/tracing/beam_path.h"

#include <algorithm>

namespace caustics::beamtree {

Path::Path(const Scene& scene, const LitCaster& surface, const Level& level, std::uint32_t beam)
    : scene_(scene),
      surface_(surface),
      facing_(surface.facing(level.traced.set.beams[beam].triangle)) {
    const std::uint32_t triangle = level.traced.set.beams[beam].triangle;
    const Level* at = &level;
    for (; at->parent != nullptr; beam = at->parents[beam], at = at->parent)
        steps_.push_back({&at->places[beam], at->event});
    std::reverse(steps_.begin(), steps_.end());
    first_event_ = at->event;
    if (at->exact == nullptr) return;
    exact_ = at->exact;
    exact_offset_ = std::max(surface.corner_offset(triangle),
                             least_offset(scene.shapes()[surface.caster().shape]));
}

PathPoint Path::between(const PathPoint& a, const PathPoint& b, float t) const {
    if (t == 0) {
        PathPoint point = a;
        point.origin.vertex = RayOrigin::no_vertex;
        return point;
    }
    return go((1 - t) * a.origin.position + t * b.origin.position,
              (1 - t) * a.origin.normal + t * b.origin.normal,
              std::max(a.origin.offset, b.origin.offset));
}

PathPoint Path::inside(const std::array<const RayOrigin*, 3>& corners, const Vec3& weights) const {
    Vec3 position = Vec3::Zero();
    Vec3 normal = Vec3::Zero();
    float offset = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const float weight = weights[static_cast<Eigen::Index>(i)];
        position += weight * corners[i]->position;
        normal += weight * corners[i]->normal;
        offset = std::max(offset, corners[i]->offset);
    }
    return go(position, normal, offset);
}

PathPoint Path::middle(const Piece& piece) const {
    return inside({&piece[0].origin, &piece[1].origin, &piece[2].origin}, Vec3::Constant(1.0F / 3));
}

PathPoint Path::go(const Vec3& position, const Vec3& normal, float offset) const {
    PathPoint point = go_steps(position, normal, offset, false);
    if (point.alive) point.next = land(scene_, point.ray, point.from, surface_.light().bin.nm);
    return point;
}

// Of what the triangle itself says nothing goes into the way: its neighbour goes it too, from their common edge.
PathPoint Path::go_steps(const Vec3& position, const Vec3& normal, float offset,
                         bool by_facets) const {
    if (exact_ == nullptr) return go_steps(position, normal, offset, facing_, by_facets);
    const SpecularSurface::Place place = exact_->beside(exact_->local(position.cast<double>()));
    const Vec3 on_surface = place.position.cast<float>();
    const Vec3 across = place.across.cast<float>();
    const bool is_front = across.dot(to_light(surface_.light(), on_surface)) > 0;
    if (is_front == facing_.front)
        return go_steps(on_surface, across, exact_offset_, {across, is_front, false}, by_facets);
    PathPoint dark;
    dark.origin = {on_surface, across, black()};
    dark.origin.offset = exact_offset_;
    return dark;
}

PathPoint Path::go_steps(const Vec3& position, const Vec3& normal, float offset,
                         const Facing& facing, bool by_facets) const {
    PathPoint point;
    const MeshPoint first = surface_.bender().at(position, normal);
    point.origin = {first.position, first.normal, first.bent.weight[first_event_]};
    point.origin.offset = offset;
    point.from = {
        first.normal, offset,
        surface_.bender().medium_after(facing.normal, first.bent.direction[first_event_])};
    if (!sends_on(first, facing, first_event_)) return point;
    if (!sees(scene_, {position, first.normal, offset}, surface_.light())) return point;
    point.ray = {position, first.bent.direction[first_event_]};
    for (const Step& step : steps_) {
        const RayArrival arrival = land(scene_, point.ray, point.from, surface_.light().bin.nm);
        if (!same_piece(arrival, *step.where)) return point;
        if (by_facets && !same_facet(arrival, *step.where)) return point;
        point.origin.weight *= arrival.weight[step.event];
        point.origin.left *= arrival.left;
        if (is_black(point.origin.weight)) return point;
        point.ray = {arrival.position, arrival.direction[step.event]};
        point.from = arrival.after(step.event);
    }
    point.alive = true;
    return point;
}

}  // namespace caustics::beamtree
