#include "core/exact_shapes/sphere.h"

#include <algorithm>
#include <cmath>

#include "core/exact_shapes/shape_keys.h"
#include "core/math/sampling.h"
#include "core/mesh/mesh_rows.h"

namespace caustics {

using namespace scene_file;

TriangleMesh tessellate_sphere(int n) {
    check_resolution(n, 2);
    const int sectors = 2 * n;
    TriangleMesh mesh;
    // Rows run from the south to the north, so that columns x rows points outwards.
    for (int band = n - 1; band >= 1; --band) {
        // cos and sin of the polar angle, from +z.
        const Vec2d polar = on_circle(band, sectors);
        for (int sector = 0; sector <= sectors; ++sector) {
            const Vec2d xy = polar.y() * on_circle(sector, sectors);
            const Vec3d p(xy.x(), xy.y(), polar.x());
            add_vertex(mesh, p, p, {fraction(sector, sectors), fraction(band, n)});
        }
    }
    const auto north_ring = static_cast<std::uint32_t>((n - 2) * (sectors + 1));
    add_fan(mesh, 0, sectors, false,
            [&](double u) { return add_vertex(mesh, -Vec3d::UnitZ(), -Vec3d::UnitZ(), {u, 1}); });
    add_grid_triangles(mesh, 0, sectors, n - 2);
    add_fan(mesh, north_ring, sectors, true,
            [&](double u) { return add_vertex(mesh, Vec3d::UnitZ(), Vec3d::UnitZ(), {u, 0}); });
    return mesh;
}

std::optional<ExactHit> Sphere::intersect(const Vec3d& o, const Vec3d& d, RayInterval range) const {
    const double a = d.squaredNorm();
    const double b = o.dot(d);
    const double c = o.squaredNorm() - 1;
    // The discriminant from the line's closest point to the centre: exact for distant origins.
    const Vec3d closest = o - b / a * d;
    const auto roots = quadratic_roots(a, b, c, a * (1 - closest.squaredNorm()));
    if (!roots) return {};
    for (const double t : {roots->first, roots->second})
        if (range.holds(t)) return ExactHit{t, (o + t * d).normalized()};
    return {};
}

Vec3d Sphere::normal(const Vec3d& p) const { return p.normalized(); }

Vec2d Sphere::uv(const Vec3d& p) const {
    return {turns_of(p.head<2>()), std::acos(std::clamp(p.z(), -1.0, 1.0)) / pi_d};
}

std::pair<Vec3d, Vec3d> Sphere::tangents(const Vec2d& uv) const {
    const double polar = pi_d * uv.y();
    return {std::sin(polar) * along_turns(uv.x()),
            pi_d * (std::cos(polar) * at_turns(uv.x()) - std::sin(polar) * Vec3d::UnitZ())};
}

Vec3d Sphere::onto(const Vec3d& p) const { return p.normalized(); }

Vec3d Sphere::onto_change(const Vec3d& p, const Vec3d& way) const {
    const double r = p.norm();
    const Vec3d n = p / r;
    return (way - n.dot(way) * n) / r;
}

Vec3d Sphere::normal_change(const Vec3d& on, const Vec3d& way) const {
    return onto_change(on, way);
}

Eigen::AlignedBox3d Sphere::bounds() const { return {Vec3d(-1, -1, -1), Vec3d(1, 1, 1)}; }

double Sphere::area(const Eigen::Matrix3d& to_world) const {
    return 4 * pi_d * to_world.col(0).squaredNorm();
}

std::pair<Vec3d, Vec3d> Sphere::sample(float u0, float u1) const {
    const Vec3d n = uniform_cap(2, u0, u1).cast<double>().normalized();
    return {n, n};
}

ObjectText Sphere::text() {
    return {
        type, "A shape, facing outwards.",
        joined(parametric_keys("2"), {vector("center", "The middle.", "[0, 0, 0]"), radius_key()})};
}

Transform Sphere::read_placement(const JsonNode& node) {
    const auto centre = node.find("center");
    const double radius = read_radius(node);
    return Eigen::Translation3d(centre ? read_vector(*centre) : Vec3d::Zero().eval()) *
           Eigen::Scaling(radius);
}

}  // namespace caustics
