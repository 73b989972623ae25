#pragma once

#include <cmath>

#include "core/math/vec.h"

namespace caustics {

/// Right-handed orthonormal frame (s, t, n) round a unit vector n; local z is n.
/// Branch-free construction of Duff et al., "Building an Orthonormal Basis, Revisited" (2017).
struct Frame {
    Vec3 s, t, n;

    explicit Frame(const Vec3& normal) : n(normal) {
        const float sign = std::copysign(1.0F, n.z());
        const float a = -1.0F / (sign + n.z());
        const float b = n.x() * n.y() * a;
        s = Vec3(1.0F + sign * n.x() * n.x() * a, sign * b, -sign * n.x());
        t = Vec3(b, sign + n.y() * n.y() * a, -n.y());
    }

    Vec3 to_world(const Vec3& local) const { return s * local.x() + t * local.y() + n * local.z(); }
    Vec3 to_local(const Vec3& world) const { return {s.dot(world), t.dot(world), n.dot(world)}; }
};

}  // namespace caustics
