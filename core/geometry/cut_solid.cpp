#include "core/geometry/cut_solid.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/mesh/mesh_rows.h"

namespace caustics {
namespace {

using Corners = std::vector<std::uint32_t>;

double angle_of(const Vec2d& way) { return std::atan2(way.y(), way.x()); }

Vec2d outwards(const Vec2d& along) { return {along.y(), -along.x()}; }

// Vertices of a facet's own; the number of the first.
std::uint32_t add_facet_vertices(TriangleMesh& mesh, const Polytope& solid, const Corners& facet,
                                 const Vec3d& normal) {
    const Vec3d v_way = std::abs(normal.z()) < 0.999
                            ? Vec3d((Vec3d::UnitZ() - normal.z() * normal).normalized())
                            : Vec3d::UnitY();
    const Vec3d u_way = v_way.cross(normal);
    Eigen::AlignedBox2d box;
    const auto flat = [&](std::uint32_t corner) {
        const Vec3d& p = solid.vertices[corner];
        return Vec2d(p.dot(u_way), p.dot(v_way));
    };
    for (const std::uint32_t corner : facet) box.extend(flat(corner));
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const std::uint32_t corner : facet)
        add_vertex(mesh, solid.vertices[corner], normal,
                   (flat(corner) - box.min()) / box.sizes().maxCoeff());
    return first;
}

void add_facet(TriangleMesh& mesh, const Polytope& solid, const Corners& facet,
               const Vec3d& normal) {
    const std::uint32_t first = add_facet_vertices(mesh, solid, facet, normal);
    for (std::uint32_t i = 2; i < facet.size(); ++i)
        mesh.triangles.push_back({first, first + i - 1, first + i});
}

// A side of the rim's outer or inner edge.
struct RimSide {
    double angle;  ///< of the side's normal, away from the axis
    bool outer;
};

// Between the polygon's corners, from `polygon` on, and those of the circle in it, from `circle` on,
// both counter-clockwise round the axis. Two nested convex polygons: each side makes a triangle with
// that corner of the other one that is farthest along the side's normal.
void add_annulus(TriangleMesh& mesh, std::uint32_t polygon, std::uint32_t corners,
                 std::uint32_t circle, std::uint32_t sectors) {
    const auto side = [&](std::uint32_t first, std::uint32_t i, std::uint32_t count) {
        const Vec3d along = (mesh.positions[first + (i + 1) % count].cast<double>() -
                             mesh.positions[first + i].cast<double>());
        return angle_of(outwards(along.head<2>()));
    };
    std::vector<RimSide> sides;
    const auto add_sides = [&](std::uint32_t first, std::uint32_t count, bool outer) {
        std::uint32_t lowest = 0;
        for (std::uint32_t i = 1; i < count; ++i)
            if (side(first, i, count) < side(first, lowest, count)) lowest = i;
        for (std::uint32_t i = 0; i < count; ++i)
            sides.push_back({side(first, (lowest + i) % count, count), outer});
        return lowest;
    };
    std::uint32_t i = add_sides(polygon, corners, true);
    std::uint32_t j = add_sides(circle, sectors, false);
    std::ranges::stable_sort(sides, {}, &RimSide::angle);
    for (const RimSide& next : sides) {
        if (next.outer) {
            const std::uint32_t after = (i + 1) % corners;
            mesh.triangles.push_back({polygon + i, polygon + after, circle + j});
            i = after;
        } else {
            const std::uint32_t after = (j + 1) % sectors;
            mesh.triangles.push_back({circle + j, polygon + i, circle + after});
            j = after;
        }
    }
}

// From the rim to the axis, so that its front, on the right of the way, is the bowl's inside.
LatheProfile inwards(LatheProfile inner, double height) {
    if (inner.points.size() > 1 && inner.points.front().at.x() == 0)
        std::ranges::reverse(inner.points);
    inner.open = true;
    if (inner.points.empty() || inner.points.back().at.x() != 0)
        throw InputError("the inner profile must end on the axis (r = 0)");
    for (const ProfilePoint& point : inner.points)
        if ((point.at.y() >= height) != (&point == &inner.points.front()) || point.at.y() > height)
            throw InputError(fmt::format(
                "the inner profile must reach the rim, z = {:g}, with its end, and only there",
                height));
    return inner;
}

// Whether the surface inside, but for its rim, lies between the facets and below the rim.
void check_inside(const TriangleMesh& inner, const std::vector<HalfSpace>& planes, double height) {
    for (const Vec3& position : inner.positions) {
        const Vec3d p = position.cast<double>();
        const bool rim = position.z() == static_cast<float>(height);
        for (const HalfSpace& plane : planes) {
            const bool is_top = &plane == &planes.back();
            if (rim && is_top) continue;
            if (plane.normal.dot(p) >= plane.distance)
                throw InputError(
                    fmt::format("the inner profile reaches the outside at r = {:.6g}, "
                                "z = {:.6g}",
                                p.head<2>().norm(), p.z()));
        }
    }
}

void append(TriangleMesh& mesh, const TriangleMesh& more) {
    const auto vertices = static_cast<std::uint32_t>(mesh.positions.size());
    const auto triangles = static_cast<std::uint32_t>(mesh.triangles.size());
    mesh.positions.insert(mesh.positions.end(), more.positions.begin(), more.positions.end());
    mesh.normals.insert(mesh.normals.end(), more.normals.begin(), more.normals.end());
    mesh.uvs.insert(mesh.uvs.end(), more.uvs.begin(), more.uvs.end());
    for (const auto& [a, b, c] : more.triangles)
        mesh.triangles.push_back({a + vertices, b + vertices, c + vertices});
    for (GridPatch patch : more.patches) {
        patch.first_triangle += triangles;
        mesh.patches.push_back(patch);
    }
}

// The rim at the top facet, and the surface inside.
void add_inside(TriangleMesh& mesh, const CutSolid& cut, const Polytope& solid,
                const std::vector<HalfSpace>& planes) {
    const double height = *cut.height;
    const TriangleMesh inner = tessellate_lathe(inwards(*cut.inner, height), cut.inner_sectors);
    check_inside(inner, planes, height);
    const Corners& top = solid.facets.back();
    const std::uint32_t polygon = add_facet_vertices(mesh, solid, top, Vec3d::UnitZ());
    const auto circle = static_cast<std::uint32_t>(mesh.positions.size());
    const auto sectors = static_cast<std::uint32_t>(cut.inner_sectors);
    for (std::uint32_t i = 0; i < sectors; ++i) {
        mesh.positions.push_back(inner.positions[i]);
        mesh.normals.push_back(Vec3::UnitZ());
        mesh.uvs.push_back(inner.uvs[i]);
    }
    add_annulus(mesh, polygon, static_cast<std::uint32_t>(top.size()), circle, sectors);
    append(mesh, inner);
}

}  // namespace

