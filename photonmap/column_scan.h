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
            memcpy(photons.direction + i, bucket + 16 * bucket_photons + 2 * lane, 2);
        }
        photons.count = found.count;
    }

    static void find(const PhotonColumns& photons, const NearestQuery& query, Candidates& found) {
        const auto limit = Lanes::all(query.max_squared_distance);
        const auto px = Lanes::all(query.point[0]);
        const auto py = Lanes::all(query.point[1]);
        const auto pz = Lanes::all(query.point[2]);
        size_t count = 0;
        for (size_t i = 0; i < photons.count; i += Lanes::width) {
            const auto dx = Lanes::sub(Lanes::load(photons.position[0] + i), px);
            const auto dy = Lanes::sub(Lanes::load(photons.position[1] + i), py);
            const auto dz = Lanes::sub(Lanes::load(photons.position[2] + i), pz);
            const auto d2 =
                Lanes::add(Lanes::add(Lanes::mul(dx, dx), Lanes::mul(dy, dy)), Lanes::mul(dz, dz));
            const uint32_t mask =
                Lanes::not_above(d2, limit) & Selection<Lanes>::real_lanes(photons.count - i);
            Lanes::compress(found.squared_distance + count, mask, d2);
            Lanes::compress(found.index + count, mask,
                            Lanes::counting_from(static_cast<uint32_t>(i)));
            count += Lanes::count(mask);
        }
        found.count = count;
        if (count <= query.nearest) return;
        CandidateLoops<Lanes>::shrink(found, query.nearest, query.nearest,
                                      query.max_squared_distance);
        if (found.count > query.nearest) query.drop_ties(query.tie_context, found, query.nearest);
    }
};

}  // namespace caustics
