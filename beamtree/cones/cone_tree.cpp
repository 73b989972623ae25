#include "beamtree/cones/cone_tree.h"

#include <cmath>
#include <unordered_map>

#include "beamtree/cones/cone_merging.h"
#include "beamtree/light/find_in_beam.h"
#include "core/base/parallel.h"

namespace caustics::beamtree {

namespace {

// The light of a beam with roots lies beside its straight-sided polygons: within the Bezier points of its edges.
void add_bulges(const BeamSet& set, std::uint32_t index, NodeRays& rays) {
    constexpr double over_middles = 2.1;  // 2 for a quadratic
    const Beam& beam = set.beams[index];
    for (std::size_t which = 0; which < beam.triangle_count(); ++which) {
        if (!set.has_roots(index, which)) continue;
        const auto corners = set.triangle(beam, which);
        const EdgeMiddles& middles = set.middles_of(index, which);
        for (std::size_t i = 0; i < 3; ++i) {
            const VertexRay& a = *corners[i];
            const VertexRay& b = *corners[(i + 1) % 3];
            const auto beyond = [&](const Vec3& from, const Vec3& to, const Vec3& middle) {
                const Vec3d mean = (from.cast<double>() + to.cast<double>()) / 2;
                return Vec3d(mean + over_middles * (middle.cast<double>() - mean));
            };
            rays.positions.push_back(beyond(a.position, b.position, middles[i].position));
            rays.directions.push_back(
                beyond(a.direction, b.direction, middles[i].direction).normalized());
        }
    }
}

}  // namespace

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
    if (set.has_roots())
        for (const std::uint32_t index : beams) add_bulges(set, index, rays);
    return rays;
}

/// The bounds of some nodes, numbered for themselves.
struct ConeTree::Bounds {
    std::vector<SweptSphere> swept;
    std::vector<DoubleCone> doubles;
    std::vector<SingleCone> singles;
};

/// Bounds nodes of a hierarchy.
class ConeTree::Bounder {
public:
    Bounder(const BeamSet& set, const Hierarchy& hierarchy, const ConeTreeSettings& settings)
        : set_(set),
          hierarchy_(hierarchy),
          settings_(settings),
          doubles_(settings.bound == Bound::double_cone || settings.bound == Bound::hybrid),
          threshold_(settings.bound == Bound::hybrid ? settings.spread_threshold * pi_d / 180 : 0) {
    }

    // From the lowest nodes up, one row after the other [CC95 (4)] to [CC95 (10)].
    void merge_cones(int threads) {
        const std::vector<Hierarchy::Node>& nodes = hierarchy_.nodes;
        std::vector<std::vector<std::uint32_t>> rows(hierarchy_.height());
        std::vector<std::uint32_t> depth(nodes.size(), 0);
        for (std::uint32_t i = 0; i < nodes.size(); ++i) {
            rows[depth[i]].push_back(i);
            for (std::uint32_t c = 0; c < nodes[i].child_count; ++c)
                depth[nodes[i].first_child + c] = depth[i] + 1;
        }
        merged_.resize(nodes.size());
        for (std::size_t row = rows.size(); row-- > 0;)
            parallel_chunks(threads, rows[row].size(), 64, [&](const Chunk& chunk) {
                for (std::size_t k = chunk.first; k < chunk.end; ++k) merge(rows[row][k]);
            });
    }

    void add(std::size_t number, Node& node, Bounds& bounds) const {
        const Hierarchy::Node& from = hierarchy_.nodes[number];
        node.first_child = from.first_child;
        node.child_count = from.child_count;
        node.beam = hierarchy_.order[from.first_beam];
        const NodeRays rays = rays_below(number);
        const bool from_cones = !merged_.empty();
        const Cap cap = from_cones ? merged_[number].cap : smallest_cap(rays.directions);
        node.kind = settings_.bound;
        if (doubles_)
            node.kind = settings_.bound == Bound::hybrid && cap.angle() < threshold_
                            ? Bound::single
                            : Bound::double_cone;
        if (node.kind == Bound::single) {
            node.bound = static_cast<std::uint32_t>(bounds.singles.size());
            bounds.singles.emplace_back(rays, cap);
            return;
        }
        node.bound = static_cast<std::uint32_t>(bounds.swept.size());
        bounds.swept.emplace_back(rays, cap);
        if (node.kind == Bound::double_cone)
            bounds.doubles.push_back(from_cones ? merged_[number].wide
                                                : double_cone(rays, cap, settings_.reach));
    }

private:
    NodeRays rays_below(std::size_t number) const {
        const Hierarchy::Node& node = hierarchy_.nodes[number];
        return rays_of(set_, std::span(hierarchy_.order).subspan(node.first_beam, node.beam_count));
    }
    void merge(std::uint32_t number) {
        const Hierarchy::Node& node = hierarchy_.nodes[number];
        const NodeRays rays = rays_below(number);
        merged_[number] = node.child_count == 0
                              ? leaf_cone(rays, settings_.reach)
                              : beamtree::merge_cones(
                                    std::span(merged_).subspan(node.first_child, node.child_count),
                                    rays, settings_.reach);
    }

    const BeamSet& set_;
    const Hierarchy& hierarchy_;
    const ConeTreeSettings& settings_;
    bool doubles_;
    double threshold_;
    std::vector<MergedCone> merged_;  ///< one a node where cones are merged
};

ConeTree::ConeTree(const BeamSet& set, std::uint32_t set_index, const Hierarchy& hierarchy,
                   const ConeTreeSettings& settings, const std::optional<Vec3>& fixed_normal,
                   int threads)
    : set_index_(set_index), fixed_normal_(fixed_normal), height_(hierarchy.height()) {
    nodes_.resize(hierarchy.nodes.size());
    Bounder bounder(set, hierarchy, settings);
    if (settings.merging == ConeTreeSettings::Merging::cones) bounder.merge_cones(threads);
    // The first nodes have most beams: they go one by one, the others many at a time.
    constexpr std::size_t alone = 256;
    constexpr std::size_t together = 128;
    const std::size_t lone = std::min(alone, nodes_.size());
    const std::size_t parts = lone + chunk_count(nodes_.size() - lone, together);
    const auto first_of = [&](std::size_t part) {
        return part < lone ? part : std::min(nodes_.size(), lone + (part - lone) * together);
    };
    std::vector<Bounds> bounds(parts);
    parallel_chunks(threads, parts, 1, [&](const Chunk& chunk) {
        const std::size_t end = first_of(chunk.index + 1);
        for (std::size_t i = first_of(chunk.index); i < end; ++i)
            bounder.add(i, nodes_[i], bounds[chunk.index]);
    });
    for (std::size_t part = 0; part < parts; ++part)
        append(bounds[part], first_of(part), first_of(part + 1));
}

void ConeTree::append(const Bounds& bounds, std::size_t first_node, std::size_t end_node) {
    for (std::size_t i = first_node; i < end_node; ++i)
        nodes_[i].bound += static_cast<std::uint32_t>(
            nodes_[i].kind == Bound::single ? singles_.size() : swept_.size());
    singles_.insert(singles_.end(), bounds.singles.begin(), bounds.singles.end());
    swept_.insert(swept_.end(), bounds.swept.begin(), bounds.swept.end());
    doubles_.insert(doubles_.end(), bounds.doubles.begin(), bounds.doubles.end());
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
    if (node.child_count > 0 || set.drifts() || set.has_roots()) return cone.holds(p);
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
