#include "beamtree/slices/slice_build.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/interrupt.h"
#include "core/base/parallel.h"

namespace caustics::beamtree {
namespace {

constexpr float no_bound = std::numeric_limits<float>::infinity();

// What float arithmetic may lose of a place, as a share of the largest coordinate: eleven roundings
// of 2^-24 or so.
constexpr float box_rounding = 1e-6F;
// Triangles of a branch, which one thread makes.
constexpr std::uint32_t branch_size = 8192;

SliceBox box_of(const SlicedTriangle& triangle) {
    SliceBox box;
    SliceReach reach;
    for (std::size_t i = 0; i < reach.size(); ++i) reach[i] = triangle.drift[i] + triangle.bulge[i];
    for (const RaySlices& corner : triangle.corners) box.extend(corner, reach);
    return box;
}

// The larger reach of both planes, along an axis.
float most(const SliceReach& reach, std::size_t axis) {
    return std::max(reach[axis], reach[2 + axis]);
}

float widest(const SliceBox& box, int axis) {
    return std::max(box.size(axis, 0), box.size(axis, 1));
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
        margin_ = box_rounding * largest;
    }

    SliceNodes run(int threads) {
        find_branches(0, 1);
        parallel_chunks(threads, branches_.size(), 1, [&](const Chunk& chunk) {
            Branch& branch = branches_[chunk.index];
            branch.root = make(branch.node, branch.depth, branch.made);
        });
        SliceNodes all;
        Branch* next = branches_.data();
        all.root = join(0, 1, next, all).reference;
        copy_branches(threads, all);
        all.leaf_width /= static_cast<float>(all.leaves.size());
        all.travel /= static_cast<float>(triangles_.size());
        all.has_bulges = std::ranges::any_of(triangles_, [](const SlicedTriangle& triangle) {
            return triangle.bulge != SliceReach{};
        });
        return all;
    }

private:
    /// A node or leaf, and what bounds it.
    struct Made {
        std::uint32_t reference = 0;
        SliceBox box;
        float begun_from = no_bound;
    };
    /// A part of the tree that one thread makes, with numbers of its own.
    struct Branch {
        std::uint32_t node;
        std::uint32_t depth;
        SliceNodes made;
        Made root;
        std::size_t first_node = 0;  ///< in the whole tree
        std::size_t first_leaf = 0;
    };

    bool is_branch(std::uint32_t node) const { return size(node) <= branch_size; }

    // In the order of a walk from left to right.
    void find_branches(std::uint32_t node, std::uint32_t depth) {
        if (is_branch(node)) {
            branches_.push_back({node, depth, {}, {}});
            return;
        }
        for (const std::uint32_t child : children_of(node)) find_branches(child, depth + 1);
    }

    static std::uint32_t moved(std::uint32_t reference, const Branch& branch) {
        const bool is_leaf = (reference & slice_leaf_bit) != 0;
        return reference +
               static_cast<std::uint32_t>(is_leaf ? branch.first_leaf : branch.first_node);
    }

    // The nodes above the branches, with room for these in the order of the whole.
    Made join(std::uint32_t node, std::uint32_t depth, Branch*& next, SliceNodes& all) {
        if (!is_branch(node))
            return make_node(
                node, all, [&](std::uint32_t child) { return join(child, depth + 1, next, all); });
        Branch& branch = *next++;
        branch.first_node = all.nodes.size();
        branch.first_leaf = all.leaves.size();
        all.nodes.resize(all.nodes.size() + branch.made.nodes.size());
        all.leaves.resize(all.leaves.size() + branch.made.leaves.size());
        all.height = std::max(all.height, branch.made.height);
        all.leaf_width += branch.made.leaf_width;
        all.travel += branch.made.travel;
        branch.root.reference = moved(branch.root.reference, branch);
        return branch.root;
    }

    void copy_branches(int threads, SliceNodes& all) const {
        parallel_chunks(threads, branches_.size(), 1, [&](const Chunk& chunk) {
            const Branch& branch = branches_[chunk.index];
            const auto at = [](auto& things, std::size_t first) {
                return things.begin() + static_cast<std::ptrdiff_t>(first);
            };
            std::ranges::copy(branch.made.leaves, at(all.leaves, branch.first_leaf));
            std::ranges::transform(branch.made.nodes, at(all.nodes, branch.first_node),
                                   [&](const SliceNode& made) {
                                       SliceNode node = made;
                                       for (std::uint32_t& child : node.child)
                                           child = moved(child, branch);
                                       return node;
                                   });
        });
    }

