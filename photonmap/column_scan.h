#pragma once

#include "photonmap/candidate_loops.h"

namespace caustics {

/// The query of a group's member among the photons that were copied out for the group.
template <typename Lanes>
struct ColumnScan {
    static void copy(const PackedView& tree, const Candidates& found, PhotonColumns& photons) {
        for (size_t i = 0; i < found.count; ++i) {
            const size_t number = found.index[i] / bucket_photons;
            const size_t lane = found.index[i] % bucket_photons;
            const unsigned char* const bucket = number + 1 == tree.bucket_count
                                                    ? tree.last_bucket
                                                    : tree.buckets + number * bucket_bytes;
            for (unsigned axis = 0; axis < 3; ++axis)
                memcpy(photons.position[axis] + i, bucket + 4 * (axis * bucket_photons + lane), 4);
            memcpy(photons.energy + i, bucket + 12 * bucket_photons + 4 * lane, 4);
            uint16_t direction;
            memcpy(&direction, bucket + 16 * bucket_photons + 2 * lane, sizeof direction);
            photons.direction[i] = direction;
        }
        photons.count = found.count;
    }

    static bool find(const PhotonColumns& photons, const NearestQuery& query, Candidates& found,
                     uint32_t* energy, uint16_t* direction) {
        const size_t within = measure(photons, query, found.squared_distance);
        float bound = query.max_squared_distance;
        size_t kept = within;
        if (within > query.nearest) {
            const auto smaller =
                Selection<Lanes>::bound_for(found.squared_distance, photons.count, within,
                                            query.nearest, query.nearest, 0, bound);
            bound = smaller.value;
            kept = smaller.not_above;
        }
        found.count = kept;
        if (kept > query.nearest) {
            keep_places(photons.count, bound, found);
            return false;
        }
        keep(photons, bound, found.squared_distance, energy, direction);
        return true;
    }

private:
    /// All squared distances; returns how many are within the query's reach.
    static size_t measure(const PhotonColumns& photons, const NearestQuery& query,
                          float* squared_distance) {
        const auto limit = Lanes::all(query.max_squared_distance);
        const auto px = Lanes::all(query.point[0]);
        const auto py = Lanes::all(query.point[1]);
        const auto pz = Lanes::all(query.point[2]);
        const float* const x = photons.position[0];
        const float* const y = photons.position[1];
        const float* const z = photons.position[2];
        const size_t count = photons.count;
        size_t within = 0;
        for (size_t i = 0; i < count; i += Lanes::width) {
            const auto dx = Lanes::sub(Lanes::load(x + i), px);
            const auto dy = Lanes::sub(Lanes::load(y + i), py);
            const auto dz = Lanes::sub(Lanes::load(z + i), pz);
            const auto d2 =
                Lanes::add(Lanes::add(Lanes::mul(dx, dx), Lanes::mul(dy, dy)), Lanes::mul(dz, dz));
            Lanes::store(squared_distance + i, d2);
            within +=
                Lanes::count(Lanes::not_above(d2, limit) & Selection<Lanes>::real_lanes(count - i));
        }
        return within;
    }

    /// Puts those not above the bound side by side, the distances in their own place.
    static void keep(const PhotonColumns& photons, float bound, float* squared_distance,
                     uint32_t* energy, uint16_t* direction) {
        const auto limit = Lanes::all(bound);
        const uint32_t* const energies = photons.energy;
        const uint32_t* const directions = photons.direction;
        const size_t count = photons.count;
        size_t kept = 0;
        for (size_t i = 0; i < count; i += Lanes::width) {
            const auto d2 = Lanes::load(squared_distance + i);
            const uint32_t mask =
                Lanes::not_above(d2, limit) & Selection<Lanes>::real_lanes(count - i);
            Lanes::compress(squared_distance + kept, mask, d2);
            Lanes::compress(energy + kept, mask, Lanes::load(energies + i));
            Lanes::compress_halves(direction + kept, mask, Lanes::load(directions + i));
            kept += Lanes::count(mask);
        }
    }

    static void keep_places(size_t count, float bound, Candidates& found) {
        const auto limit = Lanes::all(bound);
        size_t kept = 0;
        for (size_t i = 0; i < count; i += Lanes::width) {
            const auto d2 = Lanes::load(found.squared_distance + i);
            const uint32_t mask =
                Lanes::not_above(d2, limit) & Selection<Lanes>::real_lanes(count - i);
            Lanes::compress(found.squared_distance + kept, mask, d2);
            Lanes::compress(found.index + kept, mask,
                            Lanes::counting_from(static_cast<uint32_t>(i)));
            kept += Lanes::count(mask);
        }
    }
};

}  // namespace caustics
