#pragma once

#include "photonmap/kernels/left_balanced.h"
#include "photonmap/tree/kd_tree_base.h"

namespace caustics::photonmap {

/// Turns an array of photons into the balanced kd-tree of [J96 sec. 2], in place with O(1) extra
/// memory: a heap (left_balanced.h), node i = photon i - 1 of the array, whose root is the median along the
/// largest interval of the photons' tight bounding box, and so on. The two lowest bits of a
/// photon's flags hold its splitting axis. Positions must be finite. The same tree on every instruction
/// set and any number of threads.
void balance(std::span<Photon> photons, Isa isa = widest_isa(), int threads = 1);

/// The paper's tree: the photons alone, no child pointers.
class BalancedKdTree final : public KdTreeBase {
public:
    BalancedKdTree(PhotonStore photons, Isa isa, int threads);

    std::size_t size() const override { return photons_.size(); }
    std::uint64_t bytes() const override { return photons_.bytes(); }

private:
    void find(const NearestQuery& query, GatherScratch& scratch) const override;
    void copy_out(const Candidates& found, const CopiedPhotons& to) const override;
    std::uint64_t code_of(std::uint32_t photon) const override;

    PhotonStore photons_;
};

}  // namespace caustics::photonmap
