#include "beamtree/beams/hierarchy.h"

#include <algorithm>

namespace caustics::beamtree {

std::uint32_t Hierarchy::height() const {
    std::vector<std::uint32_t> depth(nodes.size(), 1);
    std::uint32_t deepest = nodes.empty() ? 0 : 1;
    for (std::uint32_t i = 0; i < nodes.size(); ++i)
        for (std::uint32_t c = 0; c < nodes[i].child_count; ++c) {
            depth[nodes[i].first_child + c] = depth[i] + 1;
            deepest = std::max(deepest, depth[i] + 1);
        }
    return deepest;
}

}  // namespace caustics::beamtree
