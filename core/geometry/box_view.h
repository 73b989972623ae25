#pragma once

#include "core/math/vec.h"

namespace caustics {

/// The integral of the cosine over the directions in which a surface sees a box, from a point with a unit normal on
/// its front side: pi times Lambert's form factor [sr]. From inside the box it is taken to be pi.
double cosine_over(const Box& box, const Vec3& position, const Vec3& normal);

}  // namespace caustics
