#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "beamtree/beams/closed_parts.h"
#include "core/mesh/mesh.h"
#include "core/scene/scene.h"

namespace caustics::beamtree {

/// What a specular polygon is.
enum class PolygonKind {
    triangle,
    quad  ///< the two triangles of a cell of a regular subdivision, other triangles as they are
};

/// A cell of a regular subdivision as one polygon: triangles (0, 1, 2) and (0, 2, 3) of its corners
/// are those of the mesh from `triangle` on.
struct CellQuad {
    std::uint32_t triangle;
    std::array<std::uint32_t, 4> corners;  ///< vertices of the mesh
};

/// The specular polygons of one caster with a normal at every vertex. A mesh without normals gets
/// its own three vertices a triangle with the triangle's normal, as every other method sees it.
struct CasterMesh {
    std::uint32_t shape = 0;  ///< index into Scene::shapes
    TriangleMesh mesh;        ///< world frame, with normals
    /// Triangles that make no beam: without area, at the place of an earlier one, or beyond the share that is asked for.
    std::vector<bool> left_out;
    std::vector<CellQuad> quads;  ///< by ascending triangle; none unless they were asked for
    ClosedParts closed;
    std::uint64_t degenerate = 0;
    std::uint64_t duplicated = 0;
    bool flat = false;         ///< the mesh had no normals
    bool tessellated = false;  ///< of an exact shape, by `mesh_resolution`

    std::size_t polygon_count() const { return mesh.triangles.size() - quads.size(); }
};

/// Exact casters are tessellated with `resolution`; meshes are taken as they are. All but about that share of the polygons are
/// left out.
std::vector<CasterMesh> caster_meshes(const Scene& scene, int resolution,
                                      PolygonKind kind = PolygonKind::triangle, int threads = 1,
                                      double share = 1);

/// Unit normal of a triangle, by its winding; zero when it has no area.
Vec3 triangle_normal(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace caustics::beamtree
