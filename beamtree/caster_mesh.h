#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh.h"
#include "core/scene.h"

namespace caustics {

/// The specular polygons of one caster with a normal at every vertex. A mesh without normals gets
/// its own three vertices a triangle with the triangle's normal, as every other method sees it.
struct CasterMesh {
    std::uint32_t shape = 0;  ///< index into Scene::shapes
    TriangleMesh mesh;        ///< world frame, with normals
    /// Triangles that make no beam: without area, or at the place of an earlier one.
    std::vector<bool> left_out;
    std::uint64_t degenerate = 0;
    std::uint64_t duplicated = 0;
    bool flat = false;         ///< the mesh had no normals
    bool tessellated = false;  ///< of an exact shape, by `mesh_resolution`
};

/// Exact casters are tessellated with `resolution`; meshes are taken as they are.
std::vector<CasterMesh> caster_meshes(const Scene& scene, int resolution);

/// Unit normal of a triangle, by its winding; zero when it has no area.
Vec3 triangle_normal(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace caustics
