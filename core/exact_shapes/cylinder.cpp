#include "core/exact_shapes/cylinder.h"

#include <fmt/format.h>

#include <cmath>

#include "core/exact_shapes/shape_keys.h"
#include "core/math/coordinate_limit.h"
#include "core/mesh/mesh_rows.h"

namespace caustics {

using namespace scene_file;

TriangleMesh tessellate_cylinder(int n) {
    check_resolution(n, 1);
    const int sectors = 4 * n;
    TriangleMesh mesh;
    for (int band = 0; band <= n; ++band)
        for (int sector = 0; sector <= sectors; ++sector) {
            const Vec2d xy = on_circle(sector, sectors);
            const double z = fraction(band, n);
            add_vertex(mesh, {xy.x(), xy.y(), z}, {xy.x(), xy.y(), 0},
                       {fraction(sector, sectors), z});
        }
    add_grid_triangles(mesh, 0, sectors, n);
    return mesh;
}

namespace {

// Rotation from z to a unit axis, by Duff et al. 2017, as in Mitsuba: where u = 0 lies follows.
Eigen::Matrix3d frame_along(const Vec3d& n) {
    const double sign = std::copysign(1.0, n.z());
    const double a = -1 / (sign + n.z());
    const double b = n.x() * n.y() * a;
    Eigen::Matrix3d frame;
    frame.col(0) << 1 + sign * n.x() * n.x() * a, sign * b, -sign * n.x();
    frame.col(1) << b, sign + n.y() * n.y() * a, -n.y();
    frame.col(2) = n;
    return frame;
}

}  // namespace

std::optional<ExactHit> Cylinder::intersect(const Vec3d& o, const Vec3d& d,
                                            RayInterval range) const {
    const Vec2d o2 = o.head<2>();
    const Vec2d d2 = d.head<2>();
    const double a = d2.squaredNorm();
    if (a == 0) return {};
    const double b = o2.dot(d2);
    const double c = o2.squaredNorm() - 1;
    const Vec2d closest = o2 - b / a * d2;
    const auto roots = quadratic_roots(a, b, c, a * (1 - closest.squaredNorm()));
    if (!roots) return {};
    for (const double t : {roots->first, roots->second}) {
        const double z = o.z() + t * d.z();
        if (!range.holds(t) || z < 0 || z > 1) continue;
        const Vec2d xy = (o2 + t * d2).normalized();
        return ExactHit{t, Vec3d(xy.x(), xy.y(), z)};
    }
    return {};
}

Vec3d Cylinder::normal(const Vec3d& p) const { return Vec3d(p.x(), p.y(), 0).normalized(); }

Vec2d Cylinder::uv(const Vec3d& p) const { return {turns_of(p.head<2>()), p.z()}; }

std::pair<Vec3d, Vec3d> Cylinder::tangents(const Vec2d& uv) const {
    return {along_turns(uv.x()), Vec3d::UnitZ()};
}

Vec3d Cylinder::onto(const Vec3d& p) const {
    const Vec2d xy = p.head<2>().normalized();
    return {xy.x(), xy.y(), p.z()};
}

Vec3d Cylinder::onto_change(const Vec3d& p, const Vec3d& way) const {
    const Vec3d round = normal_change(p, way);
    return {round.x(), round.y(), way.z()};
}

Vec3d Cylinder::normal_change(const Vec3d& on, const Vec3d& way) const {
    const double r = on.head<2>().norm();
    const Vec2d n = on.head<2>() / r;
    const Vec2d turned = (way.head<2>() - n.dot(way.head<2>()) * n) / r;
    return {turned.x(), turned.y(), 0};
}

Eigen::AlignedBox3d Cylinder::bounds() const { return {Vec3d(-1, -1, 0), Vec3d(1, 1, 1)}; }

double Cylinder::area(const Eigen::Matrix3d& to_world) const {
    return 2 * pi_d * to_world.col(0).norm() * to_world.col(2).norm();
}

std::pair<Vec3d, Vec3d> Cylinder::sample(float u0, float u1) const {
    const double angle = 2 * pi_d * static_cast<double>(u0);
    const Vec3d n(std::cos(angle), std::sin(angle), 0);
    return {n + static_cast<double>(u1) * Vec3d::UnitZ(), n};
}

// A tube is mostly air: its sectors are less to fill.
std::vector<std::vector<Vec3d>> Cylinder::hulls() const {
    constexpr int sectors = 16;
    constexpr double step = 2 * pi_d / sectors;
    std::vector<std::vector<Vec3d>> parts;
    for (int i = 0; i < sectors; ++i) parts.push_back(sector_hull(i * step, (i + 1) * step, 1, 1));
    return parts;
}

ObjectText Cylinder::text() {
    return {
        type, "A shape: an open tube, facing outwards.",
        joined(parametric_keys("1"), {vector("p0", "One end of the axis.", "[0, 0, 0]"),
                                      vector("p1", "The other end.", "[0, 0, 1]"), radius_key()})};
}

Transform Cylinder::read_placement(const JsonNode& node) {
    const auto p0 = node.find("p0");
    const auto p1 = node.find("p1");
    const Vec3d from = p0 ? read_vector(*p0) : Vec3d::Zero().eval();
    const Vec3d axis = (p1 ? read_vector(*p1) : Vec3d::UnitZ().eval()) - from;
    if (!(axis.norm() >= smallest_size))
        node.fail(
            fmt::format("p0 and p1 of a cylinder must differ by {:g} m at least", smallest_size));
    const double radius = read_radius(node);
    Transform placement = Transform::Identity();
    placement.linear() = frame_along(axis.normalized()) *
                         Eigen::DiagonalMatrix<double, 3>(radius, radius, axis.norm());
    placement.translation() = from;
    return placement;
}

}  // namespace caustics
