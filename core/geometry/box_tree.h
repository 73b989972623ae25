#pragma once

#include <cstdint>
#include <vector>

#include "core/math/vec.h"

namespace caustics {

/// A binary tree over boxes, which finds those that meet a box in a time that grows with the logarithm of their number.
/// Boxes that touch meet, as Box::intersects has it.
class BoxTree {
public:
    BoxTree() = default;
    explicit BoxTree(std::vector<Box> boxes);

    /// True if `fits`, called with the index of a box that meets `box`, is true of one of them.
    template <typename Fits>
    bool any_at(const Box& box, const Fits& fits) const {
        return any_where([&](const Box& other) { return other.intersects(box); }, fits);
    }
    /// True if `fits`, called with the index of a box of which `meets` is true, is true of one of them. A box that holds
    /// another must meet what that one meets.
    template <typename Meets, typename Fits>
    bool any_where(const Meets& meets, const Fits& fits) const {
        return !nodes_.empty() && any_below(0, meets, fits);
    }

private:
    static constexpr std::uint32_t most_in_leaf = 4;

    /// Boxes order_[first] to order_[last - 1].
    struct Node {
        Box box;
        std::uint32_t first = 0;
        std::uint32_t last = 0;
        std::uint32_t right =
            0;  ///< the second of its two parts, the first follows it; 0: it is a leaf
    };

    std::uint32_t build(std::uint32_t first, std::uint32_t last);

    template <typename Meets, typename Fits>
    bool any_below(std::uint32_t index, const Meets& meets, const Fits& fits) const {
        const Node& node = nodes_[index];
        if (!meets(node.box)) return false;
        if (node.right != 0)
            return any_below(index + 1, meets, fits) || any_below(node.right, meets, fits);
        for (std::uint32_t i = node.first; i < node.last; ++i)
            if (meets(boxes_[order_[i]]) && fits(order_[i])) return true;
        return false;
    }

    std::vector<Box> boxes_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

}  // namespace caustics
