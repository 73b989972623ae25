#pragma once

#include <stddef.h>
#include <stdint.h>

namespace caustics::photonmap {

/// The numbers of photons among which `adaptive` chooses: 5 and on by factors of 1.3.
struct NLadder {
    uint32_t rank[64];
    size_t size;

    /// With so many photons, sums of directions fit into 32 bits.
    static constexpr size_t most_photons = 131'071;

    constexpr NLadder() : rank{}, size{0} {
        for (double count = 5;
             count<most_photons; count = count * 1.3> count + 1 ? count * 1.3 : count + 1)
            rank[size++] = static_cast<uint32_t>(count + 0.5);
    }
};
inline constexpr NLadder count_ladder;

/// Photons round a point of a surface. Arrays as in GatheredPhotons.
struct PhotonsAround {
    const float* position[3];
    const float* squared_distance;
    size_t count;
    float greatest_squared_distance;
    float point[3];
    float tangent[3];
    float bitangent[3];
    uint32_t* direction[4];  ///< scratch, padded to a register
};

/// What the photons' directions say (AdaptiveN).
struct NChoice {
    size_t rungs = 0;      ///< numbers of the ladder that could be tested
    bool stopped = false;  ///< whether some are too many; else all photons are to be taken
    float squared_radius =
        0;            ///< of the disc of the chosen number, the distance of its last photon
    double lean = 0;  ///< length of the mean direction in it, 0 to 1
};

using NChooser = NChoice(const PhotonsAround& photons);

}  // namespace caustics::photonmap
