#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "photonmap/aligned_array.h"
#include "photonmap/gathered_photons.h"
#include "photonmap/tree_kernels.h"

namespace caustics {

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

/// A thread's arrays for gathering, made once and filled by the trees; and how its queries were
/// answered.
struct GatherScratch {
    CandidateArrays found;
    AlignedArray<std::uint32_t> energy;
    AlignedArray<std::uint16_t> direction;
    AlignedArray<float> position[3];

    /// Makes room for so many found photons and a register behind them; forgets those held.
    void reserve(std::size_t count, bool positions);
    /// The arrays that found photons are copied to.
    CopiedPhotons copied(bool positions);

    /// A subtree that a walk has put off.
    struct Pending {
        std::uint64_t node;
        float squared_distance;
    };
    std::vector<Pending> pending;

    // Groups of queries.
    std::vector<std::uint32_t> order;
    CandidateArrays group_found;
    AlignedArray<float> column[3];
    AlignedArray<std::uint32_t> column_energy;
    AlignedArray<std::uint32_t> column_direction;

    std::uint64_t single_queries = 0;
    std::uint64_t grouped_queries = 0;
};

}  // namespace caustics
