#include "core/geometry/tessellate.h"

#include <cmath>
#include <string>

#include "core/base/error.h"
#include "core/geometry/mesh_rows.h"

namespace caustics {
namespace {

// Keeps vertex numbers far within 32 bits.
constexpr int max_resolution = 16384;

void check_resolution(int n, int least) {
    if (n < least || n > max_resolution)
        throw InputError("resolution " + std::to_string(n) + " is not in [" +
                         std::to_string(least) + ", " + std::to_string(max_resolution) + "]");
}

void check_resolution(Cells n) {
    check_resolution(n.x, 1);
    check_resolution(n.y, 1);
}

}  // namespace

TriangleMesh tessellate_rectangle(Cells n) {
    check_resolution(n);
    TriangleMesh mesh;
    for (int j = 0; j <= n.y; ++j)
        for (int i = 0; i <= n.x; ++i)
            add_vertex(mesh, {symmetric(i, n.x), symmetric(j, n.y), 0}, Vec3d::UnitZ(),
                       {fraction(i, n.x), fraction(j, n.y)});
    add_grid_triangles(mesh, 0, n.x, n.y);
    return mesh;
}

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

TriangleMesh tessellate_cube(int n) {
    check_resolution(n, 1);
    // Where u and v grow on each face of Mitsuba's cube; the outward normal is v x u.
    struct Face {
        Vec3d u, v;
    };
    const Vec3d x = Vec3d::UnitX();
    const Vec3d y = Vec3d::UnitY();
    const Vec3d z = Vec3d::UnitZ();
    const Face faces[] = {{z, x}, {-x, -z}, {y, -z}, {y, x}, {y, z}, {-y, x}};
    TriangleMesh mesh;
    for (const Face& face : faces) {
        const Vec3d normal = face.v.cross(face.u);
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (int i = 0; i <= n; ++i)
            for (int j = 0; j <= n; ++j)
                add_vertex(mesh, normal + symmetric(i, n) * face.u + symmetric(j, n) * face.v,
                           normal, {fraction(i, n), fraction(j, n)});
        add_grid_triangles(mesh, first, n, n);
    }
    return mesh;
}

TriangleMesh tessellate_heightfield(const SineHeightfield& field, Cells n) {
    check_resolution(n);
    TriangleMesh mesh;
    for (int j = 0; j <= n.y; ++j)
        for (int i = 0; i <= n.x; ++i) {
            const Vec2d xy(symmetric(i, n.x) * field.half_size.x(),
                           symmetric(j, n.y) * field.half_size.y());
            add_vertex(mesh, {xy.x(), xy.y(), field.height(xy)}, field.normal(xy),
                       {fraction(i, n.x), fraction(j, n.y)});
        }
    add_grid_triangles(mesh, 0, n.x, n.y);
    return mesh;
}

TriangleMesh tessellate_shape(const Shape& shape, int n) {
    TriangleMesh mesh;
    switch (shape.primitive) {
        case Primitive::rectangle: mesh = tessellate_rectangle(n); break;
        case Primitive::disk: mesh = tessellate_disk(n); break;
        case Primitive::sphere: mesh = tessellate_sphere(n); break;
        case Primitive::cylinder: mesh = tessellate_cylinder(n); break;
        case Primitive::heightfield: mesh = tessellate_heightfield(shape.field, n); break;
        case Primitive::mesh: return shape.mesh;
    }
    transform(mesh, shape.to_world);
    if (shape.flip_normals) flip(mesh);
    return mesh;
}

}  // namespace caustics
