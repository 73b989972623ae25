#include "core/exact_shapes/disk.h"

#include <cmath>

#include "core/exact_shapes/shape_keys.h"
#include "core/math/sampling.h"
#include "core/mesh/mesh_rows.h"

namespace caustics {

using namespace scene_file;

TriangleMesh tessellate_disk(int n) {
    check_resolution(n, 1);
    const int sectors = 4 * n;
    TriangleMesh mesh;
    // Rows run inwards, so that columns x rows points along +z.
    for (int ring = n; ring >= 1; --ring)
        for (int sector = 0; sector <= sectors; ++sector) {
            const Vec2d xy = fraction(ring, n) * on_circle(sector, sectors);
            add_vertex(mesh, {xy.x(), xy.y(), 0}, Vec3d::UnitZ(),
                       {fraction(ring, n), fraction(sector, sectors)});
        }
    add_grid_triangles(mesh, 0, sectors, n - 1);
    const auto inner = static_cast<std::uint32_t>((n - 1) * (sectors + 1));
    add_fan(mesh, inner, sectors, true,
            [&](double v) { return add_vertex(mesh, Vec3d::Zero(), Vec3d::UnitZ(), {0, v}); });
    return mesh;
}

std::optional<ExactHit> Disk::intersect(const Vec3d& o, const Vec3d& d, RayInterval range) const {
    const std::optional<ExactHit> hit = hit_of_plane(o, d, range);
    if (hit && hit->local.squaredNorm() > 1) return {};
    return hit;
}

Vec3d Disk::normal(const Vec3d&) const { return Vec3d::UnitZ(); }

Vec2d Disk::uv(const Vec3d& p) const { return {p.head<2>().norm(), turns_of(p.head<2>())}; }

std::pair<Vec3d, Vec3d> Disk::tangents(const Vec2d& uv) const {
    return {at_turns(uv.y()), uv.x() * along_turns(uv.y())};
}

Vec3d Disk::onto(const Vec3d& p) const { return {p.x(), p.y(), 0}; }

Eigen::AlignedBox3d Disk::bounds() const { return {Vec3d(-1, -1, 0), Vec3d(1, 1, 0)}; }

double Disk::area(const Eigen::Matrix3d& to_world) const {
    return pi_d * to_world.col(0).cross(to_world.col(1)).norm();
}

std::pair<Vec3d, Vec3d> Disk::sample(float u0, float u1) const {
    const Vec2 p = uniform_disc(u0, u1);
    return {Vec3d(static_cast<double>(p.x()), static_cast<double>(p.y()), 0), Vec3d::UnitZ()};
}

// The sampler's radius is the root of the first number; inner corners lie closer in.
std::vector<Vec3d> Disk::piece(const Vec2& low, const Vec2& high) const {
    const double from = 2 * pi_d * static_cast<double>(low.y());
    const double to = 2 * pi_d * static_cast<double>(high.y());
    const auto outer = std::sqrt(static_cast<double>(high.x()));
    const auto inner = std::sqrt(static_cast<double>(low.x())) / outer;
    std::vector<Vec3d> corners = sector_hull(from, to, inner, 0);
    for (Vec3d& p : corners) p *= outer;
    return corners;
}

ObjectText Disk::text() {
    return {type, "A shape: the unit disk across z, facing +z.", parametric_keys("1")};
}

}  // namespace caustics
