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
                     const CopiedPhotons& to) {
        found.count = collect(photons, query, found.squared_distance, to);
        if (found.count <= query.nearest) return true;
        const auto smaller = Selection<Lanes>::bound_for(found.squared_distance, found.count,
                                                         found.count, query.nearest, query.nearest,
                                                         0, query.max_squared_distance);
        if (smaller.not_above > query.nearest) {
            find_places(photons, query, smaller.value, found);
            return false;
        }
        keep(smaller.value, found, to);
        return true;
    }

private:
    using Floats = typename Lanes::Floats;

    /// Squared distances of photons from the query's point, a register at a time.
    class Distances {
    public:
        Distances(const PhotonColumns& photons, const NearestQuery& query)
            : x_(photons.position[0]),
              y_(photons.position[1]),
              z_(photons.position[2]),
              px_(Lanes::all(query.point[0])),
              py_(Lanes::all(query.point[1])),
              pz_(Lanes::all(query.point[2])) {}

        Floats at(size_t i) const {
            const Floats dx = Lanes::sub(Lanes::load(x_ + i), px_);
            const Floats dy = Lanes::sub(Lanes::load(y_ + i), py_);
            const Floats dz = Lanes::sub(Lanes::load(z_ + i), pz_);
            return Lanes::add(Lanes::add(Lanes::mul(dx, dx), Lanes::mul(dy, dy)),
                              Lanes::mul(dz, dz));
        }

    private:
        const float *x_, *y_, *z_;
        Floats px_, py_, pz_;
    };

    /// Puts the photons within the query's reach side by side; returns their number.
    static size_t collect(const PhotonColumns& photons, const NearestQuery& query,
                          float* squared_distance, const CopiedPhotons& to) {
        const Distances distances(photons, query);
        const auto limit = Lanes::all(query.max_squared_distance);
        const size_t count = photons.count;
        size_t kept = 0;
        for (size_t i = 0; i < count; i += Lanes::width) {
            const Floats d2 = distances.at(i);
            const uint32_t mask =
                Lanes::not_above(d2, limit) & Selection<Lanes>::real_lanes(count - i);
            // Photons lie bucket by bucket, so that whole registers are out of reach.
            if (mask == 0) continue;
            Lanes::compress(squared_distance + kept, mask, d2);
            Lanes::compress(to.energy + kept, mask, Lanes::load(photons.energy + i));
            Lanes::compress_halves(to.direction + kept, mask, Lanes::load(photons.direction + i));
            compress_positions(photons.position, i, mask, to, kept);
            kept += Lanes::count(mask);
        }
        return kept;
    }

    /// Of photons side by side, keeps those not above the bound, in their order.
    static void keep(float bound, Candidates& found, const CopiedPhotons& to) {
        const auto limit = Lanes::all(bound);
        size_t kept = 0;
        for (size_t i = 0; i < found.count; i += Lanes::width) {
            const Floats d2 = Lanes::load(found.squared_distance + i);
            const auto energies = Lanes::load(to.energy + i);
            const auto directions = Lanes::load_halves(to.direction + i);
            const uint32_t mask =
                Lanes::not_above(d2, limit) & Selection<Lanes>::real_lanes(found.count - i);
            Lanes::compress(found.squared_distance + kept, mask, d2);
            Lanes::compress(to.energy + kept, mask, energies);
            Lanes::compress_halves(to.direction + kept, mask, directions);
            compress_positions(to.position, i, mask, to, kept);
            kept += Lanes::count(mask);
        }
        found.count = kept;
    }

    /// The masked positions of register i, where they are wanted.
    static void compress_positions(float* const* from, size_t i, uint32_t mask,
                                   const CopiedPhotons& to, size_t kept) {
        if (to.position[0] == nullptr) return;
        for (unsigned axis = 0; axis < 3; ++axis)
            Lanes::compress(to.position[axis] + kept, mask, Lanes::load(from[axis] + i));
    }

    /// The columns' photons not above the bound, by their places.
    static void find_places(const PhotonColumns& photons, const NearestQuery& query, float bound,
                            Candidates& found) {
        const Distances distances(photons, query);
        const auto limit = Lanes::all(bound);
        size_t kept = 0;
        for (size_t i = 0; i < photons.count; i += Lanes::width) {
            const Floats d2 = distances.at(i);
            const uint32_t mask =
                Lanes::not_above(d2, limit) & Selection<Lanes>::real_lanes(photons.count - i);
            Lanes::compress(found.squared_distance + kept, mask, d2);
            Lanes::compress(found.index + kept, mask,
                            Lanes::counting_from(static_cast<uint32_t>(i)));
            kept += Lanes::count(mask);
        }
        found.count = kept;
    }
};

}  // namespace caustics
