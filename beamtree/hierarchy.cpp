#include "beamtree/hierarchy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace caustics {
namespace {

/// A rectangle of cells.
struct Cells {
    const GridPatch* patch;
    std::uint32_t column0, column1, row0, row1;
};

class QuadtreeBuilder {
public:
    QuadtreeBuilder(const BeamSet& set, std::span<const std::uint32_t> beams,
                    std::span<const GridPatch> patches) {
        std::uint32_t triangles = 0;
        for (const GridPatch& patch : patches)
            triangles = std::max(triangles, patch.first_triangle +
                                                patch.columns * patch.rows * patch.cell_triangles);
        beam_of_.assign(triangles, Beam::none);
        for (const std::uint32_t beam : beams) beam_of_[set.beams[beam].triangle] = beam;
        tree_.nodes.resize(1);
        std::vector<Cells> roots;
        for (const GridPatch& patch : patches)
            roots.push_back({&patch, 0, patch.columns, 0, patch.rows});
        fill(0, roots);
    }

    Hierarchy take() { return std::move(tree_); }

private:
    // Makes a node of what the parts hold: its children are those parts that hold beams.
    void fill(std::uint32_t node, std::vector<Cells> parts) {
        std::erase_if(parts, [&](const Cells& cells) { return !any_beam(cells); });
        if (parts.empty()) return;
        if (parts.size() == 1) {
            const Cells& only = parts.front();
            if (only.column1 - only.column0 == 1 && only.row1 - only.row0 == 1)
                fill_cell(node, only);
            else
                fill(node, quarters(only));
            return;
        }
        const std::uint32_t first = add_children(node, parts.size());
        const auto begin = static_cast<std::uint32_t>(tree_.order.size());
        for (std::uint32_t i = 0; i < parts.size(); ++i) fill(first + i, {parts[i]});
        cover(node, begin);
    }

    void fill_cell(std::uint32_t node, const Cells& cell) {
        std::vector<std::uint32_t> beams;
        for (std::uint32_t i = 0; i < cell.patch->cell_triangles; ++i)
            if (const std::uint32_t beam = beam_in(cell, cell.column0, cell.row0, i);
                beam != Beam::none)
                beams.push_back(beam);
        const auto begin = static_cast<std::uint32_t>(tree_.order.size());
        if (beams.size() == 1) {
            tree_.order.push_back(beams[0]);
            cover(node, begin);
            return;
        }
        const std::uint32_t first = add_children(node, beams.size());
        for (std::uint32_t i = 0; i < beams.size(); ++i) {
            tree_.order.push_back(beams[i]);
            cover(first + i, begin + i);
        }
        cover(node, begin);
    }

    static std::vector<Cells> quarters(const Cells& c) {
        std::vector<Cells> parts;
        const std::uint32_t column = (c.column0 + c.column1 + 1) / 2;
        const std::uint32_t row = (c.row0 + c.row1 + 1) / 2;
        for (const auto& [r0, r1] : {std::pair(c.row0, row), std::pair(row, c.row1)})
            for (const auto& [c0, c1] :
                 {std::pair(c.column0, column), std::pair(column, c.column1)})
                if (c0 < c1 && r0 < r1) parts.push_back({c.patch, c0, c1, r0, r1});
        return parts;
    }

    std::uint32_t beam_in(const Cells& c, std::uint32_t column, std::uint32_t row,
                          std::uint32_t triangle) const {
        return beam_of_[c.patch->first_triangle +
                        (row * c.patch->columns + column) * c.patch->cell_triangles + triangle];
    }

    bool any_beam(const Cells& c) const {
        for (std::uint32_t row = c.row0; row < c.row1; ++row)
            for (std::uint32_t column = c.column0; column < c.column1; ++column)
                for (std::uint32_t i = 0; i < c.patch->cell_triangles; ++i)
                    if (beam_in(c, column, row, i) != Beam::none) return true;
        return false;
    }

    std::uint32_t add_children(std::uint32_t node, std::size_t count) {
        const auto first = static_cast<std::uint32_t>(tree_.nodes.size());
        tree_.nodes.resize(tree_.nodes.size() + count);
        tree_.nodes[node].first_child = first;
        tree_.nodes[node].child_count = static_cast<std::uint32_t>(count);
        return first;
    }

    void cover(std::uint32_t node, std::uint32_t begin) {
        tree_.nodes[node].first_beam = begin;
        tree_.nodes[node].beam_count = static_cast<std::uint32_t>(tree_.order.size()) - begin;
        if (tree_.nodes[node].child_count == 0) tree_.nodes[node].beam_count = 1;
    }

