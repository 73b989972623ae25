#include "beamtree/slices/slice_build.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/interrupt.h"

namespace caustics::beamtree {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

// What float arithmetic may lose of a place, as a share of the largest coordinate: eleven roundings
// of 2^-24 or so.
constexpr float rounding = 1e-6F;

SliceBox box_of(const SlicedTriangle& triangle) {
    SliceBox box;
    for (const RaySlices& corner : triangle.corners) box.extend(corner, triangle.drift);
    return box;
}

float widest(const SliceBox& box, int axis) {
    return std::max(box.size(axis, 0), box.size(axis, 1));
}

class Widener {
public:
    Widener(const Hierarchy& from, std::span<const SlicedTriangle> triangles, float reach)
        : from_(from), triangles_(triangles), reach_(reach) {
        SliceBox all;
        for (const SlicedTriangle& triangle : triangles) {
            all.extend(box_of(triangle));
            if (first_of_.empty() || triangle.beam != triangles[first_of_.back()].beam)
                first_of_.push_back(static_cast<std::uint32_t>(&triangle - triangles.data()));
        }
        first_of_.push_back(static_cast<std::uint32_t>(triangles.size()));
        float largest = 0;
        for (int axis = 0; axis < 2; ++axis)
            for (int plane = 0; plane < 2; ++plane)
                largest = std::max({largest, -all.low(axis, plane), all.high(axis, plane)});
        margin_ = rounding * largest;
    }

    SliceNodes run() {
        made_.root = make(0, 1).reference;
        made_.leaf_width /= static_cast<float>(made_.leaves.size());
        made_.travel /= static_cast<float>(triangles_.size());
        return std::move(made_);
    }

private:
    /// A node or leaf, and what bounds it.
    struct Made {
        std::uint32_t reference;
        SliceBox box;
        float begun_from = infinity;
    };

    static std::uint32_t reference(std::size_t number, std::uint32_t taken) {
        return static_cast<std::uint32_t>(number) | (taken - 1) << slice_count_shift;
    }

    std::uint32_t size(std::uint32_t node) const {
        const Hierarchy::Node& n = from_.nodes[node];
        return first_of_[n.first_beam + n.beam_count] - first_of_[n.first_beam];
    }

    Made make(std::uint32_t node, std::uint32_t depth) {
        throw_if_interrupted();
        made_.height = std::max(made_.height, depth);
        if (size(node) <= slice_width) return make_leaf(node);
        const std::size_t index = made_.nodes.size();
        made_.nodes.emplace_back();
        SliceNode wide{};
        const std::vector<std::uint32_t> children = children_of(node);
        const auto taken = static_cast<std::uint32_t>(children.size());
        Made made{reference(index, taken), {}};
        for (std::uint32_t i = 0; i < taken; ++i) {
            const Made below = make(children[i], depth + 1);
            made.box.extend(below.box);
            made.begun_from = std::min(made.begun_from, below.begun_from);
            put(below, wide, i);
        }
        for (std::uint32_t i = taken; i < slice_width; ++i)
            for (int axis = 0; axis < 2; ++axis) {
                wide.low[axis][i] = infinity;
                wide.high[axis][i] = -infinity;
            }
        made_.nodes[index] = wide;
        return made;
    }

    // Up to eight nodes that make up this one.
    std::vector<std::uint32_t> children_of(std::uint32_t node) const {
        std::vector<std::uint32_t> children = {node};
        while (true) {
            std::uint32_t most = slice_width;
            std::size_t widest = children.size();
            for (std::size_t i = 0; i < children.size(); ++i) {
                const std::uint32_t inside = from_.nodes[children[i]].child_count;
                const bool fits = inside > 0 && children.size() - 1 + inside <= slice_width;
                if (!fits || size(children[i]) <= most) continue;
                most = size(children[i]);
                widest = i;
            }
            if (widest == children.size()) return children;
            const Hierarchy::Node& opened = from_.nodes[children[widest]];
            children.erase(children.begin() + static_cast<std::ptrdiff_t>(widest));
            for (std::uint32_t i = 0; i < opened.child_count; ++i)
                children.push_back(opened.first_child + i);
        }
    }

    void put(const Made& child, SliceNode& wide, std::uint32_t i) const {
        for (int axis = 0; axis < 2; ++axis) {
            const float low = child.box.low(axis, 0);
            const float high = child.box.high(axis, 0);
            wide.low[axis][i] = low - margin_ - reach_;
            wide.low_growth[axis][i] = child.box.low(axis, 1) - low;
            wide.high[axis][i] = high + margin_ + reach_;
            wide.high_growth[axis][i] = child.box.high(axis, 1) - high;
        }
        wide.begun_from[i] = child.begun_from;
        wide.child[i] = child.reference;
    }

    Made make_leaf(std::uint32_t node) {
        const std::uint32_t first = first_of_[from_.nodes[node].first_beam];
        const std::uint32_t taken = size(node);
        SliceLeaf leaf{};
        std::fill_n(leaf.slack, slice_width, -infinity);
        Made made{reference(made_.leaves.size(), taken) | slice_leaf_bit, {}};
        for (std::uint32_t i = 0; i < taken; ++i) {
            const SlicedTriangle& triangle = triangles_[first + i];
            const SliceBox box = box_of(triangle);
            made.box.extend(box);
            float width = 0;
            for (int axis = 0; axis < 2; ++axis) {
                for (std::size_t c = 0; c < 3; ++c) {
                    const RaySlices& at = triangle.corners[c];
                    const auto k = static_cast<std::size_t>(axis);
                    leaf.corner[c][axis][i] = at[k];
                    leaf.growth[c][axis][i] = at[2 + k] - at[k];
                }
                width = std::max(width, widest(box, axis));
            }
            made_.travel += std::hypot(leaf.growth[0][0][i], leaf.growth[0][1][i]);
            // Of a x b with |a|, |b| <= width, each coordinate of which may be off by the margin; and
            // moving the point by the reach adds the reach times both extents of the edge.
            leaf.slack[i] = margin_ * (5 * width + 4 * (margin_ + reach_)) + 2 * reach_ * width;
            // Likewise for corners that move.
            const auto& [along, across] = triangle.drift;
            leaf.slack[i] +=
                2 * (along * widest(box, 1) + across * widest(box, 0) + along * across);
            leaf.begun_from[i] = triangle.begun_from;
            leaf.whole_from[i] = triangle.whole_from;
            made.begun_from = std::min(made.begun_from, triangle.begun_from);
            leaf.beam[i] = triangle.beam;
        }
        for (const int plane : {0, 1})
            made_.leaf_width += std::max(made.box.size(0, plane), made.box.size(1, plane)) / 2;
        made_.leaves.push_back(leaf);
        return made;
    }

    const Hierarchy& from_;
    std::span<const SlicedTriangle> triangles_;
    std::vector<std::uint32_t> first_of_;  ///< triangles of the beams in their order, and the end
    float reach_;
    float margin_ = 0;
    SliceNodes made_;
};

}  // namespace

SliceNodes widen(const Hierarchy& hierarchy, std::span<const SlicedTriangle> triangles,
                 float reach) {
    return Widener(hierarchy, triangles, reach).run();
}

}  // namespace caustics::beamtree
