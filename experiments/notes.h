#pragma once

#include <string>
#include <vector>

#include "experiments/methods.h"

namespace caustics {

/// What a user should know of a picture that could be made, one line each and mostly none: a caster
/// so far from the others that floats are too coarse for it, how much light beams lose between
/// specular surfaces (from 1 % on), and parameters that were set and make no difference in this scene.
std::vector<std::string> notes(const Scene& scene, const Method& method, const BuildReport& report);

}  // namespace caustics
