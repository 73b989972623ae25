#pragma once

#include <cstddef>
#include <vector>

#include "core/mesh/mesh.h"

namespace caustics {

/// Parts and flaws of a mesh. Vertices at one position are one vertex. A triangle without area (two corners at one
/// position) belongs to no part, nor does the second of two triangles with the same corners.
///
/// A part is connected by edges that exactly two of its triangles share. It is closed if no edge of it is open and its
/// triangles enclose a volume. A closed part should face outwards, or inwards if it lies inside an odd number of other
/// closed parts (a cavity). Which side of any other part is its outside cannot be told: most of its area is right.
struct MeshDiagnosis {
    std::size_t parts = 0;
    std::size_t closed_parts = 0;
    std::size_t cavities = 0;         ///< closed parts inside an odd number of others
    std::size_t one_sided_parts = 0;  ///< as a Moebius strip: no winding agrees everywhere
    std::size_t hollow_parts = 0;     ///< closed but for holes; a sheet, as of open water, is none

    std::size_t open_edges = 0;     ///< with one triangle
    std::size_t holes = 0;          ///< rings of open edges
    std::size_t crowded_edges = 0;  ///< with more than two triangles
    std::size_t duplicates = 0;    ///< triangles with the corners of another one, facing either way
    std::size_t without_area = 0;  ///< triangles with two corners at one position

    std::size_t mixed_parts = 0;       ///< whose triangles do not all face one way
    std::size_t turned_triangles = 0;  ///< of mixed parts, those that face the wrong way
    std::size_t inside_out_parts =
        0;  ///< closed, and all their triangles face inwards; no cavities
    std::size_t inside_out_triangles = 0;
    std::size_t outward_cavities = 0;  ///< whose triangles all face outwards

    std::vector<bool> turned;  ///< one a triangle: it faces the wrong way

    /// Parts of which it cannot be told which side is outside.
    std::size_t parts_of_no_outside() const { return parts - closed_parts; }
};

/// Takes a time that grows linearly with the number of triangles. Of more than 100 closed parts only the 100 largest
/// are looked into for cavities, and these no longer than a second.
MeshDiagnosis diagnose(const TriangleMesh& mesh);

/// Turns the triangles that face the wrong way, so that neighbours agree and closed parts face outwards (cavities
/// inwards). Normals of vertices that point against their triangles then are turned, too. Throws InputError for a
/// one-sided part.
void orient(TriangleMesh& mesh);

}  // namespace caustics
