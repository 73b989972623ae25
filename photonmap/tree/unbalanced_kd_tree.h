#pragma once

#include "photonmap/tree/kd_tree_base.h"

namespace caustics::photonmap {

/// What the paper's balanced tree is compared with [J96 sec. 2]: photons inserted one by one in the
/// order of their arrival, the axes taken in turn x, y, z from level to level, each node with two
/// child pointers. Searched by the same code as the balanced tree.
class UnbalancedKdTree final : public KdTreeBase {
public:
    /// The photons' own memory is given back when the nodes are made.
    UnbalancedKdTree(PhotonStore photons, Isa isa);

    std::size_t size() const override { return size_; }
    std::uint64_t bytes() const override { return size_ * sizeof(Node); }
    /// `tree_depth`: levels of the tree; `nodes_passed`: nodes above each photon when it was inserted, summed.
    void add_to(Counters& counters) const override {
        counters["tree_depth"] += depth_;
        counters["nodes_passed"] += passed_;
    }

    struct Node {
        Photon photon;
        std::uint32_t children[2];  ///< 1-based; 0: none
    };
    static_assert(sizeof(Node) == 28);

private:
    void insert(std::uint32_t node);
    void find(const NearestQuery& query, GatherScratch& scratch) const override;
    void copy_out(const Candidates& found, const CopiedPhotons& to) const override;
    std::uint64_t code_of(std::uint32_t photon) const override;

    struct Unmap {
        std::size_t bytes = 0;
        void operator()(Node* memory) const;
    };
    std::size_t size_;
    std::unique_ptr<Node[], Unmap> nodes_;
    std::uint64_t depth_ = 0;
    std::uint64_t passed_ = 0;
};

}  // namespace caustics::photonmap
