#include "beamtree/beams/caster_mesh.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <tuple>

#include "core/base/interrupt.h"
#include "core/geometry/tessellate.h"

namespace caustics::beamtree {
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

/// A triangle by its place; `caster` and `triangle` say which.
struct PlacedTriangle {
    std::array<Position, 3> place;
    std::size_t caster;
    std::size_t triangle;
};

// A ray meets one of two triangles at the same place and then starts behind both: so light is
// bent once, and a second beam would count it twice. The first caster and triangle stays, as it does
// for rays.
void leave_out_duplicates(std::vector<CasterMesh>& casters) {
    std::vector<PlacedTriangle> all;
    for (std::size_t c = 0; c < casters.size(); ++c)
        for (std::size_t i = 0; i < casters[c].mesh.triangles.size(); ++i)
            if (!casters[c].left_out[i]) all.push_back({place(casters[c].mesh, i), c, i});
    std::sort(all.begin(), all.end(), [](const PlacedTriangle& a, const PlacedTriangle& b) {
        return std::tie(a.place, a.caster, a.triangle) < std::tie(b.place, b.caster, b.triangle);
    });
    for (std::size_t i = 1; i < all.size(); ++i) {
        if (all[i].place != all[i - 1].place) continue;
        CasterMesh& caster = casters[all[i].caster];
        caster.left_out[all[i].triangle] = true;
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

// Two triangles that run along one edge in opposite ways are a quad with that edge as diagonal.
std::optional<CellQuad> quad_of(const TriangleMesh& mesh, std::uint32_t triangle) {
    const auto& t = mesh.triangles[triangle];
    const auto& u = mesh.triangles[triangle + 1];
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            if (t[i] == u[(j + 1) % 3] && t[(i + 1) % 3] == u[j])
                return CellQuad{triangle, {t[(i + 1) % 3], t[(i + 2) % 3], t[i], u[(j + 2) % 3]}};
    return {};
}

void find_quads(CasterMesh& caster) {
    for (const GridPatch& patch : caster.mesh.patches) {
        if (patch.cell_triangles != 2) continue;
        for (std::uint32_t cell = 0; cell < patch.columns * patch.rows; ++cell) {
            const std::uint32_t triangle = patch.first_triangle + 2 * cell;
            if (caster.left_out[triangle] || caster.left_out[triangle + 1]) continue;
            if (const auto quad = quad_of(caster.mesh, triangle)) caster.quads.push_back(*quad);
        }
    }
    std::sort(caster.quads.begin(), caster.quads.end(),
              [](const CellQuad& a, const CellQuad& b) { return a.triangle < b.triangle; });
}

}  // namespace

Vec3 triangle_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3d cross = (b - a).cast<double>().cross((c - a).cast<double>());
    if (cross.isZero(0)) return Vec3::Zero();
    return cross.stableNormalized().cast<float>();
}

std::vector<CasterMesh> caster_meshes(const Scene& scene, int resolution, PolygonKind kind) {
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
        casters.push_back(std::move(caster));
    }
    leave_out_duplicates(casters);
    for (CasterMesh& caster : casters) {
        throw_if_interrupted();
        if (kind == PolygonKind::quad) find_quads(caster);
        caster.closed = ClosedParts(caster.mesh, caster.left_out);
    }
    return casters;
}

}  // namespace caustics::beamtree