    static std::uint32_t reference(std::size_t number, std::uint32_t taken) {
        return static_cast<std::uint32_t>(number) | (taken - 1) << slice_count_shift;
    }

    std::uint32_t size(std::uint32_t node) const {
        const Hierarchy::Node& n = from_.nodes[node];
        return first_of_[n.first_beam + n.beam_count] - first_of_[n.first_beam];
    }

    Made make(std::uint32_t node, std::uint32_t depth, SliceNodes& made) const {
        throw_if_interrupted();
        made.height = std::max(made.height, depth);
        if (size(node) <= slice_width) return make_leaf(node, made);
        return make_node(node, made,
                         [&](std::uint32_t child) { return make(child, depth + 1, made); });
    }

    template <typename Make>
    Made make_node(std::uint32_t node, SliceNodes& into, const Make& make_child) const {
        const std::size_t index = into.nodes.size();
        into.nodes.emplace_back();
        SliceNode wide{};
        const std::vector<std::uint32_t> children = children_of(node);
        const auto taken = static_cast<std::uint32_t>(children.size());
        Made made{reference(index, taken), {}};
        for (std::uint32_t i = 0; i < taken; ++i) {
            const Made below = make_child(children[i]);
            made.box.extend(below.box);
            made.begun_from = std::min(made.begun_from, below.begun_from);
            put(below, wide, i);
        }
        for (std::uint32_t i = taken; i < slice_width; ++i)
            for (int axis = 0; axis < 2; ++axis) {
                wide.low[axis][i] = no_bound;
                wide.high[axis][i] = -no_bound;
            }
        into.nodes[index] = wide;
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
            wide.low[axis][i] = low - margin_;
            wide.low_growth[axis][i] = child.box.low(axis, 1) - low;
            wide.high[axis][i] = high + margin_;
            wide.high_growth[axis][i] = child.box.high(axis, 1) - high;
        }
        wide.begun_from[i] = child.begun_from;
        wide.child[i] = child.reference;
    }

    Made make_leaf(std::uint32_t node, SliceNodes& into) const {
        const std::uint32_t first = first_of_[from_.nodes[node].first_beam];
        const std::uint32_t taken = size(node);
        SliceLeaf leaf{};
        std::fill_n(leaf.slack, slice_width, -no_bound);
        Made made{reference(into.leaves.size(), taken) | slice_leaf_bit, {}};
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
            into.travel += std::hypot(leaf.growth[0][0][i], leaf.growth[0][1][i]);
            // Of a x b with |a|, |b| <= width, each coordinate of which may be off by the margin.
            leaf.slack[i] = margin_ * (5 * width + 4 * margin_);
            // Likewise for corners that move.
            const float along = most(triangle.drift, 0);
            const float across = most(triangle.drift, 1);
            leaf.slack[i] +=
                2 * (along * widest(box, 1) + across * widest(box, 0) + along * across);
            // A point beside the triangle is off an edge by the edge times its way.
            leaf.slack[i] +=
                most(triangle.bulge, 0) * widest(box, 1) + most(triangle.bulge, 1) * widest(box, 0);
            for (std::size_t axis = 0; axis < 2; ++axis)
                leaf.room[axis][i] =
                    margin_ + most(triangle.drift, axis) + most(triangle.bulge, axis);
            leaf.begun_from[i] = triangle.begun_from;
            leaf.whole_from[i] = triangle.whole_from;
            made.begun_from = std::min(made.begun_from, triangle.begun_from);
            leaf.beam[i] = triangle.beam;
        }
        for (const int plane : {0, 1})
            into.leaf_width += std::max(made.box.size(0, plane), made.box.size(1, plane)) / 2;
        into.leaves.push_back(leaf);
        return made;
    }

    const Hierarchy& from_;
    std::span<const SlicedTriangle> triangles_;
    std::vector<std::uint32_t> first_of_;  ///< triangles of the beams in their order, and the end
    float margin_ = 0;
    std::vector<Branch> branches_;
};

}  // namespace

SliceNodes widen(const Hierarchy& hierarchy, std::span<const SlicedTriangle> triangles,
                 int threads) {
    return Widener(hierarchy, triangles).run(threads);
}

}  // namespace caustics::beamtree
