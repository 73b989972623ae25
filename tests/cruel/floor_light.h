#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "experiments/run/method.h"
#include "tests/support/light_flux.h"

namespace caustics::cruel {

/// A sum with the variance of what was drawn.
struct Measured {
    double value = 0;
    double variance = 0;
};

/// The caustic's mean irradiance [W/m^2], channel by channel, on the front of the rectangle `floor`: in 3 x 3
/// squares of it, and in all.
struct FloorLight {
    static constexpr int squares = 9;
    using Cells = std::array<std::array<Measured, 3>, squares + 1>;
    Cells in_squares;
    Cells in_discs;  ///< that the squares hold, as wide as they are
    /// The flux that particles bring to casters, over the floor's area [W/m^2].
    std::array<double, 3> on_casters{};
    double share_lost = 0;  ///< of that, between casters, as the method itself reports
};

/// The floor of a scene and how it is asked.
class FloorAsked {
public:
    FloorAsked(const Scene& scene, std::uint64_t seed);

    /// Particles that lie where they fall; `emit` draws them.
    FloorLight by_particles(const support::Emit& emit, std::uint64_t paths, int max_bounces) const;
    /// A method's irradiance at n x n points of each square, n even: at random in their cells, or in the middle.
    FloorLight at_points(const experiments::Method& method, int n, bool jittered = true) const;
    /// A method's irradiance at the discs' middles.
    FloorLight over_discs(const experiments::Method& method, int seeds) const;
    double disc_radius() const { return radius_; }

private:
    ReceiverPoint point(double x, double y, std::uint64_t id) const;

    const Scene& scene_;
    std::uint32_t floor_ = 0;
    double radius_ = 0;
    std::uint64_t seed_;
};

}  // namespace caustics::cruel
