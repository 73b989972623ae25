#include "beamtree/cones/cone_merging.h"

#include <algorithm>
#include <cmath>

#include "beamtree/cones/neck.h"

namespace caustics::beamtree {
namespace {

// [CC95 (4)], with the axis by the box of the children's axes.
Cap merged_cap(std::span<const MergedCone> children) {
    std::vector<Vec3d> axes;
    for (const MergedCone& child : children) {
        if (child.cap.is_wide()) return {};
        axes.push_back(child.cap.axis);
    }
    Cap cap = box_cap(axes);
    double spread = 0;
    for (const MergedCone& child : children) {
        const double between = std::acos(std::clamp(cap.axis.dot(child.cap.axis), -1.0, 1.0));
        spread = std::max(spread, between + child.cap.angle());
    }
    cap.cosine = std::cos(std::min(spread + 1e-8, pi_d));
    return cap;
}

/// A plane's frame and what the children's sections on it fill.
struct SectionPlane {
    Vec3d origin, axis, s, t;

    // The box of a section of one child's cones, both nappes, in (s, t); false when it has none.
    bool add(const DoubleCone& child, double depth, Eigen::AlignedBox2d& box) const {
        const double slope = std::max(static_cast<double>(child.tangent), 1e-6);
        const double back = static_cast<double>(child.radius) / slope;
        const Vec3d child_axis = child.axis.cast<double>().normalized();
        for (const double side : {-1.0, 1.0}) {
            const Vec3d apex = child.neck.cast<double>() + side * back * child_axis;  // [CC95 (3)]
            const double height = depth - (apex - origin).dot(axis);
            // Forward of the rear apex, backward of the front one: the rays are in one of them.
            if (side * height > 0) continue;
            if (!add(cone_section(apex, child_axis, std::atan(slope), axis, height), box))
                return false;
        }
        return true;
    }

    bool add(const std::optional<ConeSection>& section, Eigen::AlignedBox2d& box) const {
        if (!section) return false;
        const Vec3d minor_axis = section->major_axis.cross(axis);  // [CC95 (8)]
        for (const double a : {-1.0, 1.0})
            for (const double b : {-1.0, 1.0}) {
                const Vec3d corner = section->centre - origin +
                                     a * section->major * section->major_axis +
                                     b * section->minor * minor_axis;
                box.extend(Vec2d(corner.dot(s), corner.dot(t)));
            }
        return true;
    }
};

}  // namespace

std::optional<ConeSection> cone_section(const Vec3d& apex, const Vec3d& cone_axis, double spread,
                                        const Vec3d& plane_axis, double height) {
    const double cos_between = std::clamp(cone_axis.dot(plane_axis), -1.0, 1.0);
    const Vec3d sideways = cone_axis - cos_between * plane_axis;
    const double sin_between = sideways.norm();
    const double k = std::pow(std::cos(spread), 2) - sin_between * sin_between;
    if (!(k > 0) || !(cos_between > 0)) return {};
    ConeSection section;
    // [CC95 (7)], made a unit vector.
    section.major_axis =
        sin_between > 1e-12 ? Vec3d(sideways / sin_between) : plane_axis.unitOrthogonal();
    const double h = std::abs(height);
    // [CC95 (5)] and [CC95 (6)]: the semi-axes.
    section.major = h * std::sin(spread) * std::cos(spread) / k;
    section.minor = h * std::sin(spread) / std::sqrt(k);
    // [CC95 (9)] with the parent's axis in place of the child's (README.md: the printed one loses rays),
    // moved along the major axis by [CC95 (10)].
    section.centre =
        apex + height * plane_axis + height * sin_between * cos_between / k * section.major_axis;
    return section;
}

MergedCone leaf_cone(const NodeRays& rays, double reach) {
    MergedCone cone;
    cone.cap = box_cap(rays.directions);
    cone.wide = double_cone(rays, cone.cap, reach);
    return cone;
}

MergedCone merge_cones(std::span<const MergedCone> children, const NodeRays& rays, double reach) {
    MergedCone parent;
    parent.cap = merged_cap(children);
    // Its own rays would tell a tighter one; here they serve for what the children's cones leave out.
    parent.wide = double_cone(rays, parent.cap, 0);
    if (!parent.wide.exists()) return parent;
    SectionPlane plane;
    plane.axis = parent.cap.axis;
    plane.s = plane.axis.unitOrthogonal();
    plane.t = plane.axis.cross(plane.s);
    plane.origin = parent.wide.neck.cast<double>();
    const double slope = std::tan(parent.cap.angle());
    for (const MergedCone& child : children)
        if (!child.wide.exists()) return {parent.cap, {}};
    bool bounded = true;
    const auto box_at = [&](double depth) {
        Eigen::AlignedBox2d box;
        for (const MergedCone& child : children)
            bounded = bounded && plane.add(child.wide, depth, box);
        return box;
    };
    const double first = static_cast<double>(parent.wide.nearest);
    const double neck = find_neck(
        [&](double depth) {
            const Eigen::AlignedBox2d box = box_at(depth);
            return box.isEmpty() ? 0 : box.diagonal().norm() / 2;
        },
        first, -first + reach);
    const Eigen::AlignedBox2d box = box_at(neck);
    if (!bounded || box.isEmpty()) return {parent.cap, {}};
    DoubleCone& wide = parent.wide;
    const Vec3d centre =
        plane.origin + neck * plane.axis + box.center().x() * plane.s + box.center().y() * plane.t;
    // Widths of beams are those at the first neck, moved to this one.
    wide.width += static_cast<float>(std::abs(neck) * static_cast<double>(wide.spreading));
    wide.nearest -= static_cast<float>(neck);
    wide.neck = centre.cast<float>();
    wide.radius = static_cast<float>(box.diagonal().norm() / 2 * (1 + 1e-6) +
                                     1e-6 * centre.cwiseAbs().maxCoeff());
    wide.tangent = static_cast<float>(slope * (1 + 1e-6) + 1e-6);
    return parent;
}

}  // namespace caustics::beamtree
