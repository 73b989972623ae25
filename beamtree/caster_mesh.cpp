#include "beamtree/caster_mesh.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "core/tessellate.h"

namespace caustics {
namespace {

using Position = std::tuple<float, float, float>;

TriangleMesh with_face_normals(const TriangleMesh& mesh) {
    TriangleMesh apart;
    apart.patches = mesh.patches;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3 corners[] = {mesh.positions[a], mesh.positions[b], mesh.positions[c]};
        const Vec3 normal = triangle_normal(corners[0], corners[1], corners[2]);
        const auto first = static_cast<std::uint32_t>(apart.positions.size());
        for (const Vec3& corner : corners) {
            apart.positions.push_back(corner);
            apart.normals.push_back(normal);
        }
        apart.triangles.push_back({first, first + 1, first + 2});
    }
    return apart;
}

// The positions of a triangle's corners in ascending order: equal for triangles at one place.
std::array<Position, 3> place(const TriangleMesh& mesh, std::size_t triangle) {
    std::array<Position, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3& p = mesh.positions[mesh.triangles[triangle][i]];
        corners[i] = {p.x(), p.y(), p.z()};
    }
    std::sort(corners.begin(), corners.end());
    return corners;
}

// A ray meets one of two triangles at the same place and then starts behind both: so light is
// bent once, and a second beam would count it twice.
void leave_out_duplicates(CasterMesh& caster) {
    const std::size_t count = caster.mesh.triangles.size();
    std::vector<std::array<Position, 3>> places(count);
    for (std::size_t i = 0; i < count; ++i) places[i] = place(caster.mesh, i);
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::tie(places[a], a) < std::tie(places[b], b);
    });
    for (std::size_t i = 1; i < count; ++i) {
        if (places[order[i]] != places[order[i - 1]] || caster.left_out[order[i]]) continue;
        caster.left_out[order[i]] = true;
        ++caster.duplicated;
    }
}

void leave_out_degenerate(CasterMesh& caster) {
    for (std::size_t i = 0; i < caster.mesh.triangles.size(); ++i) {
        const auto& [a, b, c] = caster.mesh.triangles[i];
        const std::vector<Vec3>& p = caster.mesh.positions;
        if (!triangle_normal(p[a], p[b], p[c]).isZero(0)) continue;
        caster.left_out[i] = true;
        ++caster.degenerate;
    }
}

}  // namespace

Vec3 triangle_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3d cross = (b - a).cast<double>().cross((c - a).cast<double>());
    if (cross.isZero(0)) return Vec3::Zero();
    return cross.stableNormalized().cast<float>();
}

std::vector<CasterMesh> caster_meshes(const Scene& scene, int resolution) {
    std::vector<CasterMesh> casters;
    for (const std::uint32_t index : scene.casters()) {
        const Shape& shape = scene.shapes()[index];
        CasterMesh caster;
        caster.shape = index;
        caster.tessellated = shape.primitive != Primitive::mesh;
        const TriangleMesh mesh =
            caster.tessellated ? tessellate_shape(shape, resolution) : shape.mesh;
        caster.flat = mesh.normals.empty();
        caster.mesh = caster.flat ? with_face_normals(mesh) : mesh;
        caster.left_out.resize(caster.mesh.triangles.size());
        leave_out_degenerate(caster);
        leave_out_duplicates(caster);
        casters.push_back(std::move(caster));
    }
    return casters;
}

}  // namespace caustics
