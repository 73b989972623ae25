#pragma once

#include <optional>
#include <vector>

#include "core/geometry/lathe.h"
#include "core/geometry/polytope.h"
#include "core/mesh/mesh.h"

namespace caustics {

/// Facets round the axis z, as a cutter's index wheel sets them.
struct CutRing {
    int count = 1;
    double angle = 0;     ///< elevation of the facets' normals over z = 0 [degrees, -90 .. 90]
    double distance = 0;  ///< of the facets' planes from the origin [m]
    double phase = 0;     ///< facet j looks to the angle 2 pi (j + phase) / count from +x
};
/// The facets' half-spaces.
std::vector<HalfSpace> half_spaces(const CutRing& ring);

/// What is common to half-spaces: gems and cut bowls. Positive volume, bounded.
struct CutSolid {
    static constexpr std::size_t most_planes = 200;

    std::vector<HalfSpace> planes;
    std::optional<double> height;  ///< cuts at z = height from above
    /// Of a bowl: a profile from the rim, which lies at z = height, to the axis, or the other way.
    std::optional<LatheProfile> inner;
    int inner_sectors = 64;
};

/// A closed mesh: facets with normals and vertices of their own, fanned; with `inner` a flat rim and
/// the smooth surface inside, which shares its positions with the rim bit for bit. uv: of a facet
/// its bounding square, inside as a lathe's. Throws InputError for planes that enclose nothing or
/// have no bounds, or an `inner` that does not fit into them.
TriangleMesh tessellate_cut(const CutSolid& solid);

}  // namespace caustics
