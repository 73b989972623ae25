#pragma once

#include <array>

#include "photonmap/kernels/aligned_array.h"
#include "photonmap/tree/kd_tree_base.h"

namespace caustics::photonmap {

/// A kd-tree over buckets of photons, built in the photons' own memory. A bucket holds x, y, z, energy,
/// directions and flags of its photons one array after the other, so that a register takes many photons
/// at once. The tree above is a heap of splitting planes, four bytes a bucket (left_balanced.h): inner
/// node i's plane is planes[i], its axis in the lowest two bits. The last bucket, when it is not
/// full, is filled up with positions at infinity.
class PackedKdTree final : public KdTreeBase {
public:
    PackedKdTree(PhotonStore photons, Isa isa, int threads);

    /// A batch is split into groups as long as these are wide against the distance of the N-th
    /// photon; a group's photons are collected by one walk.
    void gather(std::span<const ReceiverPoint> points, const GatherLimits& limits,
                GatherScratch& scratch, const Consumer& consume) const override;
    std::size_t size() const override { return photons_.size(); }
    std::uint64_t bytes() const override;
    /// A photon as the buckets order them; without its tree's axis.
    Photon photon(std::size_t index) const;

private:
    friend class PackedGather;
    friend class PhotonDiscs;

    void find(const NearestQuery& query, GatherScratch& scratch) const override;
    void copy_out(const Candidates& found, const CopiedPhotons& to) const override;
    std::uint64_t code_of(std::uint32_t photon) const override;

    std::size_t bucket_count() const {
        return (photons_.size() + bucket_photons - 1) / bucket_photons;
    }
    void order(int threads);

    PhotonStore photons_;
    std::unique_ptr<std::uint32_t[]> planes_;
    PackedView view_{};
};

}  // namespace caustics::photonmap
