#include "beamtree/beams/caster_mesh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <tuple>

#include "core/base/interrupt.h"
#include "core/base/sort_by_number.h"
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

/// A triangle of a caster, by the hash of its place.
struct PlacedTriangle {
    std::uint32_t hash;
    std::uint32_t caster;
    std::uint32_t triangle;
};

// The same in whichever order the corners come; adding zero makes -0 and 0 alike.
std::uint32_t hash_of_place(const TriangleMesh& mesh, std::size_t triangle) {
    std::uint32_t sum = 0;
    for (const std::uint32_t corner : mesh.triangles[triangle]) {
        std::uint32_t hash = 0;
        for (const float x : mesh.positions[corner])
            hash = (hash ^ std::bit_cast<std::uint32_t>(x + 0.0F)) * 0x9E3779B1U ^ hash >> 15U;
        sum += hash ^ hash >> 16U;
    }
    return sum;
}

std::vector<PlacedTriangle> placed_triangles(const std::vector<CasterMesh>& casters) {
    std::vector<PlacedTriangle> all;
    for (std::uint32_t c = 0; c < casters.size(); ++c)
        for (std::uint32_t i = 0; i < casters[c].mesh.triangles.size(); ++i)
            if (!casters[c].left_out[i]) all.push_back({hash_of_place(casters[c].mesh, i), c, i});
    return all;
}

// A ray meets one of two triangles at the same place and then starts behind both: so light is
// bent once, and a second beam would count it twice. The first caster and triangle stays, as it does
// for rays.
void leave_out_duplicates(std::vector<CasterMesh>& casters, int threads) {
    const std::vector<PlacedTriangle> placed = placed_triangles(casters);
    const auto place_of = [&](const PlacedTriangle& one) {
        return place(casters[one.caster].mesh, one.triangle);
    };
    const std::size_t numbers = std::bit_ceil(placed.size() + 1);
    const std::vector<PlacedTriangle> all = sort_by_number(
        std::span(placed), numbers, threads,
        [&](const PlacedTriangle& one) { return one.hash & (numbers - 1); },
        [&](const PlacedTriangle& a, const PlacedTriangle& b) {
            if (a.hash != b.hash) return a.hash < b.hash;
            return std::tuple(place_of(a), a.caster, a.triangle) <
                   std::tuple(place_of(b), b.caster, b.triangle);
        });
    for (std::size_t i = 1; i < all.size(); ++i) {
        if (all[i].hash != all[i - 1].hash || place_of(all[i]) != place_of(all[i - 1])) continue;
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

// Triangles that stay are spread evenly by multiples of the golden ratio. A larger share keeps them, too. The two triangles of
// a cell go together.
void leave_out_all_but(double share, CasterMesh& caster) {
    for (std::size_t i = 0; i < caster.mesh.triangles.size(); ++i) {
        const double turns = static_cast<double>(i / 2) * std::numbers::phi;
        if (turns - std::floor(turns) >= share) caster.left_out[i] = true;
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

std::vector<CasterMesh> caster_meshes(const Scene& scene, int resolution, PolygonKind kind,
                                      int threads, double share) {
    std::vector<CasterMesh> casters;
    for (const std::uint32_t index : scene.casters()) {
        const Shape& shape = scene.shapes()[index];
        CasterMesh caster;
        caster.shape = index;
        caster.tessellated = shape.primitive != Primitive::mesh;
        caster.mesh = caster.tessellated ? tessellate_shape(shape, resolution) : shape.mesh;
        caster.flat = caster.mesh.normals.empty();
        if (caster.flat) caster.mesh = with_face_normals(caster.mesh);
        caster.left_out.resize(caster.mesh.triangles.size());
        leave_out_degenerate(caster);
        casters.push_back(std::move(caster));
    }
    leave_out_duplicates(casters, threads);
    for (CasterMesh& caster : casters) {
        throw_if_interrupted();
        caster.closed = ClosedParts(caster.mesh, caster.left_out, threads);
        if (share < 1) leave_out_all_but(share, caster);
        if (kind == PolygonKind::quad) find_quads(caster);
    }
    return casters;
}

}  // namespace caustics::beamtree
