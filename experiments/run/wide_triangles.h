#pragma once

#include <optional>
#include <string>

#include "core/scene/scene.h"

namespace caustics::experiments {

/// A mesh of a dielectric that a light sees mostly in wide triangles. Beams end on each with one polygon, or a
/// few: behind the mesh's next surface light within one is taken to be bent as its corners are.
struct WideTriangles {
    std::string shape;
    double angle =
        0;  ///< between corners of a triangle as the light sees them, mean by solid angle [rad]
};

/// Which triangles count.
enum class Triangles { all, of_changing_normals };

/// The widest of a scene's, where the mean is above `least` [rad]; lights from afar see none.
std::optional<WideTriangles> wide_triangles(const Scene& scene, Triangles which, double least);

}  // namespace caustics::experiments
