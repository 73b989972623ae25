#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/scene/scene.h"

namespace caustics {

/// So many pairs, or a few more, are enough to be told: thousands of shapes may all cross each other.
constexpr std::size_t most_crossing_pairs = 100;

/// Pairs of dielectric shapes (indices into Scene::shapes, the lower first) whose surfaces cross: of a
/// place inside both the medium is not defined, so the light there means nothing. Shapes
/// inside one another (a bubble in glass) and shapes that touch (water in a glass) do not cross.
///
/// Found along the edges of the shapes' meshes, some thousands a shape; so a crossing smaller than a
/// polygon may be missed, and one by less than 3 % of an edge (coarse water in a glass) does not count.
/// Two surfaces that meet at less than 10 degrees are taken to touch.
std::vector<std::pair<std::uint32_t, std::uint32_t>> crossing_dielectrics(const Scene& scene);

}  // namespace caustics
