#pragma once

#include "core/point_estimator.h"

namespace caustics {

/// A built method for light between diffuse surfaces: light paths L (S* D)+ S* D only, with at least one
/// diffuse reflection before the receiver's.
class IndirectEstimator : public PointEstimator {};

}  // namespace caustics
