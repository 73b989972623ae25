#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/math/vec.h"
#include "photonmap/kernels/aligned_array.h"
#include "photonmap/kernels/tree_kernels.h"
#include "photonmap/tree/gathered_photons.h"

namespace caustics::photonmap {

/// Candidates with their memory.
class CandidateArrays {
public:
    /// Makes room for `capacity` candidates; forgets those held.
    Candidates& reserve(std::size_t capacity);
    Candidates& candidates() { return candidates_; }

private:
    AlignedArray<float> squared_distance_;
    AlignedArray<std::uint32_t> index_;
    Candidates candidates_;
};

/// Copied photons with their memory.
class CopyArrays {
public:
    /// Makes room for so many photons; forgets those held.
    void reserve(std::size_t count, bool positions);
    CopiedPhotons copied(bool positions, bool flags = false);

private:
    AlignedArray<std::uint32_t> energy_;
    AlignedArray<std::uint16_t> direction_;
    AlignedArray<std::uint16_t> flags_;
    AlignedArray<float> position_[3];
};

/// A thread's arrays for gathering, made once and filled by the trees; and how its queries were
/// answered.
struct GatherScratch {
    CandidateArrays found;
    CopyArrays copies;

    /// Makes room for so many found photons; forgets those held.
    void reserve(std::size_t count, bool positions) {
        found.reserve(count);
        copies.reserve(count, positions);
    }

    /// A subtree that a walk has put off.
    struct Pending {
        std::uint64_t node;
        float squared_distance;
    };
    std::vector<Pending> pending;

    // Groups of queries.
    std::vector<std::uint32_t> order;
    CandidateArrays group_found;
    CopyArrays group_copies;

    // Photons' own discs.
    AlignedArray<std::uint32_t> buckets;
    AlignedArray<float> radius;

    std::uint64_t single_queries = 0;
    std::uint64_t grouped_queries = 0;
    std::uint64_t visited_nodes = 0;  ///< of trees that have a photon at every node
};

}  // namespace caustics::photonmap
