#include "beamtree/beams/lit_caster.h"

#include <algorithm>

#include "core/geometry/surface_offset.h"

namespace caustics::beamtree {

bool is_flat_between(const Vec3& normal, const Vec3& other) {
    constexpr float flat = 1e-3F;
    return (normal - other).norm() < flat;
}

bool sends_on(const MeshPoint& point, const Facing& facing, Event event) {
    const SpecularVertex& bent = point.bent;
    const bool leaves_front = facing.normal.dot(bent.direction[event]) > 0;
    return bent.front == facing.front && leaves_front == (facing.front == (event == reflection)) &&
           !is_black(bent.weight[event]);
}

LitCaster::LitCaster(const Scene& scene, const CasterMesh& caster, const LightSample& light)
    : scene_(scene),
      caster_(caster),
      light_(light),
      bsdf_(scene.shapes()[caster.shape].bsdf),
      bender_(scene, caster.shape, light),
      hidden_(caster.closed.hidden_from(caster.mesh, light)) {}

Facing LitCaster::facing(std::uint32_t triangle) const {
    const TriangleMesh& mesh = caster_.mesh;
    const auto& [i, j, k] = mesh.triangles[triangle];
    const Vec3& a = mesh.positions[i];
    const Vec3& b = mesh.positions[j];
    const Vec3& c = mesh.positions[k];
    Facing facing{triangle_normal(a, b, c), false, false};
    const Vec3 middle = (a + b + c) / 3;
    facing.front = facing.normal.dot(to_light(light_, middle)) > 0;
    // A surface that meets itself may be lit on what counts as its inside.
    facing.hidden = hidden_(triangle, facing.front) &&
                    !sees(scene_, {middle, facing.normal, corner_offset(triangle)}, light_);
    return facing;
}

// Twice the rounding, as places between corners are found in float.
float corner_offset(const TriangleMesh& mesh, std::uint32_t triangle) {
    const auto& [i, j, k] = mesh.triangles[triangle];
    const Vec3& a = mesh.positions[i];
    const Vec3& b = mesh.positions[j];
    const Vec3& c = mesh.positions[k];
    const Vec3 normal = triangle_normal(a, b, c);
    float offset = 0;
    for (const Vec3* corner : {&a, &b, &c})
        offset = std::max(offset, triangle_offset(*corner, normal, a, b, c));
    return 2 * offset;
}

// Bound of how far the exact shape bulges from its triangle: |edge| |turn of the normal| / 8 for
// a circular arc, twice that for others and for what adds up inside the triangle.
float LitCaster::offset(std::uint32_t triangle) const {
    if (!caster_.tessellated) return corner_offset(triangle);
    const TriangleMesh& mesh = caster_.mesh;
    const auto& corners = mesh.triangles[triangle];
    float bulge = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t a = corners[i];
        const std::uint32_t b = corners[(i + 1) % 3];
        bulge = std::max(bulge, (mesh.positions[a] - mesh.positions[b]).norm() *
                                    (mesh.normals[a] - mesh.normals[b]).norm());
    }
    return corner_offset(triangle) + bulge / 4;
}

}  // namespace caustics::beamtree
