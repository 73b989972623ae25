#pragma once

#include "photonmap/column_scan.h"
#include "photonmap/packed_walk.h"
#include "photonmap/small_order.h"

namespace caustics {

/// The loops for registers of one kind.
template <typename Lanes>
struct TreeKernelsOf {
    static constexpr TreeKernels value{
        &PackedWalk<Lanes>::find,        &ColumnScan<Lanes>::find,
        &CandidateLoops<Lanes>::shrink,  &CandidateLoops<Lanes>::farthest,
        &SmallOrder<Lanes>::bounds,      &SmallOrder<Lanes>::order,
        &SmallOrder<Lanes>::fill_buckets};
};

}  // namespace caustics
