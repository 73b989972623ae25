#pragma once

#include "core/known_shadows.h"
#include "core/point_estimator.h"

namespace caustics {

/// A built method for light between diffuse surfaces: light paths L (S* D)+ S* D only, with at least one
/// diffuse reflection before the receiver's.
class IndirectEstimator : public PointEstimator {
public:
    /// For the direct light of its pictures, with opaque shadows; null where it knows nothing of them.
    virtual const KnownShadows* known_shadows() const { return nullptr; }
};

}  // namespace caustics