    Hierarchy tree_;
    std::vector<std::uint32_t> beam_of_;
};

using Key = Eigen::Matrix<float, 6, 1>;
using KeyBox = Eigen::AlignedBox<float, 6>;

class BinnedBuilder {
public:
    BinnedBuilder(const BeamSet& set, std::span<const std::uint32_t> beams, float reach) {
        keys_.resize(set.beams.size());
        for (const std::uint32_t i : beams) {
            const auto corners = set.triangle(set.beams[i], 0);
            Key key = Key::Zero();
            for (const VertexRay* ray : corners) {
                key.head<3>() += ray->position / 3;
                key.tail<3>() += reach / 3 * ray->direction;
            }
            keys_[i] = key;
        }
        tree_.order.assign(beams.begin(), beams.end());
        tree_.nodes.push_back({0, static_cast<std::uint32_t>(beams.size()), 0, 0});
        // Not by recursion: a chain of one beam a level must not end the stack.
        for (std::uint32_t node = 0; node < tree_.nodes.size(); ++node) split(node);
    }

    Hierarchy take() { return std::move(tree_); }

private:
    static constexpr std::size_t bins = 16;

    void split(std::uint32_t node) {
        const std::uint32_t first = tree_.nodes[node].first_beam;
        const std::uint32_t count = tree_.nodes[node].beam_count;
        if (count <= 1) return;
        const std::span<std::uint32_t> beams(tree_.order.data() + first, count);
        const auto left = static_cast<std::uint32_t>(partition(beams));
        const auto child = static_cast<std::uint32_t>(tree_.nodes.size());
        tree_.nodes.push_back({first, left, 0, 0});
        tree_.nodes.push_back({first + left, count - left, 0, 0});
        tree_.nodes[node].first_child = child;
        tree_.nodes[node].child_count = 2;
    }

    static double cost(const KeyBox& box, std::size_t count) {
        if (count == 0) return 0;
        const Key size = box.sizes();
        const double diagonal = static_cast<double>(size.head<3>().norm() + size.tail<3>().norm());
        return static_cast<double>(count) * diagonal * diagonal;
    }

    // Sorts the beams into two halves and returns the number in the first.
    std::size_t partition(std::span<std::uint32_t> beams) const {
        KeyBox box;
        for (const std::uint32_t beam : beams) box.extend(keys_[beam]);
        double best = std::numeric_limits<double>::infinity();
        int best_axis = -1;
        std::size_t best_bin = 0;
        for (int axis = 0; axis < 6; ++axis) {
            const auto [axis_cost, bin] = best_split(beams, box, axis);
            if (axis_cost >= best) continue;
            best = axis_cost;
            best_axis = axis;
            best_bin = bin;
        }
        if (best_axis < 0) return beams.size() / 2;  // all at one place
        const auto middle = std::stable_partition(
            beams.begin(), beams.end(),
            [&](std::uint32_t beam) { return bin_of(beam, box, best_axis) <= best_bin; });
        return static_cast<std::size_t>(middle - beams.begin());
    }

    std::size_t bin_of(std::uint32_t beam, const KeyBox& box, int axis) const {
        const float share = (keys_[beam][axis] - box.min()[axis]) / box.sizes()[axis];
        return std::min(bins - 1, static_cast<std::size_t>(share * static_cast<float>(bins)));
    }

    // The least cost over the bins' borders, infinite where the axis cannot be split.
    std::pair<double, std::size_t> best_split(std::span<const std::uint32_t> beams,
                                              const KeyBox& box, int axis) const {
        std::pair<double, std::size_t> best{std::numeric_limits<double>::infinity(), 0};
        if (!(box.sizes()[axis] > 0)) return best;
        std::array<KeyBox, bins> boxes;
        std::array<std::size_t, bins> counts{};
        for (const std::uint32_t beam : beams) {
            const std::size_t bin = bin_of(beam, box, axis);
            boxes[bin].extend(keys_[beam]);
            ++counts[bin];
        }
        std::array<double, bins> right{};
        KeyBox sum;
        std::size_t count = 0;
        for (std::size_t i = bins; i-- > 1;) {
            sum.extend(boxes[i]);
            right[i] = cost(sum, count += counts[i]);
        }
        sum.setEmpty();
        count = 0;
        for (std::size_t i = 0; i + 1 < bins; ++i) {
            sum.extend(boxes[i]);
            count += counts[i];
            const double total = cost(sum, count) + right[i + 1];
            if (count > 0 && count < beams.size() && total < best.first) best = {total, i};
        }
        return best;
    }

    Hierarchy tree_;
    std::vector<Key> keys_;
};

}  // namespace

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

Hierarchy quadtree(const BeamSet& set, std::span<const std::uint32_t> beams,
                   std::span<const GridPatch> patches) {
    return QuadtreeBuilder(set, beams, patches).take();
}

Hierarchy binned_hierarchy(const BeamSet& set, std::span<const std::uint32_t> beams, float reach) {
    return BinnedBuilder(set, beams, reach).take();
}

}  // namespace caustics
