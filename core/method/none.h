#pragma once

#include "core/caustic_estimator.h"
#include "core/method/described_method.h"

namespace caustics {

/// `none`: no caustic.
struct NoneParams {
    Shadows shadows = Shadows::opaque;
};
std::unique_ptr<const CausticEstimator> build(const Scene&, const NoneParams&, const RunOptions&);

const DescribedMethod<NoneParams>& none_method();

}  // namespace caustics
