#include "photonmap/tree/build_tree.h"

#include "photonmap/tree/balanced_kd_tree.h"
#include "photonmap/tree/packed_kd_tree.h"
#include "photonmap/tree/unbalanced_kd_tree.h"

namespace caustics::photonmap {

std::unique_ptr<const PhotonTree> build_tree(TreeKind kind, PhotonStore photons, Isa isa,
                                             int threads) {
    switch (kind) {
        case TreeKind::packed:
            return std::make_unique<PackedKdTree>(std::move(photons), isa, threads);
        case TreeKind::unbalanced:
            return std::make_unique<UnbalancedKdTree>(std::move(photons), isa);
        case TreeKind::balanced: break;
    }
    return std::make_unique<BalancedKdTree>(std::move(photons), isa, threads);
}

}  // namespace caustics::photonmap
