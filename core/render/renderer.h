#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/caustic_estimator.h"
#include "core/indirect_estimator.h"
#include "core/render/film.h"
#include "core/scene/scene.h"

namespace caustics {

/// What a render counted.
struct RenderReport {
    /// Of the method's queries and of the eye pass: camera_rays, the receiver_points that they
    /// found and, of a method that answers at points, those that it did not leave black (lit_points).
    Counters counters;
    std::optional<LightLedger> light = {};  ///< of a method that connects light paths to the camera
};

struct Rendering {
    Film film;
    RenderReport report;
    /// Standard error of each pixel's caustic, mean of channels, by the scatter of its samples; empty where pixels have one
    /// sample, the method has several passes, or it connects light paths to the camera.
    std::vector<float> caustic_error = {};
};

/// A method that goes through its precompute pass several times, each time with other random
/// numbers.
struct Passes {
    int count = 1;
    /// Builds pass 0, 1, ..., count - 1, when the one before is gone.
    std::function<std::unique_ptr<const CausticEstimator>(int pass)> build;
    /// One of so many pixels is rendered, of those that lie scattered; the others stay black. For trials of time, without
    /// adaptive sampling.
    int pixel_step = 1;
};

/// The eye pass, the same code and the same camera samples for every method: direct light, the
/// specular chains S* E with Fresnel, Beer's law and n^2 scaling, and at each receiver point the
/// method's caustic radiance, and, where a method for it is given, the indirect one (its counters have
/// names that begin with indirect_). Layers as film.h. Adaptive sampling, where the scene's sampler asks
/// for it, takes its first samples everywhere and more where they scatter. Bit-identical for any
/// number of threads.
Rendering render(const Scene& scene, const CausticEstimator& estimator, const RunOptions& options,
                 const IndirectEstimator* indirect = nullptr);

/// The same with the caustic of a method's passes: their mean, at the same camera samples. Only one
/// pass is in memory at a time. Throws InputError for several passes where sampling is adaptive.
Rendering render(const Scene& scene, const Passes& passes, const RunOptions& options,
                 const IndirectEstimator* indirect = nullptr);

}  // namespace caustics
