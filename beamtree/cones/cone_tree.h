#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "beamtree/beams/hierarchy.h"
#include "beamtree/cones/cone.h"
#include "beamtree/light/beam_point.h"

namespace caustics::beamtree {

/// How nodes get their bounds.
struct ConeTreeSettings {
    enum class Merging {
        rays,  ///< every node from its own vertex rays: tighter, and simpler
        cones  ///< inner nodes from their children's cones [CC95 (4)] to [CC95 (10)]
    };
    Bound bound = Bound::hybrid;
    double spread_threshold = 10;  ///< of `hybrid` [degrees]
    Merging merging = Merging::rays;
    double reach = 1;  ///< how far from the polygons receivers may be [m]: where a neck is sought
};

/// The cone tree of some beams of one set (rows B2 to B7).
class ConeTree {
public:
    /// `beams`: numbers into the set. With `fixed_normal` beams are tested on planes across it
    /// (it points against their light), otherwise on the plane across the receiver's normal.
    ConeTree(const BeamSet& set, std::uint32_t set_index, const Hierarchy& hierarchy,
             const ConeTreeSettings& settings, const std::optional<Vec3>& fixed_normal,
             int threads = 1);

    /// Appends the hits at a receiver point with its unit normal. `stack` is scratch.
    void find(const BeamSet& set, const Vec3& point, const Vec3& normal,
              std::vector<std::uint32_t>& stack, std::vector<BeamHit>& hits,
              SearchCounts& counts) const;

    std::uint32_t set_index() const { return set_index_; }
    std::uint64_t node_count() const { return nodes_.size(); }
    std::uint64_t height() const { return height_; }
    std::uint64_t bytes() const;

private:
    struct Node {
        std::uint32_t first_child = 0;  ///< 0: a leaf
        std::uint32_t child_count = 0;
        std::uint32_t beam = 0;   ///< of a leaf
        std::uint32_t bound = 0;  ///< into the arrays of its kind
        Bound kind = Bound::single;
    };
    struct Bounds;
    class Bounder;
    void append(const Bounds& bounds, std::size_t first_node, std::size_t end_node);
    bool may_hold(const Node& node, const BeamSet& set, const TestPlane& plane) const;
    bool single_holds(const Node& node, const BeamSet& set, const Vec3d& p) const;

    std::uint32_t set_index_;
    std::optional<Vec3> fixed_normal_;
    std::uint64_t height_;
    std::vector<Node> nodes_;
    std::vector<SweptSphere> swept_;   ///< of the kinds sphere_swept and double
    std::vector<DoubleCone> doubles_;  ///< one a sphere, of the kind double
    std::vector<SingleCone> singles_;
};

/// The rays of the beams under a node.
NodeRays rays_of(const BeamSet& set, std::span<const std::uint32_t> beams);

}  // namespace caustics::beamtree
