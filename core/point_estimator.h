#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/counters.h"
#include "core/receiver_point.h"
#include "core/run_options.h"
#include "core/scene/scene.h"

namespace caustics {

/// A value with its standard error (0 where the method has none).
struct Estimate {
    Spectrum value = black();
    Spectrum standard_error = black();
};

/// Light that arrives at a receiver point along one ray.
struct ArrivingLight {
    ReceiverPoint point;
    Vec3 direction = Vec3::Zero();  ///< unit, the way the light goes
    double watts = 0;
};

/// How a method counts the light of one ray at the point where it arrives.
enum class RayCount : std::uint8_t {
    missed,  ///< not at all
    spread,  ///< as a part of light that is spread over places nearby
    exact    ///< as that ray
};

/// A thread's scratch and counters. Made by the estimator; never shared between threads.
class QueryContext {
public:
    virtual ~QueryContext() = default;
    virtual void add_to(Counters&) const {}
};

/// A layer of the camera's picture, for methods that connect light paths to the camera
/// instead of answering at points. Row by row from the top.
struct CameraLayer {
    std::vector<Spectrum> radiance;
    std::vector<Spectrum> standard_error;
    Counters counters;
    std::optional<LightLedger> light = {};  ///< of caustics
};

/// A built method: the light of one set of paths at receiver points. Immutable: constructing it *is*
/// the precompute pass, so no half-built state exists. Thread-safe; depends on nothing but the
/// arguments and the built data.
class PointEstimator {
public:
    virtual ~PointEstimator() = default;

    virtual std::unique_ptr<QueryContext> make_context() const {
        return std::make_unique<QueryContext>();
    }
    /// Radiance [W m^-2 sr^-1] leaving each receiver point along its `wo`. The points of a batch
    /// are near each other, so that a method can share work.
    virtual void radiance(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                          QueryContext& context) const = 0;
    /// Irradiance [W m^-2] at the points, on the side of their geometric normals.
    virtual void irradiance(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                            QueryContext& context) const = 0;
    /// How irradiance() counts each ray of light at its point. Empty for methods that do not search for rays.
    virtual std::optional<std::vector<RayCount>> count_rays(std::span<const ArrivingLight>,
                                                            QueryContext&) const {
        return {};
    }
    /// The layer of the scene's camera, or empty for a method that answers at points.
    virtual std::optional<CameraLayer> camera_layer(const RunOptions&) const { return {}; }
    /// Whether its values are unbiased samples, so that their scatter gives a standard error.
    virtual bool is_statistical() const { return false; }
    virtual BuildReport build_report() const { return {}; }
};

}  // namespace caustics
