#pragma once

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "photonmap/tree/arrival_directions.h"
#include "photonmap/tree/neighbour_bound.h"
#include "photonmap/tree/photon_tree.h"

namespace caustics::photonmap {

/// The kernels of an instruction set.
const TreeKernels& tree_kernels(Isa isa);

inline unsigned char* bytes_of(std::span<Photon> photons) {
    return reinterpret_cast<unsigned char*>(photons.data());
}

/// The axis along which the photons' tight bounding box is longest.
unsigned widest_axis(std::span<const Photon> photons, const TreeKernels& kernels);

inline void copy_code(const Photon& photon, std::uint32_t& energy, std::uint16_t& direction) {
    std::memcpy(&energy, &photon.energy, sizeof energy);
    std::memcpy(&direction, &photon.theta, sizeof direction);
}

/// Copies a photon to place i.
inline void copy_photon(const Photon& photon, std::size_t i, const CopiedPhotons& to) {
    copy_code(photon, to.energy[i], to.direction[i]);
    if (to.flags != nullptr) to.flags[i] = photon.flags;
    if (to.position[0] == nullptr) return;
    for (std::size_t axis = 0; axis < 3; ++axis) to.position[axis][i] = photon.position[axis];
}

/// What the three trees share: the side test, the bound from the query before, and the answer's
/// arrays.
class KdTreeBase : public PhotonTree {
public:
    void gather(std::span<const ReceiverPoint> points, const GatherLimits& limits,
                GatherScratch& scratch, const Consumer& consume) const override;

protected:
    KdTreeBase(const TreeKernels& kernels, const ArrivalDirections& directions)
        : kernels_(kernels), directions_(directions) {}

    /// A photon's energy and direction as one number.
    static std::uint64_t code(std::uint32_t energy, std::uint16_t direction) {
        return std::uint64_t{energy} << 16U | direction;
    }

    static std::uint64_t code(const Photon& photon) {
        std::uint32_t energy = 0;
        std::uint16_t direction = 0;
        copy_code(photon, energy, direction);
        return code(energy, direction);
    }

    /// Puts the query's answer into scratch.found, which has room for room_for(N).
    virtual void find(const NearestQuery& query, GatherScratch& scratch) const = 0;
    virtual void copy_out(const Candidates& found, const CopiedPhotons& to) const = 0;
    virtual std::uint64_t code_of(std::uint32_t photon) const = 0;

    /// Photons asked for, but no more than there are.
    std::size_t nearest(const GatherLimits& limits) const;
    /// Room for candidates: a search lets half as many again pile up before it shrinks.
    static std::size_t room_for(std::size_t nearest) {
        return nearest + nearest / 2 + 4 * bucket_photons;
    }

    /// One call of `gather`.
    struct Batch {
        std::span<const ReceiverPoint> points;
        const GatherLimits& limits;
        GatherScratch& scratch;
        const Consumer& consume;
        NearestQuery query{};  ///< without a point: up to the maximum radius, and no side test
        NeighbourBound bound{};
        float max_radius = 0;  ///< [m]
        float margin = 0;  ///< beyond the N-th photon [m]; of all photons the maximum radius has it
        float nth = -1;    ///< with a margin: the N-th photon's squared distance; -1: fewer than N

        NearestQuery query_at(const Vec3& point) const;
        /// Squared distance within which photons belong to the answer; `nth` is known.
        float reach() const { return reached((nth < 0 ? max_radius : std::sqrt(nth)) + margin); }
    };
    /// Prepares the query and makes room.
    void begin(Batch& batch) const;
    /// Answers one point; the bound is used and renewed.
    void answer(Batch& batch, std::size_t i) const;
    GatheredPhotons gathered(const Batch& batch, const Candidates& found,
                             const CopiedPhotons& copied) const;
    /// The next bound, from an answer.
    static void renew_bound(Batch& batch, std::size_t i, const GatheredPhotons& answer);

    /// Of candidates at the largest distance leaves those of the smallest codes, `nearest` in all.
    template <typename CodeOf>
    static void keep_smallest_codes(Candidates& found, std::size_t nearest, const CodeOf& code_of);

    const TreeKernels& kernels_;
    ArrivalDirections directions_;

private:
    void find_all(Batch& batch, std::size_t i, const SideTest* side,
                  const CopiedPhotons& copied) const;
};

template <typename CodeOf>
void KdTreeBase::keep_smallest_codes(Candidates& found, std::size_t nearest,
                                     const CodeOf& code_of) {
    const float greatest =
        *std::max_element(found.squared_distance, found.squared_distance + found.count);
    std::vector<std::pair<std::uint64_t, std::uint32_t>> tied;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < found.count; ++i) {
        if (found.squared_distance[i] == greatest) {
            tied.emplace_back(code_of(found.index[i]), found.index[i]);
        } else {
            found.squared_distance[kept] = found.squared_distance[i];
            found.index[kept++] = found.index[i];
        }
    }
    const std::size_t wanted = nearest - kept;
    std::nth_element(tied.begin(), tied.begin() + static_cast<std::ptrdiff_t>(wanted), tied.end());
    for (std::size_t i = 0; i < wanted; ++i) {
        found.squared_distance[kept] = greatest;
        found.index[kept++] = tied[i].second;
    }
    found.count = kept;
}

}  // namespace caustics::photonmap
