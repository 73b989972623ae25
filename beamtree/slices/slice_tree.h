#pragma once

#include <optional>
#include <span>
#include <vector>

#include "beamtree/beams/hierarchy.h"
#include "beamtree/light/beam_point.h"
#include "beamtree/slices/beam_square.h"
#include "beamtree/slices/slice_frame.h"
#include "beamtree/slices/slice_nodes.h"
#include "core/caustic_estimator.h"

namespace caustics::beamtree {

/// Beams of any sets that are tested on planes across one normal, and the slab in which they can be
/// asked for.
struct SlicedBeams {
    std::span<const BeamSet> sets;
    std::vector<BeamNumber> beams;  ///< at least one; all of their rays come down to the planes
    Vec3 normal;                    ///< of the planes, against the light
    Box receivers;                  ///< where receiver points can be
};

/// A tree of beams, each node bounded by its rays' boxes on two planes across the normal: above all
/// polygons and below all receivers. Between the planes a box whose sides move linearly holds all
/// rays, however they converge and part again, and so all that test_beam can accept on planes
/// across that normal: such points are means of ray points of their own height, or of points of the
/// polygon's edges, and those move linearly as well. It is a tree of moving boxes, with depth in
/// place of time. Eight children a node, eight triangles a leaf, tested at once; the beams that
/// remain are tested exactly.
class SliceTree {
public:
    /// Splits the beams by binned_slices.
    SliceTree(SlicedBeams beams, Isa isa, int threads = 1);
    /// With a hierarchy, in the order of which the beams are given.
    SliceTree(SlicedBeams beams, const Hierarchy& hierarchy, Isa isa, int threads = 1);

    /// Appends the hits at each point to the list of the same place. Points that follow each other
    /// and lie within half a leaf's width go through the nodes together. `sets` are those that the
    /// tree was made of; `stack` is scratch. Counts as cone-point tests the boxes that a point or a
    /// group is tested against and the triangles that each point is, as beam-point tests the exact
    /// ones. Throws std::out_of_range for a point below all receivers.
    void find(std::span<const BeamSet> sets, std::span<const ReceiverPoint> points,
              std::vector<std::uint32_t>& stack, std::span<std::vector<BeamHit>> hits,
              SearchCounts& counts) const;

    const SliceFrame& frame() const { return frame_; }
    std::uint64_t node_count() const { return nodes_.size() + leaves_.size(); }
    std::uint64_t height() const { return height_; }
    std::uint64_t bytes() const;

private:
    struct Asked;
    struct Group;
    SliceTree(SlicedBeams beams, const Hierarchy* hierarchy, Isa isa, int threads);
    bool place(const ReceiverPoint& point, SlicePoint& placed) const;
    void keep_corners(std::span<const BeamSet> sets);
    void find(std::span<const Group> groups, const Asked& asked, std::span<const BeamSet> sets,
              std::vector<std::uint32_t>& stack, std::span<std::vector<BeamHit>> hits,
              SearchCounts& counts) const;
    void test(const SliceWalk& walk, const Group& group, const Asked& asked,
              std::span<const BeamSet> sets, std::span<std::vector<BeamHit>> hits,
              SearchCounts& counts) const;

    std::vector<BeamNumber> beams_;  ///< in the order of the leaves
    /// Copies of the beams' corners in that order, `corner_count_` each (the fourth without a direction where there are
    /// three); none where beams drift.
    std::vector<VertexRay> corners_;
    std::size_t corner_count_ = 0;
    SliceFrame frame_;
    TestPlane plane_;  ///< the direction of all planes
    WalkSlices walk_;
    std::vector<SliceNode> nodes_;
    std::vector<SliceLeaf> leaves_;
    std::uint32_t root_ = 0;
    std::uint32_t height_ = 0;
    float leaf_width_ = 0;
    float travel_ = 0;
    bool has_bulges_ = false;
};

}  // namespace caustics::beamtree