std::vector<HalfSpace> half_spaces(const CutRing& ring) {
    std::vector<HalfSpace> facets;
    const double elevation = ring.angle * pi_d / 180;
    for (int j = 0; j < ring.count; ++j) {
        const double angle = 2 * pi_d * (j + ring.phase) / ring.count;
        facets.push_back({Vec3d(std::cos(elevation) * std::cos(angle),
                                std::cos(elevation) * std::sin(angle), std::sin(elevation))
                              .normalized(),
                          ring.distance});
    }
    return facets;
}

TriangleMesh tessellate_cut(const CutSolid& cut) {
    if (cut.inner && !cut.height) throw InputError("a bowl needs the height of its rim");
    std::vector<HalfSpace> planes = cut.planes;
    if (cut.height) planes.push_back({Vec3d::UnitZ(), *cut.height});
    if (planes.size() > CutSolid::most_planes)
        throw InputError(
            fmt::format("{} planes are more than {}", planes.size(), CutSolid::most_planes));
    Polytope solid = intersect(planes);
    if (cut.height && solid.facets.back().empty())
        throw InputError(fmt::format("the height {:g} cuts nothing off", *cut.height));
    // Not a rounding beside the rim inside.
    if (cut.height)
        for (const std::uint32_t corner : solid.facets.back())
            solid.vertices[corner].z() = *cut.height;
    TriangleMesh mesh;
    for (std::size_t i = 0; i < planes.size(); ++i) {
        const bool rim = cut.inner && i + 1 == planes.size();
        if (!rim && !solid.facets[i].empty())
            add_facet(mesh, solid, solid.facets[i], planes[i].normal);
    }
    if (cut.inner) add_inside(mesh, cut, solid, planes);
    return mesh;
}

}  // namespace caustics
