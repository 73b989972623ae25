#include "core/exact_shapes/rectangle.h"

#include <cmath>

#include "core/exact_shapes/shape_keys.h"
#include "core/mesh/mesh_rows.h"

namespace caustics {

using namespace scene_file;

TriangleMesh tessellate_rectangle(Cells n) {
    check_resolution(n);
    TriangleMesh mesh;
    expect_grid(mesh, n.x, n.y);
    for (int j = 0; j <= n.y; ++j)
        for (int i = 0; i <= n.x; ++i)
            add_vertex(mesh, {symmetric(i, n.x), symmetric(j, n.y), 0}, Vec3d::UnitZ(),
                       {fraction(i, n.x), fraction(j, n.y)});
    add_grid_triangles(mesh, 0, n.x, n.y);
    return mesh;
}

std::optional<ExactHit> Rectangle::intersect(const Vec3d& o, const Vec3d& d,
                                             RayInterval range) const {
    const std::optional<ExactHit> hit = hit_of_plane(o, d, range);
    if (hit && (std::abs(hit->local.x()) > 1 || std::abs(hit->local.y()) > 1)) return {};
    return hit;
}

Vec3d Rectangle::normal(const Vec3d&) const { return Vec3d::UnitZ(); }

Vec2d Rectangle::uv(const Vec3d& p) const { return (p.head<2>() + Vec2d::Ones()) / 2; }

std::pair<Vec3d, Vec3d> Rectangle::tangents(const Vec2d&) const {
    return {Vec3d(2, 0, 0), Vec3d(0, 2, 0)};
}

Vec3d Rectangle::onto(const Vec3d& p) const { return {p.x(), p.y(), 0}; }

Eigen::AlignedBox3d Rectangle::bounds() const { return {Vec3d(-1, -1, 0), Vec3d(1, 1, 0)}; }

double Rectangle::area(const Eigen::Matrix3d& to_world) const {
    return 4 * to_world.col(0).cross(to_world.col(1)).norm();
}

std::pair<Vec3d, Vec3d> Rectangle::sample(float u0, float u1) const {
    return {Vec3d(2 * static_cast<double>(u0) - 1, 2 * static_cast<double>(u1) - 1, 0),
            Vec3d::UnitZ()};
}

std::vector<Vec3d> Rectangle::piece(const Vec2& low, const Vec2& high) const {
    std::vector<Vec3d> corners;
    for (const float x : {low.x(), high.x()})
        for (const float y : {low.y(), high.y()})
            corners.emplace_back(2 * static_cast<double>(x) - 1, 2 * static_cast<double>(y) - 1, 0);
    return corners;
}

ObjectText Rectangle::text() {
    return {type, "A shape: the square from -1 to 1 in x and y, facing +z.", grid_keys()};
}

}  // namespace caustics
