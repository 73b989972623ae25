#pragma once

#include <memory>
#include <vector>

#include "photonmap/tree/photon_widths.h"

namespace caustics::photonmap {

/// Photons that have a disc each, up to their N-th neighbour: a kernel estimate whose widths belong to the samples
/// [Breiman, Meisel & Purcell 1977], in a plane in proportion to the density to the power -1/2, as [Abramson 1982] has
/// them. A kernel of integral 1 on each disc keeps the light of each photon, so that the estimate's integral over a
/// plane is the photons' flux.
///
/// A point's answer is the photons whose discs hold it, without a number N; a heap of boxes over the buckets of a
/// packed tree finds them. Where discs may be averaged over cells (ReceiverPoint::cell), it is those whose kernels may
/// reach the cell. Photons count for points as in every tree. The same answers on every instruction set.
class PhotonDiscs final : public PhotonTree {
public:
    /// `cell_reach`: how far a kernel reaches that is averaged over a cell, over the disc's radius; 0: cells are not
    /// looked at. Announces the progress of `options`, on its threads.
    PhotonDiscs(std::unique_ptr<const PackedKdTree> tree, const DiscWidths& widths,
                float cell_reach, const RunOptions& options);

    /// Of the limits only `positions` is read, and answers with a cell have them always.
    void gather(std::span<const ReceiverPoint> points, const GatherLimits& limits,
                GatherScratch& scratch, const Consumer& consume) const override;
    std::size_t size() const override { return tree_->size(); }
    std::uint64_t bytes() const override;

private:
    /// [m]
    struct Bounds {
        float low[3], high[3];
    };

    std::size_t bucket_count() const { return tree_->view_.bucket_count; }
    void bound_discs();
    Bounds bounds_of(std::size_t bucket) const;
    std::size_t buckets_near(const ReceiverPoint& point, const PixelCell* cell,
                             std::uint32_t* buckets) const;
    GatheredPhotons covering(const ReceiverPoint& point, GatherScratch& scratch) const;

    std::unique_ptr<const PackedKdTree> tree_;
    AlignedArray<float> radius_;
    float cell_reach_;
    std::vector<Bounds>
        bounds_;  ///< of the discs below each node of the packed tree, the root's at 1
};

}  // namespace caustics::photonmap
