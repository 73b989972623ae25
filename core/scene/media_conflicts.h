#pragma once

#include <cstdint>
#include <vector>

#include "core/scene/scene.h"

namespace caustics {

/// Two dielectrics that say different things of the medium between them: water within glass whose `ext_ior` is left at
/// air's. Light is bent at each as that one says, which no real pair does.
struct MediaConflict {
    std::uint32_t first;  ///< indices into Scene::shapes, the lower first
    std::uint32_t second;
    double first_ior;   ///< of that medium at the d line, as the first says
    double second_ior;  ///< as the second says; equal where they differ in what the medium absorbs
};

/// All pairs, by their indices. Found by rays off the shapes along their normals, some hundreds a shape and less of thousands
/// of shapes. Indices that differ by 1 % (1 and 1.000277 for air) and absorption that changes less than 1 % of the light
/// between the two agree. A pair counts from a tenth of a shape's rays on, so that surfaces which overlap a little at
/// their rims do not.
std::vector<MediaConflict> media_conflicts(const Scene& scene);

}  // namespace caustics
