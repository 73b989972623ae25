#pragma once

#include "core/point_estimator.h"

namespace caustics {

/// What stops light on its straight way from a light to a receiver.
enum class Shadows {
    opaque,      ///< every surface
    transparent  ///< all but dielectrics, which weaken it: ray tracing without caustics [C11], [CC95]
};

/// A built caustic method: light paths L S+ D only.
class CausticEstimator : public PointEstimator {
public:
    /// Of the direct light in its pictures.
    virtual Shadows shadows() const { return Shadows::opaque; }
    /// Whether it answers with means over the pixels' cells (ReceiverPoint::cell), where a camera sees its points.
    virtual bool asks_for_cells() const { return false; }
};

}  // namespace caustics
