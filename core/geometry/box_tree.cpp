#include "core/geometry/box_tree.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace caustics {

BoxTree::BoxTree(std::vector<Box> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
    if (!boxes_.empty()) build(0, static_cast<std::uint32_t>(boxes_.size()));
}

// Halves by the middle of the boxes' centres, along the axis on which these lie widest apart.
std::uint32_t BoxTree::build(std::uint32_t first, std::uint32_t last) {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    Box all;
    Box centres;
    for (std::uint32_t i = first; i < last; ++i) {
        all.extend(boxes_[order_[i]]);
        centres.extend(Vec3(boxes_[order_[i]].center()));
    }
    nodes_.push_back({all, first, last});
    if (last - first <= most_in_leaf) return index;
    Eigen::Index axis = 0;
    centres.sizes().maxCoeff(&axis);
    const std::uint32_t middle = first + (last - first) / 2;
    const auto begin = order_.begin();
    std::nth_element(begin + first, begin + middle, begin + last,
                     [&](std::uint32_t a, std::uint32_t b) {
                         return boxes_[a].center()[axis] < boxes_[b].center()[axis];
                     });
    build(first, middle);
    const std::uint32_t right = build(middle, last);
    nodes_[index].right = right;
    return index;
}

}  // namespace caustics
