#include "beamtree/slices/slice_hierarchy.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <vector>

#include "core/base/interrupt.h"
#include "core/base/parallel.h"

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

/// Between which keys boxes are.
struct KeyRange {
    Eigen::Array4f least = Eigen::Array4f::Constant(std::numeric_limits<float>::infinity());
    Eigen::Array4f most = -least;

    void extend(std::span<const BoxedBeam> beams) {
        for (const BoxedBeam& beam : beams) {
            const Eigen::Array4f key = beam.box.key();
            least = least.min(key);
            most = most.max(key);
        }
    }
    void extend(const KeyRange& other) {
        least = least.min(other.least);
        most = most.max(other.most);
    }
};

/// Which bins the centres of boxes belong to.
class Binning {
public:
    explicit Binning(const KeyRange& range) : least_(range.least) {
        const Eigen::Array4f size = range.most - range.least;
        // Slightly less than all bins, so that the last centre falls into the last one.
        scale_ = (size > 1e-30F).select(0.99999F * bins / size, 0);
    }
    bool splits(int axis) const { return scale_[axis] > 0; }
    Eigen::Array4i of(const SliceBox& box) const {
        return ((box.key() - least_) * scale_).cast<int>();
    }

private:
    Eigen::Array4f least_;
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

Bins binned(std::span<const BoxedBeam> beams, const Binning& binning) {
    Bins all;
    for (const BoxedBeam& beam : beams) {
        const Eigen::Array4i bin = binning.of(beam.box);
        for (std::size_t axis = 0; axis < 4; ++axis) {
            Bin& into = all[axis][static_cast<std::size_t>(bin[static_cast<Eigen::Index>(axis)])];
            into.box.extend(beam.box);
            ++into.count;
        }
    }
    return all;
}

void merge(Bins& into, const Bins& from) {
    for (std::size_t axis = 0; axis < 4; ++axis)
        for (std::size_t i = 0; i < bins; ++i) {
            into[axis][i].box.extend(from[axis][i].box);
            into[axis][i].count += from[axis][i].count;
        }
}

Split best_split(const Bins& all, const Binning& binning) {
    Split best;
    for (int axis = 0; axis < 4; ++axis)
        if (binning.splits(axis)) improve(all[static_cast<std::size_t>(axis)], axis, best);
    return best;
}

// Sorts the beams into two parts and returns the number in the first.
std::size_t part(std::span<BoxedBeam> beams) {
    KeyRange range;
    range.extend(beams);
    const Binning binning(range);
    const Split best = best_split(binned(beams, binning), binning);
    if (best.axis < 0) return beams.size() / 2;  // all at one place
    const auto middle = std::partition(beams.begin(), beams.end(), [&](const BoxedBeam& beam) {
        return binning.of(beam.box)[best.axis] <= best.last_bin;
    });
    return static_cast<std::size_t>(middle - beams.begin());
}

// Nodes with more beams are parted on all threads, which take so many at a time; others each by one thread.
constexpr std::size_t own_branch_size = 8192;
constexpr std::size_t parted_together = 2048;

/// Parts nodes of many beams.
class WideParting {
public:
    WideParting(std::size_t most_beams, int threads) : threads_(threads), parted_(most_beams) {}

    // As part(), but that beams keep their order.
    std::size_t part(std::span<BoxedBeam> beams) {
        const std::size_t chunks = chunk_count(beams.size(), parted_together);
        std::vector<KeyRange> ranges(chunks);
        each(beams, [&](std::size_t i, std::span<BoxedBeam> some) { ranges[i].extend(some); });
        KeyRange range;
        for (const KeyRange& one : ranges) range.extend(one);
        const Binning binning(range);
        std::vector<Bins> all(chunks);
        each(beams,
             [&](std::size_t i, std::span<BoxedBeam> some) { all[i] = binned(some, binning); });
        Bins sum = all[0];
        for (std::size_t i = 1; i < chunks; ++i) merge(sum, all[i]);
        const Split best = best_split(sum, binning);
        if (best.axis < 0) return beams.size() / 2;  // all at one place
        const std::size_t left = first_half(sum, best);
        std::vector<std::size_t> lefts;
        for (const Bins& one : all) lefts.push_back(first_half(one, best));
        move(beams, lefts, left, [&](const BoxedBeam& beam) {
            return binning.of(beam.box)[best.axis] <= best.last_bin;
        });
        return left;
    }

private:
    static std::size_t first_half(const Bins& all, const Split& split) {
        std::size_t count = 0;
        for (int i = 0; i <= split.last_bin; ++i)
            count += all[static_cast<std::size_t>(split.axis)][static_cast<std::size_t>(i)].count;
        return count;
    }

