#pragma once

#include <map>
#include <utility>

#include "core/geometry/shape.h"

namespace caustics {

/// The cube [-1,1]^3 (those of exact shapes are in core/exact_shapes). Vertices and vertex normals of a mesh lie
/// exactly (to float) on its shape; uv as Mitsuba's.
/// n x n quads a face, flat normals (vertices are not shared between faces).
TriangleMesh tessellate_cube(int n);
/// The mesh of an exact shape in the world frame, facing as the shape does. A sphere takes n >= 2.
TriangleMesh tessellate_shape(const Shape& shape, int n);
/// Brings a mesh from the own frame of an exact shape to the world frame, facing as the shape does.
void place_exact(TriangleMesh& mesh, const Shape& shape);

/// Meshes of shapes in their own frames, made once for all exact shapes of a kind: a scene may hold a million.
class OwnFrameMeshes {
public:
    explicit OwnFrameMeshes(int n) : n_(n) {}

    /// The mesh of an exact shape, which place_exact() brings to the world frame, or that of a mesh, which lies there.
    const TriangleMesh& of(const Shape& shape);

private:
    int n_;
    /// By kind, and by shape where shapes of one kind differ.
    std::map<std::pair<Primitive, const Shape*>, TriangleMesh> made_;
};

}  // namespace caustics
