#pragma once

#include <cstdint>

#include "photonmap/kernels/aligned_array.h"
#include "photonmap/kernels/tree_kernels.h"
#include "photonmap/tree/gathered_photons.h"

namespace caustics::photonmap {

/// Some of a query's photons, with their memory.
class RadiusFilter {
public:
    /// The photons not beyond the radius, without positions, good until the next call; they may be
    /// kept ones themselves.
    GatheredPhotons within(const GatheredPhotons& gathered, float squared_radius) {
        squared_distance_.reserve(gathered.count + widest_register);
        energy_.reserve(gathered.count + widest_register);
        direction_.reserve(gathered.count + widest_register);
        GatheredPhotons kept{squared_distance_.data(), energy_.data(), direction_.data(), 0, 0};
        float farthest = -1;
        for (std::size_t i = 0; i < gathered.count; ++i) {
            const float distance2 = gathered.squared_distance[i];
            squared_distance_[kept.count] = distance2;
            energy_[kept.count] = gathered.energy[i];
            direction_[kept.count] = gathered.direction[i];
            if (distance2 > squared_radius) continue;
            if (distance2 > farthest) {
                farthest = distance2;
                kept.farthest = kept.count;
            }
            ++kept.count;
        }
        return kept;
    }

private:
    AlignedArray<float> squared_distance_;
    AlignedArray<std::uint32_t> energy_;
    AlignedArray<std::uint16_t> direction_;
};

}  // namespace caustics::photonmap