    template <typename Do>
    void each(std::span<BoxedBeam> beams, const Do& act) const {
        parallel_chunks(threads_, beams.size(), parted_together, [&](const Chunk& chunk) {
            act(chunk.index, beams.subspan(chunk.first, chunk.end - chunk.first));
        });
    }

    // `lefts`: of each chunk, those in the first half, which are `left` in all.
    template <typename IsLeft>
    void move(std::span<BoxedBeam> beams, const std::vector<std::size_t>& lefts, std::size_t left,
              const IsLeft& is_left) {
        std::vector<std::size_t> before(lefts.size(), 0);
        std::partial_sum(lefts.begin(), lefts.end() - 1, before.begin() + 1);
        each(beams, [&](std::size_t i, std::span<BoxedBeam> some) {
            std::size_t to_left = before[i];
            std::size_t to_right = left + i * parted_together - before[i];
            for (const BoxedBeam& beam : some)
                parted_[is_left(beam) ? to_left++ : to_right++] = beam;
        });
        each(beams, [&](std::size_t i, std::span<BoxedBeam> some) {
            std::copy_n(parted_.begin() + static_cast<std::ptrdiff_t>(i * parted_together),
                        some.size(), some.begin());
        });
    }

    int threads_;
    std::vector<BoxedBeam> parted_;
};

// Splits nodes with more than `most` beams, from the first node on.
template <typename Part>
void split(std::vector<Hierarchy::Node>& nodes, std::span<BoxedBeam> beams, std::size_t most,
           const Part& part_of) {
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const std::uint32_t first = nodes[i].first_beam;
        const std::uint32_t count = nodes[i].beam_count;
        if (count <= most) continue;
        throw_if_interrupted();
        const auto left = static_cast<std::uint32_t>(part_of(beams.subspan(first, count)));
        nodes[i].first_child = static_cast<std::uint32_t>(nodes.size());
        nodes[i].child_count = 2;
        nodes.push_back({first, left, 0, 0});
        nodes.push_back({first + left, count - left, 0, 0});
    }
}

// Puts a branch in the place of its root.
void graft(std::vector<Hierarchy::Node>& nodes, std::size_t root,
           std::vector<Hierarchy::Node> branch) {
    const auto shift = static_cast<std::uint32_t>(nodes.size()) - 1;
    for (Hierarchy::Node& node : branch)
        if (node.child_count > 0) node.first_child += shift;
    nodes[root] = branch.front();
    nodes.insert(nodes.end(), branch.begin() + 1, branch.end());
}

}  // namespace

Hierarchy binned_slices(std::span<BoxedBeam> beams, std::uint32_t leaf_size, int threads) {
    Hierarchy tree;
    tree.nodes.push_back({0, static_cast<std::uint32_t>(beams.size()), 0, 0});
    const std::size_t most = std::max<std::size_t>(own_branch_size, leaf_size);
    if (beams.size() > most) {
        WideParting wide(beams.size(), threads);
        split(tree.nodes, beams, most, [&](std::span<BoxedBeam> some) { return wide.part(some); });
    }
    std::vector<std::size_t> roots;
    for (std::size_t i = 0; i < tree.nodes.size(); ++i)
        if (tree.nodes[i].child_count == 0) roots.push_back(i);
    std::vector<std::vector<Hierarchy::Node>> branches(roots.size());
    parallel_chunks(threads, roots.size(), 1, [&](const Chunk& chunk) {
        std::vector<Hierarchy::Node>& branch = branches[chunk.index];
        branch = {tree.nodes[roots[chunk.index]]};
        split(branch, beams, leaf_size, [](std::span<BoxedBeam> some) { return part(some); });
    });
    for (std::size_t i = 0; i < roots.size(); ++i)
        graft(tree.nodes, roots[i], std::move(branches[i]));
    for (const BoxedBeam& beam : beams) tree.order.push_back(beam.beam);
    return tree;
}

}  // namespace caustics::beamtree
