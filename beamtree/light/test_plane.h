#pragma once

#include "core/math/vec.h"

namespace caustics::beamtree {

/// The plane through a point on which caustic polygons are formed [CC95 sec. 3.2.2]: across the
/// receiver's normal, or across a fixed one. `normal` points against the light that arrives.
class TestPlane {
public:
    TestPlane(const Vec3& point, const Vec3& normal);
    /// Moves the plane, without turning it, to another point.
    void move_to(const Vec3& point) { point_ = point.cast<double>(); }

    const Vec3d& point() const { return point_; }
    const Vec3d& normal() const { return normal_; }
    /// Height of a point above the plane, in units of the normal's length (1 to rounding).
    double height(const Vec3& p) const { return normal_.dot(p.cast<double>() - point_); }
    /// How steeply a direction goes down to the plane: cosine of its angle to -normal.
    double steepness(const Vec3& d) const { return -normal_.dot(d.cast<double>()); }
    /// Two coordinates of p + s d - point, the one along which the normal is longest left out.
    Vec2d project(const Vec3& p, double s, const Vec3& d) const {
        return {static_cast<double>(p[u_]) - point_[u_] + s * static_cast<double>(d[u_]),
                static_cast<double>(p[v_]) - point_[v_] + s * static_cast<double>(d[v_])};
    }
    /// The same two coordinates of a way along the plane.
    Vec2d across(const Vec3d& way) const { return {way[u_], way[v_]}; }
    /// Area on the plane over the area in those coordinates.
    double area_scale() const { return area_scale_; }

private:
    Vec3d point_;
    Vec3d normal_;
    int u_ = 0;
    int v_ = 1;
    double area_scale_ = 1;
};

}  // namespace caustics::beamtree
