#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace caustics {

/// Points, directions and normals of stored and hot data; world frame, metres, unless named
/// otherwise.
using Vec2 = Eigen::Vector2f;
using Vec3 = Eigen::Vector3f;
/// Exact quadrics, transforms and audits.
using Vec2d = Eigen::Vector2d;
using Vec3d = Eigen::Vector3d;

/// Local frame of a shape -> world frame.
using Transform = Eigen::Affine3d;

inline constexpr float pi = 3.14159265358979323846F;
inline constexpr double pi_d = 3.14159265358979323846;

/// Twice the signed area of a triangle with sides a, b: above 0 where b lies to the left of a.
inline double cross(const Vec2d& a, const Vec2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Axis-aligned box, world frame; empty until extended.
using Box = Eigen::AlignedBox3f;

}  // namespace caustics
