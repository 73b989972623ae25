#include "beamtree/slices/slice_hierarchy.h"

#include <algorithm>
#include <array>
#include <limits>

namespace caustics::beamtree {
namespace {

constexpr int bins = 16;

/// What falls into a bin, along each of the four coordinates.
struct Bin {
    SliceBox box;
    std::uint32_t count = 0;
};
using Bins = std::array<std::array<Bin, bins>, 4>;

/// Where the beams of a node are parted.
struct Split {
    float cost = std::numeric_limits<float>::infinity();
    int axis = -1;
    int last_bin = 0;  ///< of the first half
};

/// Which bins the centres of boxes belong to.
class Binning {
public:
    explicit Binning(std::span<const BoxedBeam> beams) {
        Eigen::Array4f most = Eigen::Array4f::Constant(-std::numeric_limits<float>::infinity());
        for (const BoxedBeam& beam : beams) {
            const Eigen::Array4f key = beam.box.key();
            least_ = least_.min(key);
            most = most.max(key);
        }
        const Eigen::Array4f size = most - least_;
        // Slightly less than all bins, so that the last centre falls into the last one.
        scale_ = (size > 1e-30F).select(0.99999F * bins / size, 0);
    }
    bool splits(int axis) const { return scale_[axis] > 0; }
    Eigen::Array4i of(const SliceBox& box) const {
        return ((box.key() - least_) * scale_).cast<int>();
    }

private:
    Eigen::Array4f least_ = Eigen::Array4f::Constant(std::numeric_limits<float>::infinity());
    Eigen::Array4f scale_;
};

// The best border between the bins of one axis, if it beats the best so far.
void improve(const std::array<Bin, bins>& along, int axis, Split& best) {
    std::array<float, bins> behind{};
    SliceBox box;
    std::uint32_t count = 0;
    for (std::size_t i = bins; i-- > 1;) {
        box.extend(along[i].box);
        count += along[i].count;
        behind[i] = count == 0 ? 0 : static_cast<float>(count) * box.area();
    }
    const std::uint32_t all = count + along[0].count;
    box = {};
    count = 0;
    for (std::size_t i = 0; i + 1 < bins; ++i) {
        if (along[i].count == 0) continue;
        box.extend(along[i].box);
        count += along[i].count;
        if (count == all) return;
        const float cost = static_cast<float>(count) * box.area() + behind[i + 1];
        if (cost < best.cost) best = {cost, axis, static_cast<int>(i)};
    }
}

// Sorts the beams into two parts and returns the number in the first.
std::size_t part(std::span<BoxedBeam> beams) {
    const Binning binning(beams);
    Bins all;
    for (const BoxedBeam& beam : beams) {
        const Eigen::Array4i bin = binning.of(beam.box);
        for (std::size_t axis = 0; axis < 4; ++axis) {
            Bin& into = all[axis][static_cast<std::size_t>(bin[static_cast<Eigen::Index>(axis)])];
            into.box.extend(beam.box);
            ++into.count;
        }
    }
    Split best;
    for (int axis = 0; axis < 4; ++axis)
        if (binning.splits(axis)) improve(all[static_cast<std::size_t>(axis)], axis, best);
    if (best.axis < 0) return beams.size() / 2;  // all at one place
    const auto middle = std::partition(beams.begin(), beams.end(), [&](const BoxedBeam& beam) {
        return binning.of(beam.box)[best.axis] <= best.last_bin;
    });
    return static_cast<std::size_t>(middle - beams.begin());
}

}  // namespace

Hierarchy binned_slices(std::span<BoxedBeam> beams, std::uint32_t leaf_size) {
    Hierarchy tree;
    tree.nodes.push_back({0, static_cast<std::uint32_t>(beams.size()), 0, 0});
    for (std::uint32_t i = 0; i < tree.nodes.size(); ++i) {
        const std::uint32_t first = tree.nodes[i].first_beam;
        const std::uint32_t count = tree.nodes[i].beam_count;
        if (count <= leaf_size) continue;
        const auto left = static_cast<std::uint32_t>(part(beams.subspan(first, count)));
        tree.nodes[i].first_child = static_cast<std::uint32_t>(tree.nodes.size());
        tree.nodes[i].child_count = 2;
        tree.nodes.push_back({first, left, 0, 0});
        tree.nodes.push_back({first + left, count - left, 0, 0});
    }
    for (const BoxedBeam& beam : beams) tree.order.push_back(beam.beam);
    return tree;
}

}  // namespace caustics::beamtree
