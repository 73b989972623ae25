#include "core/geometry/tessellate.h"

#include "core/mesh/mesh_rows.h"

namespace caustics {
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

TriangleMesh tessellate_shape(const Shape& shape, int n) {
    if (shape.primitive == Primitive::mesh) return shape.mesh;
    TriangleMesh mesh = ask_exact(shape, [&](const auto& kind) { return kind.tessellate(n); });
    place_exact(mesh, shape);
    return mesh;
}

void place_exact(TriangleMesh& mesh, const Shape& shape) {
    transform(mesh, shape.to_world);
    if (shape.flip_normals) flip(mesh);
}

const TriangleMesh& OwnFrameMeshes::of(const Shape& shape) {
    if (shape.primitive == Primitive::mesh) return shape.mesh;
    const bool is_like_others = shape.primitive != Primitive::heightfield;
    const auto [made, is_new] =
        made_.try_emplace({shape.primitive, is_like_others ? nullptr : &shape});
    if (is_new)
        made->second = ask_exact(shape, [&](const auto& kind) { return kind.tessellate(n_); });
    return made->second;
}

}  // namespace caustics
