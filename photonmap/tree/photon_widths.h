#pragma once

#include "core/run_options.h"
#include "photonmap/tree/packed_kd_tree.h"

namespace caustics::photonmap {

/// How wide the discs of a map's photons are.
struct DiscWidths {
    std::size_t nearest = 50;  ///< N: a disc reaches to the photon's N-th neighbour
    float max_radius = 1;      ///< [m], where there are fewer neighbours within it
    bool fixed = false;        ///< whether all discs have the maximum radius
    double share = 1;          ///< of the squared radius that is taken (pass_share)
};

/// The radii [m] of the photons' discs, bucket by bucket of their tree; 0 in a bucket's empty places. A photon's
/// neighbours are those that count at a point of its surface where it landed: they came from the same side, and their
/// surface faces alike. On all threads, a bucket at a time.
AlignedArray<float> photon_widths(const PackedKdTree& tree, const DiscWidths& widths,
                                  const RunOptions& options);

}  // namespace caustics::photonmap
