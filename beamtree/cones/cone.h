#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "beamtree/beams/beam.h"
#include "beamtree/cones/cap.h"
#include "beamtree/light/beam_point.h"

namespace caustics::beamtree {

/// The bounds of a group of beams that [CC95] and its corrections know. Each cone holds every point
/// that test_beam can accept for a beam of the group, on a plane of any tilt.
///
/// They rest on one fact: an accepted point is X + V with X in the polygon and V a positive
/// combination of its vertex rays' directions, so any convex set that holds the vertex rays will do.
enum class Bound {
    single,  ///< a cap of ray directions against the cap of directions to the point (figs. 3, 13)
    double_cone,   ///< two overlaid cones (figs. 6-8), as r + |x| tan(spread)
    hybrid,        ///< single below the spread threshold, double from there on
    sphere_swept,  ///< the single cone made exact and cheap: a ball swept along a cone
    two_slice      ///< no cone: boxes on two planes (slice_tree.h); never of a cone tree
};

/// The vertices and rays of a node's beams.
struct NodeRays {
    std::vector<Vec3d> positions;
    std::vector<Vec3d> directions;
    /// Three indices into them for every triangle of the beams.
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// The ball swept along a cone: { c + v : |v - a (a.v)| cos <= R + (a.v) sin }. The same set as "cap
/// of the rays overlaps the cap of directions from the ball to the point", without trigonometry.
struct SweptSphere {
    Vec3 centre = Vec3::Zero();
    float radius = 0;
    Vec3 axis = Vec3::UnitZ();
    float cosine = -1;  ///< <= 0: holds everything
    float sine = 0;
    float nearest = 0;  ///< no ray starts before this axial distance from the centre

    SweptSphere() = default;
    SweptSphere(const NodeRays& rays, const Cap& cap);
    bool holds(const Vec3d& p) const;
};

/// The single cone of the paper: the cap of the rays, and the polygon's vertices as their box (a
/// leaf is tested with its own corners).
struct SingleCone {
    Vec3 axis = Vec3::UnitZ();
    float cosine = -1;
    float sine = 0;
    Vec3 low = Vec3::Zero();
    Vec3 high = Vec3::Zero();

    SingleCone() = default;
    SingleCone(const NodeRays& rays, const Cap& cap);
    bool holds(const Vec3d& p) const;
    /// Against the directions from given points to p (cone D of [CC95 fig. 13]).
    bool holds(const Vec3d& p, std::span<const Vec3d> from) const;
};

/// The two overlaid cones of the paper, corrected: at axial distance x from the neck the rays lie
/// within r + |x| tan(spread) of the axis. That is the union of the forward cone from one apex and
/// the backward cone from the other, with no hole between, and needs no apex, which parallel rays
/// do not have. `slack` makes it hold on planes across any normal, not only the axis.
struct DoubleCone {
    Vec3 neck = Vec3::Zero();
    float radius = 0;
    Vec3 axis = Vec3::UnitZ();
    float tangent = -1;  ///< of the spread; < 0: none can be made, the swept sphere serves alone
    float nearest = 0;   ///< same-side test: no ray starts before this axial distance from the neck
    float width = 0;     ///< of the widest beam at the neck, across the axis [m]
    float spreading = 0;  ///< largest difference of slopes within a beam

    bool exists() const { return tangent >= 0; }
    /// Whether the point can be inside; empty when this plane is too steep for an answer.
    std::optional<bool> holds(const Vec3d& p, const Vec3d& plane_normal) const;
};

/// A double cone round the vertex rays, its neck between their starts and `reach` [m] further on.
/// Spreads from 60 degrees on get none.
DoubleCone double_cone(const NodeRays& rays, const Cap& cap, double reach);

}  // namespace caustics::beamtree
