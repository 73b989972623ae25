#include "beamtree/slice_build.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace caustics {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

// What float arithmetic may lose of a place, as a share of the largest coordinate: eleven roundings
// of 2^-24 or so.
constexpr float rounding = 1e-6F;

SliceBox box_of(const SlicedTriangle& triangle) {
    SliceBox box;
    for (const RaySlices& corner : triangle.corners) box.extend(corner);
    return box;
}

class Widener {
public:
    Widener(const Hierarchy& from, std::span<const SlicedTriangle> triangles)
        : from_(from), triangles_(triangles) {
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
    };

    std::uint32_t size(std::uint32_t node) const {
        const Hierarchy::Node& n = from_.nodes[node];
        return first_of_[n.first_beam + n.beam_count] - first_of_[n.first_beam];
    }

    Made make(std::uint32_t node, std::uint32_t depth) {
        made_.height = std::max(made_.height, depth);
        if (size(node) <= slice_width) return make_leaf(node);
        const auto index = static_cast<std::uint32_t>(made_.nodes.size());
        made_.nodes.emplace_back();
        SliceNode wide{};
        Made made{index, {}};
        for (const std::uint32_t child : children_of(node)) {
            const Made below = make(child, depth + 1);
            made.box.extend(below.box);
            add(below, wide);
        }
        for (std::uint32_t i = wide.count; i < slice_width; ++i)
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

    void add(const Made& child, SliceNode& wide) const {
        const std::uint32_t i = wide.count++;
        for (int axis = 0; axis < 2; ++axis) {
            const float low = child.box.low(axis, 0);
            const float high = child.box.high(axis, 0);
            wide.low[axis][i] = low - margin_;
            wide.low_growth[axis][i] = child.box.low(axis, 1) - low;
            wide.high[axis][i] = high + margin_;
            wide.high_growth[axis][i] = child.box.high(axis, 1) - high;
        }
        wide.child[i] = child.reference;
    }

    Made make_leaf(std::uint32_t node) {
        const std::uint32_t first = first_of_[from_.nodes[node].first_beam];
        SliceLeaf leaf{};
        leaf.count = size(node);
        std::fill_n(leaf.slack, slice_width, -infinity);
        Made made{static_cast<std::uint32_t>(made_.leaves.size()) | slice_leaf_bit, {}};
        for (std::uint32_t i = 0; i < leaf.count; ++i) {
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
                width = std::max({width, box.size(axis, 0), box.size(axis, 1)});
            }
            made_.travel += std::hypot(leaf.growth[0][0][i], leaf.growth[0][1][i]);
            // Of a x b with |a|, |b| <= width, each coordinate of which may be off by the margin.
            leaf.slack[i] = margin_ * (5 * width + 4 * margin_);
            leaf.whole_from[i] = triangle.whole_from;
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
    float margin_ = 0;
    SliceNodes made_;
};

}  // namespace

SliceNodes widen(const Hierarchy& hierarchy, std::span<const SlicedTriangle> triangles) {
    return Widener(hierarchy, triangles).run();
}

}  // namespace caustics
