#include "beamtree/beams/binned_hierarchy.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "core/base/interrupt.h"

namespace caustics::beamtree {
namespace {

using Key = Eigen::Matrix<float, 6, 1>;
using KeyBox = Eigen::AlignedBox<float, 6>;

class BinnedBuilder {
public:
    BinnedBuilder(const BeamSet& set, std::span<const std::uint32_t> beams, float reach) {
        const auto [least, most] = std::minmax_element(beams.begin(), beams.end());
        first_beam_ = *least;
        keys_.resize(*most - *least + 1);
        for (const std::uint32_t i : beams) {
            const auto corners = set.triangle(set.beams[i], 0);
            Key key = Key::Zero();
            for (const VertexRay* ray : corners) {
                key.head<3>() += ray->position / 3;
                key.tail<3>() += reach / 3 * ray->direction;
            }
            keys_[i - first_beam_] = key;
        }
        tree_.order.assign(beams.begin(), beams.end());
        tree_.nodes.push_back({0, static_cast<std::uint32_t>(beams.size()), 0, 0});
        // Not by recursion: a chain of one beam a level must not end the stack.
        for (std::uint32_t node = 0; node < tree_.nodes.size(); ++node) split(node);
    }

    Hierarchy take() { return std::move(tree_); }

private:
    static constexpr std::size_t bins = 16;

    const Key& key_of(std::uint32_t beam) const { return keys_[beam - first_beam_]; }

    void split(std::uint32_t node) {
        throw_if_interrupted();
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
        for (const std::uint32_t beam : beams) box.extend(key_of(beam));
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
        const float share = (key_of(beam)[axis] - box.min()[axis]) / box.sizes()[axis];
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
            boxes[bin].extend(key_of(beam));
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
    std::uint32_t first_beam_ = 0;
    std::vector<Key> keys_;  ///< of the beams from first_beam_ on
};

}  // namespace

Hierarchy binned_hierarchy(const BeamSet& set, std::span<const std::uint32_t> beams, float reach) {
    return BinnedBuilder(set, beams, reach).take();
}

}  // namespace caustics::beamtree
