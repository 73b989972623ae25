#pragma once

#include <vector>

#include "core/math/vec.h"

namespace caustics {

/// One sine of a heightfield: amplitude * sin(wave_vector . (x, y) + phase), local frame.
struct SineWave {
    double amplitude = 0;               ///< [m]
    Vec2d wave_vector = Vec2d::Zero();  ///< [rad/m]
    double phase = 0;                   ///< [rad]
};

/// A sum of sines z = h(x, y) over the rectangle |x| <= half_size.x, |y| <= half_size.y of the
/// local frame; normals point up, to +z.
struct SineHeightfield {
    std::vector<SineWave> waves;
    Vec2d half_size = Vec2d::Ones();

    double height(const Vec2d& xy) const;
    Vec2d gradient(const Vec2d& xy) const;
    /// Unit normal at (x, y, h(x, y)).
    Vec3d normal(const Vec2d& xy) const;
    /// Bound of |h|, the sum of the amplitudes.
    double max_height() const;
    /// Bound of the second derivative of h along any unit direction, the sum of a k^2.
    double max_curvature() const;
};

}  // namespace caustics
