#pragma once

#include "photonmap/kernels/column_scan.h"
#include "photonmap/kernels/disc_scan.h"
#include "photonmap/kernels/n_chooser.h"
#include "photonmap/kernels/packed_walk.h"
#include "photonmap/kernels/simd_subtree_build.h"

namespace caustics::photonmap {

/// The loops for registers of one kind.
template <typename Lanes>
struct TreeKernelsOf {
    static constexpr TreeKernels value{
        .find_packed = &PackedWalk<Lanes>::find,
        .find_in_columns = &ColumnScan<Lanes>::find,
        .nth_in_columns = &ColumnScan<Lanes>::nth,
        .find_covering = &DiscScan<Lanes>::find,
        .shrink = &CandidateLoops<Lanes>::shrink,
        .farthest = &CandidateLoops<Lanes>::farthest,
        .choose_count = &NChoiceOf<Lanes>::choose,
        .bounds = &SimdSubtreeBuild<Lanes>::bounds,
        .order_small = &SimdSubtreeBuild<Lanes>::order,
        .fill_buckets = &SimdSubtreeBuild<Lanes>::fill_buckets,
    };
};

}  // namespace caustics::photonmap
