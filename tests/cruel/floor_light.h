#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "core/light_path/aimed_emission.h"
#include "core/scene/scene.h"
#include "experiments/run/method.h"

namespace caustics::cruel {

/// A mean with the variance of its error.
struct Measured {
    double value = 0;
    double variance = 0;
};

/// The caustic's mean irradiance [W/m^2], channel by channel, on the front of the rectangle `floor`: in 3 x 3
/// squares of it, and in all of it as the last cell.
struct FloorCells {
    static constexpr int side = 3;
    static constexpr std::size_t squares = std::size_t{side} * side;
    static constexpr std::size_t all = squares;
    std::array<std::array<Measured, 3>, squares + 1> cells{};

    Measured& at(std::size_t cell, std::size_t channel) { return cells[cell][channel]; }
    const Measured& at(std::size_t cell, std::size_t channel) const { return cells[cell][channel]; }
    /// The channel with the most light in all.
    std::size_t brightest() const;
    /// Standard error over value, in all, of the brightest channel; 1 without light.
    double relative_error() const;
};

/// The light that particles bring, with the share of it on each part of a fine grid over the floor.
struct ParticleLight {
    static constexpr int parts = 16 * FloorCells::side;  ///< Parts of the grid along a side.
    FloorCells light;
    std::vector<double> share = std::vector<double>(std::size_t{parts} * parts, 0.0);
    /// Flux that particles bring to casters, over the floor's area [W/m^2].
    double on_casters = 0;
};

/// A method's light beside the particles' in the same cells.
struct Comparison {
    FloorCells light;
    FloorCells truth;
    FloorCells
        difference;  ///< light - truth; its variance is less than their sum where both have the same paths
    double faint =
        0;  ///< Light that so few particles bring that differences are judged as shares of this.
    double share_lost = 0;  ///< Share of the light on casters that the method reports as lost.
};

/// The floor of a scene and how it is asked.
class FloorAsked {
public:
    FloorAsked(const Scene& scene, std::uint64_t seed, int max_bounces);

    /// Stratified particles that follow every branch. Their number grows until the standard error is at most
    /// `wanted`, as a share of the light, or the number is `most`.
    ParticleLight by_particles(double wanted, std::uint64_t most) const;
    /// A method's irradiance at stratified random points, more of them where particles bring light. Their number
    /// grows until the standard error is at most `wanted`, or the number is `most`.
    Comparison at_points(const experiments::Method& method, const ParticleLight& particles,
                         double wanted, std::size_t most) const;
    /// A method that averages over squares as wide as the grid's parts, which cover the floor.
    Comparison over_squares(const experiments::Method& method,
                            const ParticleLight& particles) const;
    double square() const { return 2 * half_ / ParticleLight::parts; }

    /// A method that counts photons beside the particles of the very same random numbers: over discs inside the
    /// squares, or over the texels of a map with `texels` along a side, which is read at their centres.
    Comparison over_discs(const experiments::Method& method, Stage stage,
                          std::uint64_t paths) const;
    Comparison over_texels(const experiments::Method& method, int texels,
                           std::uint64_t paths) const;
    double disc_radius() const;

    static constexpr int seeds = 8;  ///< Runs of the two above.

private:
    struct PointSet;
    using InCell = std::function<bool(const Vec3d& local, std::size_t cell)>;
    using Ask = std::function<FloorCells(const RunOptions& options)>;

    ReceiverPoint point(double x, double y, std::uint64_t id) const;
    PointSet points_for(const ParticleLight& particles, double count, std::uint64_t seed) const;
    FloorCells asked(const PointEstimator& built, const PointSet& set) const;
    FloorCells same_particles(std::uint64_t seed, Stage stage, std::uint64_t paths, double area,
                              const InCell& counts) const;
    ParticleLight stratified(std::uint64_t strata) const;
    std::vector<Spectrum> answers_at_grid(const experiments::Method& method, int across,
                                          const RunOptions& options) const;

    const Scene& scene_;
    AimedEmission emission_;
    std::uint32_t floor_ = 0;
    Transform to_local_;
    double half_ = 0;
    std::uint64_t seed_;
    int max_bounces_;
};

}  // namespace caustics::cruel
