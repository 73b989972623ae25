#pragma once

#include <cstdint>
#include <vector>

namespace caustics::beamtree {

/// Which beams belong together: nodes whose children lie side by side, leaves of one beam each.
struct Hierarchy {
    struct Node {
        std::uint32_t first_beam = 0;  ///< into `order`
        std::uint32_t beam_count = 0;
        std::uint32_t first_child = 0;  ///< 0: a leaf
        std::uint32_t child_count = 0;
    };
    std::vector<Node> nodes;           ///< the root first; children after their parents
    std::vector<std::uint32_t> order;  ///< beam numbers

    std::uint32_t height() const;  ///< nodes on the longest way down
};

}  // namespace caustics::beamtree
