#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/interrupt.h"
#include "core/base/isa.h"
#include "core/material/bsdf.h"
#include "core/scene/scene.h"

namespace caustics {

/// A point of a receiver as a viewer sees it. Normals are on the viewer's side.
struct ReceiverPoint {
    Vec3 position = Vec3::Zero();
    Vec3 geometric_normal = Vec3::Zero();  ///< unit
    Vec3 shading_normal = Vec3::Zero();    ///< unit
    Vec3 wo = Vec3::Zero();                ///< unit, away from the surface towards the viewer
    Vec2 uv = Vec2::Zero();
    float offset = 0;            ///< as SurfacePoint::offset
    const Bsdf* bsdf = nullptr;  ///< of the receiver; not read by irradiance()
    std::uint32_t shape = 0;     ///< index into Scene::shapes
    bool front = true;           ///< whether the viewer is on the front side of the surface
    float nm = 0;                ///< wavelength that glass before the viewer has chosen; 0: none
    std::uint64_t id = 0;        ///< names the point's random numbers
    float radius = 0;            ///< of the disc that `lighttrace` gathers over [m]
};

/// The receiver point at a surface point, seen along `wo`; its normals are turned to that side.
/// Empty where the surface is no receiver or black on that side.
std::optional<ReceiverPoint> receiver_point(const Scene& scene, const SurfacePoint& point,
                                            const Vec3& wo);

/// A value with its standard error (0 where the method has none to tell).
struct Estimate {
    Spectrum value = black();
    Spectrum standard_error = black();
};

/// Counts by name, summed over threads in any order (they are whole numbers).
using Counters = std::map<std::string, std::uint64_t>;

/// A thread's scratch and counters. Made by the estimator; never shared between threads.
class QueryContext {
public:
    virtual ~QueryContext() = default;
    virtual void add_to(Counters&) const {}
};

/// What stops light on its straight way from a light to a receiver.
enum class Shadows {
    opaque,      ///< every surface
    transparent  ///< all but dielectrics, which weaken it: ray tracing without caustics [C11], [CC95]
};

/// What a built method holds.
struct BuildReport {
    std::uint64_t bytes = 0;  ///< of the built data
    Counters counters;
    /// Parameters the method chose by itself, by name (a maximum radius, say).
    std::map<std::string, double> resolved;
};

/// The caustic layer of the camera's picture, for methods that connect light paths to the camera
/// instead of answering at points. Row by row from the top.
struct CameraLayer {
    std::vector<Spectrum> radiance;
    std::vector<Spectrum> standard_error;
    Counters counters;
};

/// How a build and a render are run. Both callbacks may be empty and are called from any thread;
/// `progress` gets the done share of the current phase and may throw.
struct RunOptions {
    std::uint64_t seed = 1;
    int threads = 1;
    int samples_per_pixel = 1;  ///< of the eye pass; 1 in `probe`
    bool adaptive = true;       ///< whether an adaptive sampler may take more (references: no)
    Isa isa = widest_isa();     ///< of the methods' hot loops
    std::string origin;         ///< the command that asks, for files that a method writes
    std::function<void(std::string_view)> begin_phase;
    std::function<void(double)> progress;

    void phase(std::string_view name) const {
        if (begin_phase) begin_phase(name);
    }
    void report(double share) const {
        throw_if_interrupted();
        if (progress) progress(share);
    }
};

/// A built caustic method: radiance from light paths L S+ D only. Immutable: constructing it *is*
/// the precompute pass, so no half-built state exists. Thread-safe; depends on nothing but the
/// arguments and the built data.
class CausticEstimator {
public:
    virtual ~CausticEstimator() = default;

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
    /// The caustic layer of the scene's camera, or empty for a method that answers at points.
    virtual std::optional<CameraLayer> camera_layer(const RunOptions&) const { return {}; }
    /// Whether its values are unbiased samples, so that their scatter tells a standard error.
    virtual bool is_statistical() const { return false; }
    virtual BuildReport build_report() const { return {}; }
    /// Of the direct light in its pictures.
    virtual Shadows shadows() const { return Shadows::opaque; }
};

/// `none`: no caustic.
struct NoneParams {
    Shadows shadows = Shadows::opaque;
};
std::unique_ptr<const CausticEstimator> build(const Scene&, const NoneParams&, const RunOptions&);

}  // namespace caustics
