#pragma once

#include <string.h>

#include "photonmap/kernels/tree_kernels.h"

namespace caustics::photonmap {

/// Tests the discs of a packed tree's buckets, a register at a time.
template <typename Lanes>
struct DiscScan {
    static size_t find(const DiscView& view, const DiscQuery& query, const uint32_t* buckets,
                       size_t bucket_count, const CoveringPhotons& to) {
        const DiscScan scan(query, to);
        size_t count = 0;
        for (size_t i = 0; i < bucket_count; ++i) {
            const size_t bucket = buckets[i];
            count = scan.add(view.tree.buckets + bucket * bucket_bytes,
                             view.radius + bucket * bucket_photons, count);
        }
        return count;
    }

private:
    using Floats = typename Lanes::Floats;

    DiscScan(const DiscQuery& query, const CoveringPhotons& to)
        : to_(to),
          px_(Lanes::all(query.point[0])),
          py_(Lanes::all(query.point[1])),
          pz_(Lanes::all(query.point[2])),
          widening_(Lanes::all(query.widening)),
          margin_(Lanes::all(query.margin)) {}

    size_t add(const unsigned char* bucket, const float* radius, size_t count) const {
        const auto* const x = reinterpret_cast<const float*>(bucket);
        const float* const y = x + bucket_photons;
        const float* const z = y + bucket_photons;
        const auto* const energy = reinterpret_cast<const uint32_t*>(z + bucket_photons);
        const auto* const direction = reinterpret_cast<const uint16_t*>(energy + bucket_photons);
        const uint16_t* const flags = direction + bucket_photons;
        // By value: no photon that is stored could change the addresses.
        const CoveringPhotons to = to_;
        for (size_t i = 0; i < bucket_photons; i += Lanes::width) {
            const Floats ax = Lanes::load(x + i), ay = Lanes::load(y + i), az = Lanes::load(z + i);
            const Floats dx = Lanes::sub(ax, px_), dy = Lanes::sub(ay, py_);
            const Floats dz = Lanes::sub(az, pz_);
            const Floats d2 =
                Lanes::add(Lanes::add(Lanes::mul(dx, dx), Lanes::mul(dy, dy)), Lanes::mul(dz, dz));
            const Floats r = Lanes::load(radius + i);
            const Floats reach = Lanes::add(Lanes::mul(widening_, r), margin_);
            const uint32_t mask = Lanes::less(d2, Lanes::mul(reach, reach));
            if (mask == 0) continue;
            Lanes::compress(to.squared_distance + count, mask, d2);
            Lanes::compress(to.radius + count, mask, r);
            Lanes::compress(to.copies.energy + count, mask, Lanes::load(energy + i));
            Lanes::compress_halves(to.copies.direction + count, mask,
                                   Lanes::load_halves(direction + i));
            if (to.copies.flags != nullptr)
                Lanes::compress_halves(to.copies.flags + count, mask,
                                       Lanes::load_halves(flags + i));
            Lanes::compress(to.copies.position[0] + count, mask, ax);
            Lanes::compress(to.copies.position[1] + count, mask, ay);
            Lanes::compress(to.copies.position[2] + count, mask, az);
            count += Lanes::count(mask);
        }
        return count;
    }

    CoveringPhotons to_;
    Floats px_, py_, pz_, widening_, margin_;
};

}  // namespace caustics::photonmap
