#pragma once

#include <array>
#include <cstddef>

#include "core/math/frame.h"
#include "photonmap/tree/gathered_photons.h"

namespace caustics::photonmap {

/// Directions from a point of a surface: half by the cosine, half as the flux of the photons near it comes
/// [Jensen 1995, "Importance driven path tracing using the photon map"]: over 4 rings and 12 sectors of the
/// unit disc below the hemisphere, which all have the same integral of the cosine.
class DirectionHistogram {
public:
    /// About a unit normal, by those of the photons that come from its side; without any, by the cosine.
    DirectionHistogram(const Vec3& normal, const GatheredPhotons& photons);

    struct Sample {
        Vec3 direction;    ///< unit
        float weight = 0;  ///< cosine / (pi density): 1 where the cosine alone counts
    };
    /// By two numbers of [0, 1).
    Sample sample(double u0, double u1) const;

private:
    static constexpr std::size_t rings = 4;
    static constexpr std::size_t sectors = 12;
    static constexpr std::size_t cells = rings * sectors;

    Frame frame_;
    std::array<double, cells> cumulative_{};  ///< chances of the cells, ascending to 1
};

}  // namespace caustics::photonmap
