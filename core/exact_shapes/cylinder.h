#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "core/exact_shapes/cells.h"
#include "core/exact_shapes/exact_hit.h"
#include "core/mesh/mesh.h"
#include "core/scene_file/key_texts.h"
#include "core/scene_file/values.h"

namespace caustics {

/// Its mesh: 4n sectors round the axis, n bands along it.
TriangleMesh tessellate_cylinder(int n);

/// The open unit tube along z from 0 to 1, facing outwards. Its members: exact_kinds.h.
struct Cylinder {
    static constexpr const char* type = "cylinder";
    static constexpr bool is_flat = false, needs_similarity = true;
    static constexpr bool round_u = true, round_v = false;
    static constexpr int least_cells = 1;
    static constexpr bool is_grid = false;
    static constexpr const char* povray = "cylinder { 0, z, 1 open";

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
    std::vector<std::vector<Vec3d>> hulls() const;
    TriangleMesh tessellate(Cells n) const { return tessellate_cylinder(n.x); }
    static ObjectText text();
    static Transform read_placement(const JsonNode& node);
};

}  // namespace caustics
