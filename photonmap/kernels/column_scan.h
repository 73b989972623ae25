#pragma once

#include "photonmap/kernels/candidate_loops.h"

namespace caustics::photonmap {

/// The query of a group's member among the photons that were copied out for the group.
template <typename Lanes>
struct ColumnScan {
    static bool find(const CopiedPhotons& photons, size_t count, const NearestQuery& query,
                     Candidates& found, const CopiedPhotons& to) {
        found.count = collect(photons, count, query, found.squared_distance, to);
        if (found.count <= query.nearest) return true;
        const auto smaller = Selection<Lanes>::bound_for(found.squared_distance, found.count,
                                                         found.count, query.nearest, query.nearest,
                                                         0, query.max_squared_distance);
        if (smaller.not_above > query.nearest) {
            find_places(photons, count, query, smaller.value, found);
            return false;
        }
        found.count = keep(smaller.value, found.squared_distance, found.count, to);
        return true;
    }

    static float nth(const CopiedPhotons& photons, size_t count, const NearestQuery& query,
                     float* squared_distance) {
        const Distances distances(photons, query);
        const auto limit = Lanes::all(query.max_squared_distance);
        size_t kept = 0;
        for (size_t i = 0; i < count; i += Lanes::width) {
            const Floats d2 = distances.at(i);
            const uint32_t mask =
                Lanes::not_above(d2, limit) & Selection<Lanes>::real_lanes(count - i);
            Lanes::compress(squared_distance + kept, mask, d2);
            kept += Lanes::count(mask);
        }
        if (kept < query.nearest) return -1;
        return Selection<Lanes>::kth(squared_distance, kept, query.nearest, 0,
                                     query.max_squared_distance)
            .value;
    }

private:
    using Floats = typename Lanes::Floats;

    /// Squared distances of photons from the query's point, a register at a time.
    class Distances {
    public:
        Distances(const CopiedPhotons& photons, const NearestQuery& query)
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

    /// Puts the photons within the query's reach side by side; returns their number. Like the others,
    /// takes the arrays' addresses by value: what is stored could not change those.
    static size_t collect(const CopiedPhotons photons, size_t count, const NearestQuery& query,
                          float* squared_distance, const CopiedPhotons to) {
        const Distances distances(photons, query);
        const auto limit = Lanes::all(query.max_squared_distance);
        size_t kept = 0;
        for (size_t i = 0; i < count; i += Lanes::width) {
            const Floats d2 = distances.at(i);
            const uint32_t mask =
                Lanes::not_above(d2, limit) & Selection<Lanes>::real_lanes(count - i);
            // Photons lie bucket by bucket, so that whole registers are out of reach.
            if (mask == 0) continue;
            Lanes::compress(squared_distance + kept, mask, d2);
            Lanes::compress(to.energy + kept, mask, Lanes::load(photons.energy + i));
            Lanes::compress_halves(to.direction + kept, mask,
                                   Lanes::load_halves(photons.direction + i));
            compress_positions(photons.position, i, mask, to, kept);
            kept += Lanes::count(mask);
        }
        return kept;
    }

    /// Of photons side by side, keeps those not above the bound, in their order.
    static size_t keep(float bound, float* squared_distance, size_t count, const CopiedPhotons to) {
        const auto limit = Lanes::all(bound);
        size_t kept = 0;
        for (size_t i = 0; i < count; i += Lanes::width) {
            const Floats d2 = Lanes::load(squared_distance + i);
            const auto energies = Lanes::load(to.energy + i);
            const auto directions = Lanes::load_halves(to.direction + i);
            const uint32_t mask =
                Lanes::not_above(d2, limit) & Selection<Lanes>::real_lanes(count - i);
            Lanes::compress(squared_distance + kept, mask, d2);
            Lanes::compress(to.energy + kept, mask, energies);
            Lanes::compress_halves(to.direction + kept, mask, directions);
            compress_positions(to.position, i, mask, to, kept);
            kept += Lanes::count(mask);
        }
        return kept;
    }

    /// The masked positions of register i, where they are wanted.
    static void compress_positions(float* const* from, size_t i, uint32_t mask,
                                   const CopiedPhotons& to, size_t kept) {
        if (to.position[0] == nullptr) return;
        for (unsigned axis = 0; axis < 3; ++axis)
            Lanes::compress(to.position[axis] + kept, mask, Lanes::load(from[axis] + i));
    }

    /// The columns' photons not above the bound, by their places.
    static void find_places(const CopiedPhotons& photons, size_t count, const NearestQuery& query,
                            float bound, Candidates& found) {
        const Distances distances(photons, query);
        const auto limit = Lanes::all(bound);
        size_t kept = 0;
        for (size_t i = 0; i < count; i += Lanes::width) {
            const Floats d2 = distances.at(i);
            const uint32_t mask =
                Lanes::not_above(d2, limit) & Selection<Lanes>::real_lanes(count - i);
            Lanes::compress(found.squared_distance + kept, mask, d2);
            Lanes::compress(found.index + kept, mask,
                            Lanes::counting_from(static_cast<uint32_t>(i)));
            kept += Lanes::count(mask);
        }
        found.count = kept;
    }
};

}  // namespace caustics::photonmap
