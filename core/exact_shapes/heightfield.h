#pragma once

#include <utility>
#include <vector>

#include "core/exact_shapes/cells.h"
#include "core/exact_shapes/exact_hit.h"
#include "core/mesh/mesh.h"

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
    /// Derivative of the gradient along a way.
    Vec2d gradient_change(const Vec2d& xy, const Vec2d& way) const;
    /// Unit normal at (x, y, h(x, y)).
    Vec3d normal(const Vec2d& xy) const;
    /// Bound of |h|, the sum of the amplitudes.
    double max_height() const;
    /// Bound of the second derivative of h along any unit direction, the sum of a k^2.
    double max_curvature() const;
};

/// Its mesh: quads of two triangles each, normals from the exact gradient.
TriangleMesh tessellate_heightfield(const SineHeightfield& field, Cells n);

/// The sum of sines as an exact shape. Its members: exact_kinds.h. Its keys are those of a `heightfield`
/// (core/shapes/heightfield_shape.h).
struct Heightfield {
    const SineHeightfield& field;

    static constexpr const char* type = "heightfield";
    static constexpr bool is_flat = false, needs_similarity = false;
    static constexpr bool round_u = false, round_v = false;
    static constexpr int least_cells = 1;
    static constexpr bool is_grid = true;
    static constexpr const char* povray = nullptr;

    std::optional<ExactHit> intersect(const Vec3d& o, const Vec3d& d, RayInterval range) const;
    Vec3d normal(const Vec3d& p) const { return field.normal(p.head<2>()); }
    Vec2d uv(const Vec3d& p) const;
    std::pair<Vec3d, Vec3d> tangents(const Vec2d& uv) const;
    Vec3d onto(const Vec3d& p) const { return {p.x(), p.y(), field.height(p.head<2>())}; }
    Vec3d onto_change(const Vec3d& p, const Vec3d& way) const;
    Vec3d normal_change(const Vec3d& on, const Vec3d& way) const;
    Eigen::AlignedBox3d bounds() const;
    TriangleMesh tessellate(Cells n) const { return tessellate_heightfield(field, n); }
};

}  // namespace caustics
