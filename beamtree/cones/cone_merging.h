#pragma once

#include <optional>
#include <span>

#include "beamtree/cones/cone.h"

namespace caustics::beamtree {

/// A node's cones where parents are made from their children's [CC95 sec. 3.1.2]. Both kinds are
/// kept all the way up, so that a double parent can enclose a child that `hybrid` tests as single.
struct MergedCone {
    Cap cap;
    DoubleCone wide;
};

/// Of one polygon, from its vertex rays, the axis by the box of [CC95 fig. 4].
MergedCone leaf_cone(const NodeRays& rays, double reach);

/// [CC95 (4)] for the cap; for the double cone the neck of the children's sections ([CC95 (5)] to
/// [CC95 (10)]), each a
/// pair of ellipses, enclosed by boxes and the boxes by a circle (fig. 12). `rays` give what no cone
/// shows: where the beams begin, and their width and spreading.
MergedCone merge_cones(std::span<const MergedCone> children, const NodeRays& rays, double reach);

/// The ellipse in which a plane cuts a cone [CC95 fig. 11].
struct ConeSection {
    Vec3d centre = Vec3d::Zero();
    Vec3d major_axis = Vec3d::UnitX();  ///< unit, in the plane
    double major = 0;                   ///< semi-axes [CC95 (5)], [CC95 (6)]
    double minor = 0;
};

/// The cone of half-angle `spread` from `apex` along the unit `cone_axis`, cut by the plane across
/// `plane_axis` at the signed axial distance `height` from the apex. [CC95 (9)] is corrected: the centre
/// lies on the plane's axis through the apex, moved by [CC95 (10)] along the major axis (as printed, with
/// the cone's axis, it does not lie on the plane). Empty when the section is no ellipse, that is when
/// spread + angle between the axes reaches 90 degrees.
std::optional<ConeSection> cone_section(const Vec3d& apex, const Vec3d& cone_axis, double spread,
                                        const Vec3d& plane_axis, double height);

}  // namespace caustics::beamtree
