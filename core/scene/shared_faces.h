#pragma once

#include <cstdint>
#include <vector>

#include "core/scene/scene.h"

namespace caustics {

/// A caster with a face that lies on a face of another shape: indices into Scene::shapes.
struct SharedFace {
    std::uint32_t caster;
    std::uint32_t other;
};

/// Where shapes lie on each other: a glass slab on a floor, glass on glass, a lamp on water. A ray that leaves one
/// of the two steps over the other, so that light there goes astray. Each pair of casters is told once.
///
/// Found at the middles of the casters' triangles, some thousands a caster, so that edges and rings that shapes share
/// do not count; of balls, cylinders, heightfields and meshes of more than 200,000 triangles only as the other shape, of such
/// meshes not even so.
std::vector<SharedFace> shared_faces(const Scene& scene);

}  // namespace caustics
