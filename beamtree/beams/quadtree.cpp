#include "beamtree/beams/quadtree.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

#include "beamtree/beams/binned_hierarchy.h"
#include "core/base/interrupt.h"

namespace caustics::beamtree {
namespace {

/// A rectangle of cells.
struct Cells {
    const GridPatch* patch;
    std::uint32_t column0, column1, row0, row1;
};

class QuadtreeBuilder {
public:
    QuadtreeBuilder(const BeamSet& set, std::span<const std::uint32_t> beams,
                    std::span<const GridPatch> patches)
        : set_(set), beams_(beams.begin(), beams.end()) {
        std::stable_sort(beams_.begin(), beams_.end(), [&](std::uint32_t a, std::uint32_t b) {
            return set.beams[a].triangle < set.beams[b].triangle;
        });
        count_triangles(patches);
        tree_.nodes.resize(1);
        std::vector<Cells> cells;
        for (const GridPatch& patch : patches)
            cells.push_back({&patch, 0, patch.columns, 0, patch.rows});
        const std::vector<std::uint32_t> others = outside(patches);
        if (others.empty()) {
            fill(0, cells);
        } else if (others.size() == beams_.size()) {
            graft(0, others);
        } else {
            const std::uint32_t first = add_children(0, 2);
            fill(first, cells);
            graft(first + 1, others);
            cover(0, 0);
        }
    }

    Hierarchy take() { return std::move(tree_); }

private:
    // Which beams are of which triangle: any number of them may be.
    void count_triangles(std::span<const GridPatch> patches) {
        std::uint32_t triangles = 0;
        for (const GridPatch& patch : patches) triangles = std::max(triangles, end_of(patch));
        for (const std::uint32_t beam : beams_)
            triangles = std::max(triangles, set_.beams[beam].triangle + 1);
        begin_of_.assign(triangles + 1, 0);
        for (const std::uint32_t beam : beams_) ++begin_of_[set_.beams[beam].triangle + 1];
        std::partial_sum(begin_of_.begin(), begin_of_.end(), begin_of_.begin());
    }

    static std::uint32_t end_of(const GridPatch& patch) {
        return patch.first_triangle + patch.columns * patch.rows * patch.cell_triangles;
    }

    // Beams of triangles that no patch has.
    std::vector<std::uint32_t> outside(std::span<const GridPatch> patches) const {
        std::vector<std::uint32_t> others;
        std::ranges::copy_if(beams_, std::back_inserter(others), [&](std::uint32_t beam) {
            const std::uint32_t triangle = set_.beams[beam].triangle;
            return std::ranges::none_of(patches, [triangle](const GridPatch& patch) {
                return triangle >= patch.first_triangle && triangle < end_of(patch);
            });
        });
        return others;
    }

    // Makes a node of what the parts hold: its children are those parts that hold beams.
    void fill(std::uint32_t node, std::vector<Cells> parts) {
        throw_if_interrupted();
        std::erase_if(parts, [&](const Cells& cells) { return !any_beam(cells); });
        if (parts.empty()) return;
        if (parts.size() == 1) {
            const Cells& only = parts.front();
            if (only.column1 - only.column0 == 1 && only.row1 - only.row0 == 1)
                graft(node, beams_in(only, only.row0));
            else
                fill(node, quarters(only));
            return;
        }
        const std::uint32_t first = add_children(node, parts.size());
        const auto begin = static_cast<std::uint32_t>(tree_.order.size());
        for (std::uint32_t i = 0; i < parts.size(); ++i) fill(first + i, {parts[i]});
        cover(node, begin);
    }

    // Makes a node of beams that no grid orders: its children, where they are few, else a binary
    // tree by their places.
    void graft(std::uint32_t node, std::span<const std::uint32_t> beams) {
        const auto begin = static_cast<std::uint32_t>(tree_.order.size());
        tree_.order.insert(tree_.order.end(), beams.begin(), beams.end());
        cover(node, begin);
        if (beams.size() == 1) return;
        if (beams.size() <= 4) {
            const std::uint32_t first = add_children(node, beams.size());
            for (std::uint32_t i = 0; i < beams.size(); ++i)
                tree_.nodes[first + i] = {begin + i, 1, 0, 0};
            return;
        }
        const Hierarchy branch = binned_hierarchy(set_, beams, 0);
        std::ranges::copy(branch.order, tree_.order.begin() + begin);
        const auto first = static_cast<std::uint32_t>(tree_.nodes.size());
        tree_.nodes.insert(tree_.nodes.end(), branch.nodes.begin() + 1, branch.nodes.end());
        for (std::uint32_t i = 0; i < branch.nodes.size(); ++i) {
            Hierarchy::Node& grafted = tree_.nodes[i == 0 ? node : first + i - 1];
            grafted = branch.nodes[i];
            grafted.first_beam += begin;
            if (grafted.child_count > 0) grafted.first_child += first - 1;
        }
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

    // Of the cells of one row.
    std::span<const std::uint32_t> beams_in(const Cells& c, std::uint32_t row) const {
        const auto triangle = [&](std::uint32_t column) {
            return c.patch->first_triangle +
                   (row * c.patch->columns + column) * c.patch->cell_triangles;
        };
        const std::uint32_t begin = begin_of_[triangle(c.column0)];
        return std::span(beams_).subspan(begin, begin_of_[triangle(c.column1)] - begin);
    }

    bool any_beam(const Cells& c) const {
        for (std::uint32_t row = c.row0; row < c.row1; ++row)
            if (!beams_in(c, row).empty()) return true;
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
    }

    const BeamSet& set_;
    std::vector<std::uint32_t> beams_;  ///< by ascending triangle
    std::vector<std::uint32_t>
        begin_of_;  ///< a triangle's first among them; the next one's is its end
    Hierarchy tree_;
};

}  // namespace

Hierarchy quadtree(const BeamSet& set, std::span<const std::uint32_t> beams,
                   std::span<const GridPatch> patches) {
    return QuadtreeBuilder(set, beams, patches).take();
}

}  // namespace caustics::beamtree
