#pragma once

#include <algorithm>

#include "core/base/interrupt.h"
#include "core/point_estimator.h"

namespace caustics {

/// Of `spp` paths a pixel, at each of its camera samples; at least one.
inline int paths_per_point(int spp, const RunOptions& options) {
    return std::max(1, (spp + options.samples_per_pixel - 1) / options.samples_per_pixel);
}

/// The mean of so many independent samples, with its standard error from two on. `sample()` gives one.
template <typename Sample>
Estimate mean_of(int count, const Sample& sample) {
    SpectrumSum sum = SpectrumSum::Zero();
    SpectrumSum squares = SpectrumSum::Zero();
    for (int i = 0; i < count; ++i) {
        throw_if_interrupted();
        const SpectrumSum value = Spectrum(sample()).template cast<double>();
        sum += value;
        squares += value * value;
    }
    const double n = count;
    Estimate result{(sum / n).cast<float>(), black()};
    if (count > 1)
        result.standard_error =
            ((squares / n - (sum / n).square()).max(0) / (n - 1)).sqrt().cast<float>();
    return result;
}

}  // namespace caustics
