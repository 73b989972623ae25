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

/// Its mesh: n rings of 4n sectors.
TriangleMesh tessellate_disk(int n);

/// The unit disk at z = 0, facing +z. Its members: exact_kinds.h.
struct Disk {
    static constexpr const char* type = "disk";
    static constexpr bool is_flat = true, needs_similarity = false;
    static constexpr bool round_u = false, round_v = true;
    static constexpr int least_cells = 1;
    static constexpr bool is_grid = false;
    static constexpr const char* povray = "disc { 0, z, 1";

    std::optional<ExactHit> intersect(const Vec3d& o, const Vec3d& d, RayInterval range) const;
    Vec3d normal(const Vec3d& p) const;
    Vec2d uv(const Vec3d& p) const;
    std::pair<Vec3d, Vec3d> tangents(const Vec2d& uv) const;
    Vec3d onto(const Vec3d& p) const;
    Vec3d onto_change(const Vec3d&, const Vec3d& way) const { return {way.x(), way.y(), 0}; }
    Vec3d normal_change(const Vec3d&, const Vec3d&) const { return Vec3d::Zero(); }
    Eigen::AlignedBox3d bounds() const;
    double area(const Eigen::Matrix3d& to_world) const;
    std::pair<Vec3d, Vec3d> sample(float u0, float u1) const;
    std::vector<Vec3d> piece(const Vec2& low, const Vec2& high) const;
    TriangleMesh tessellate(Cells n) const { return tessellate_disk(n.x); }
    static ObjectText text();
};

}  // namespace caustics
