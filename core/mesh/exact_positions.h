#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "core/mesh/mesh.h"

namespace caustics {

/// Positions in double precision, which a mesh keeps from its file until it is placed (transform(), mesh.h).

/// Rounds the positions to floats. The mesh keeps the doubles where floats are too coarse: where it lies farther from
/// its origin than twice its size, or where rounding turns its triangles.
void set_positions(TriangleMesh& mesh, std::vector<Vec3d> exact);

/// Position of a vertex in the precision that the mesh has.
inline Vec3d exact_position(const TriangleMesh& mesh, std::size_t vertex) {
    return mesh.exact_positions.empty() ? mesh.positions[vertex].cast<double>()
                                        : mesh.exact_positions[vertex];
}

Eigen::AlignedBox3d exact_bounds(const TriangleMesh& mesh);

/// Angle by which rounding from `exact` to the mesh's positions turns triangles: root mean square over their area
/// [rad]. A triangle that rounding leaves without area counts as turned by a right angle.
double rounding_turn(const std::vector<Vec3d>& exact, const TriangleMesh& mesh);

/// Calls `work(mesh)` while `positions` are relative to the mesh's middle, if the mesh keeps doubles: what depends on
/// distances between vertices alone is then as exact as near the origin.
template <class Work>
void in_own_frame(TriangleMesh& mesh, const Work& work) {
    if (mesh.exact_positions.empty()) return work(mesh);
    const Vec3d middle = exact_bounds(mesh).center();
    std::vector<Vec3> rounded = std::move(mesh.positions);
    mesh.positions.clear();
    mesh.positions.reserve(rounded.size());
    for (const Vec3d& p : mesh.exact_positions)
        mesh.positions.emplace_back(Vec3d(p - middle).cast<float>());
    work(mesh);
    mesh.positions = std::move(rounded);
}

}  // namespace caustics
