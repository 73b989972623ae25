#pragma once

#include <optional>
#include <utility>

#include "core/exact_shapes/cells.h"
#include "core/exact_shapes/exact_hit.h"
#include "core/mesh/mesh.h"
#include "core/scene_file/key_texts.h"
#include "core/scene_file/values.h"

namespace caustics {

/// Its mesh: n bands of latitude, 2n of longitude; the poles are fans. n >= 2.
TriangleMesh tessellate_sphere(int n);

/// The unit sphere, facing outwards. Its members: exact_kinds.h.
struct Sphere {
    static constexpr const char* type = "sphere";
    static constexpr bool is_flat = false, needs_similarity = true;
    static constexpr bool round_u = true, round_v = false;
    static constexpr int least_cells = 2;
    static constexpr bool is_grid = false;
    static constexpr const char* povray = "sphere { 0, 1";

    std::optional<ExactHit> intersect(const Vec3d& o, const Vec3d& d, RayInterval range) const;
    Vec3d normal(const Vec3d& p) const;
    Vec2d uv(const Vec3d& p) const;
    std::pair<Vec3d, Vec3d> tangents(const Vec2d& uv) const;
    Vec3d onto(const Vec3d& p) const;
    Vec3d onto_change(const Vec3d& p, const Vec3d& way) const;
    Vec3d normal_change(const Vec3d& on, const Vec3d& way) const;
    Eigen::AlignedBox3d bounds() const;
    double area(const Eigen::Matrix3d& to_world) const;
    std::pair<Vec3d, Vec3d> sample(float u0, float u1) const;
    TriangleMesh tessellate(Cells n) const { return tessellate_sphere(n.x); }
    static ObjectText text();
    static Transform read_placement(const JsonNode& node);
};

}  // namespace caustics
