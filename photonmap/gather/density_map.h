#pragma once

#include "photonmap/estimate/radiance_estimate.h"
#include "photonmap/tree/photon_tree.h"

namespace caustics::photonmap {

/// Photons in a tree, and the estimate over them.
class DensityMap {
public:
    DensityMap(PhotonStore photons, const RadianceEstimate::Settings& settings, Isa isa);

    /// Calls take(i, gathered) for every point.
    void gather(std::span<const ReceiverPoint> points, GatherScratch& scratch,
                const PhotonTree::Consumer& take) const {
        tree_->gather(points, settings_.limits, scratch, take);
    }
    const RadianceEstimate& estimate() const { return estimate_; }
    const GatherLimits& limits() const { return settings_.limits; }
    std::size_t size() const { return tree_->size(); }
    std::uint64_t bytes() const { return tree_->bytes(); }

private:
    std::unique_ptr<const PhotonTree> tree_;
    RadianceEstimate::Settings settings_;
    RadianceEstimate estimate_;
};

}  // namespace caustics::photonmap
