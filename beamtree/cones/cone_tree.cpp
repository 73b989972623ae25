#include "beamtree/cones/cone_tree.h"

#include <cmath>
#include <unordered_map>

#include "beamtree/cones/cone_merging.h"
#include "beamtree/light/find_in_beam.h"
#include "core/base/interrupt.h"

namespace caustics::beamtree {

NodeRays rays_of(const BeamSet& set, std::span<const std::uint32_t> beams) {
    NodeRays rays;
    const auto add_beams = [&](double place) {
        std::unordered_map<std::uint32_t, std::uint32_t> number;
        const auto add = [&](std::uint32_t corner) {
            const auto next = static_cast<std::uint32_t>(rays.positions.size());
            const auto [at, is_new] = number.try_emplace(corner, next);
            if (is_new) {
                const VertexRay ray = set.ray(corner, place);
                rays.positions.emplace_back(ray.position.cast<double>());
                rays.directions.emplace_back(ray.direction.cast<double>());
            }
            return at->second;
        };
        for (const std::uint32_t index : beams) {
            const Beam& beam = set.beams[index];
            for (std::size_t i = 0; i < beam.triangle_count(); ++i) {
                const auto [a, b, c] = beam.triangle_corners(i);
                rays.triangles.push_back({add(a), add(b), add(c)});
            }
        }
    };
    // What moves from one end to the other stays between the two.
    for (const double place : set.places()) add_beams(place);
    return rays;
}

ConeTree::ConeTree(const BeamSet& set, std::uint32_t set_index, const Hierarchy& hierarchy,
                   const ConeTreeSettings& settings, const std::optional<Vec3>& fixed_normal)
    : set_index_(set_index), fixed_normal_(fixed_normal), height_(hierarchy.height()) {
    nodes_.resize(hierarchy.nodes.size());
    const bool from_cones = settings.merging == ConeTreeSettings::Merging::cones;
    const bool doubles = settings.bound == Bound::double_cone || settings.bound == Bound::hybrid;
    const double threshold =
        settings.bound == Bound::hybrid ? settings.spread_threshold * pi_d / 180 : 0;
    std::vector<MergedCone> merged(from_cones ? nodes_.size() : 0);
    // Children come after their parents.
    for (std::size_t i = nodes_.size(); i-- > 0;) {
        throw_if_interrupted();
        const Hierarchy::Node& from = hierarchy.nodes[i];
        Node& node = nodes_[i];
        node.first_child = from.first_child;
        node.child_count = from.child_count;
        const std::span<const std::uint32_t> beams(hierarchy.order.data() + from.first_beam,
                                                   from.beam_count);
        node.beam = beams.front();
        const NodeRays rays = rays_of(set, beams);
        Cap cap;
        DoubleCone wide;
        if (from_cones) {
            merged[i] =
                from.child_count == 0
                    ? leaf_cone(rays, settings.reach)
                    : merge_cones(std::span(merged).subspan(from.first_child, from.child_count),
                                  rays, settings.reach);
            cap = merged[i].cap;
            wide = merged[i].wide;
        } else {
            cap = smallest_cap(rays.directions);
        }
        node.kind = settings.bound;
        if (doubles) {
            node.kind = settings.bound == Bound::hybrid && cap.angle() < threshold
                            ? Bound::single
                            : Bound::double_cone;
            if (node.kind == Bound::double_cone && !from_cones)
                wide = double_cone(rays, cap, settings.reach);
        }
        add_bound(node, rays, cap, wide);
    }
}

void ConeTree::add_bound(Node& node, const NodeRays& rays, const Cap& cap, const DoubleCone& wide) {
    if (node.kind == Bound::single) {
        node.bound = static_cast<std::uint32_t>(singles_.size());
        singles_.emplace_back(rays, cap);
        return;
    }
    node.bound = static_cast<std::uint32_t>(swept_.size());
    swept_.emplace_back(rays, cap);
    if (node.kind == Bound::double_cone) doubles_.push_back(wide);
}

void ConeTree::find(const BeamSet& set, const Vec3& point, const Vec3& normal,
                    std::vector<std::uint32_t>& stack, std::vector<BeamHit>& hits,
                    SearchCounts& counts) const {
    const TestPlane plane(point, fixed_normal_ ? *fixed_normal_ : normal);
    stack.assign(1, 0);
    while (!stack.empty()) {
        const Node& node = nodes_[stack.back()];
        stack.pop_back();
        ++counts.cone_point_tests;
        if (!may_hold(node, set, plane)) continue;
        for (std::uint32_t i = 0; i < node.child_count; ++i) stack.push_back(node.first_child + i);
        if (node.child_count > 0) continue;
        find_in_beam(set, {set_index_, node.beam}, plane, hits, counts);
    }
}

bool ConeTree::may_hold(const Node& node, const BeamSet& set, const TestPlane& plane) const {
    if (node.kind == Bound::single) return single_holds(node, set, plane.point());
    const SweptSphere& swept = swept_[node.bound];
    if (node.kind == Bound::double_cone && doubles_[node.bound].exists()) {
        // Polygons that the plane cuts are clipped, which the double cone does not reckon with.
        const bool cut =
            std::abs(plane.height(swept.centre)) <= static_cast<double>(swept.radius) * (1 + 1e-6);
        if (!cut)
            if (const auto holds = doubles_[node.bound].holds(plane.point(), plane.normal()))
                return *holds;
    }
    return swept.holds(plane.point());
}

bool ConeTree::single_holds(const Node& node, const BeamSet& set, const Vec3d& p) const {
    const SingleCone& cone = singles_[node.bound];
    if (node.child_count > 0 || set.drifts()) return cone.holds(p);
    const Beam& beam = set.beams[node.beam];
    std::array<Vec3d, 4> corners;
    const std::size_t count = 2 + beam.triangle_count();
    for (std::size_t i = 0; i < count; ++i)
        corners[i] = set.rays[beam.corners[i]].position.cast<double>();
    return cone.holds(p, std::span(corners).first(count));
}

std::uint64_t ConeTree::bytes() const {
    return nodes_.size() * sizeof(Node) + swept_.size() * sizeof(SweptSphere) +
           doubles_.size() * sizeof(DoubleCone) + singles_.size() * sizeof(SingleCone);
}

}  // namespace caustics::beamtree
