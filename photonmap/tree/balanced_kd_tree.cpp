#include "photonmap/tree/balanced_kd_tree.h"

#include <memory>

#include "photonmap/tree/kd_search.h"
#include "photonmap/tree/select_photons.h"
#include "photonmap/tree/split_ranges.h"

namespace caustics::photonmap {

namespace {

constexpr std::uint16_t placed_flag = 0x8000U;

/// Splits the photons at their root: returns its left subtree, and leaves the right one.
std::span<Photon> take_left(std::span<Photon>& photons, const TreeKernels& kernels) {
    const unsigned axis = widest_axis(photons, kernels);
    const std::size_t middle = left_size(photons.size());
    select_photon(photons, middle, axis);
    set_axis(photons[middle], axis);
    const std::span<Photon> left = photons.first(middle);
    photons = photons.subspan(middle + 1);
    return left;
}

/// Orders the photons as an in-order walk of their tree meets them.
void order_subtree(std::span<Photon> photons, const TreeKernels& kernels, OrderScratch& scratch) {
    while (photons.size() > small_range)
        order_subtree(take_left(photons, kernels), kernels, scratch);
    kernels.order_small(bytes_of(photons), photons.size(), scratch);
}

/// A cycle of the permutation that takes photons in order to their places in the heap, from one of its
/// places on. Its links jump through memory, but depend on no photon: those far ahead are asked for early.
class Cycle {
public:
    Cycle(std::span<Photon> photons, std::size_t start)
        : photons_(photons), start_(start), ahead_(start) {
        for (int link = 0; link < links_ahead; ++link) fetch();
    }

    /// Moves every photon of the cycle, and marks its new place.
    void move() {
        const Photon first = photons_[start_];
        for (std::size_t place = start_;;) {
            fetch();
            const std::size_t source = source_of(place);
            photons_[place] = source == start_ ? first : photons_[source];
            photons_[place].flags |= placed_flag;
            if (source == start_) return;
            place = source;
        }
    }

private:
    static constexpr int links_ahead = 12;

    std::size_t source_of(std::size_t place) const {
        return in_order_rank(place + 1, photons_.size());
    }
    void fetch() {
        const std::size_t next = source_of(ahead_);
        if (next == start_) return;
        ahead_ = next;
        __builtin_prefetch(&photons_[ahead_], 1);
    }

    std::span<Photon> photons_;
    std::size_t start_;
    std::size_t ahead_;
};

/// Moves every photon from its place in order to its place in the heap; a bit of the flags marks the places
/// that are done.
void move_to_heap(std::span<Photon> photons) {
    for (std::size_t start = 0; start < photons.size(); ++start)
        if ((photons[start].flags & placed_flag) == 0) Cycle(photons, start).move();
    for (Photon& photon : photons) photon.flags &= static_cast<std::uint16_t>(~placed_flag);
}

/// The heap's nodes are numbered from 1.
struct Heap {
    std::span<const Photon> photons;

    static std::uint64_t root() { return 1; }
    bool exists(std::uint64_t node) const { return node <= photons.size(); }
    const Photon& photon(std::uint64_t node) const { return photons[node - 1]; }
    static std::uint32_t index(std::uint64_t node) { return static_cast<std::uint32_t>(node - 1); }
    static std::uint64_t child(std::uint64_t node, bool right) {
        return 2 * node + (right ? 1 : 0);
    }
};

}  // namespace

void balance(std::span<Photon> photons, Isa isa, int threads) {
    if (photons.empty()) return;
    const TreeKernels& kernels = tree_kernels(isa);
    split_on_threads(
        photons, photons.size(), threads,
        [&](std::span<Photon>& part) { return take_left(part, kernels); },
        [&](std::span<Photon> part) {
            const auto scratch = std::make_unique<OrderScratch>();
            order_subtree(part, kernels, *scratch);
        });
    move_to_heap(photons);
}

BalancedKdTree::BalancedKdTree(PhotonStore photons, Isa isa, int threads)
    : KdTreeBase(tree_kernels(isa), ArrivalDirections(photons.photons(), threads)),
      photons_(std::move(photons)) {
    balance(photons_.photons(), isa, threads);
}

void BalancedKdTree::find(const NearestQuery& query, GatherScratch& scratch) const {
    find_nearest(Heap{photons_.photons()}, kernels_, query, scratch);
}

void BalancedKdTree::copy_out(const Candidates& found, const CopiedPhotons& to) const {
    const std::span<const Photon> photons = photons_.photons();
    for (std::size_t i = 0; i < found.count; ++i) copy_photon(photons[found.index[i]], i, to);
}

std::uint64_t BalancedKdTree::code_of(std::uint32_t photon) const {
    return code(photons_.photons()[photon]);
}

}  // namespace caustics::photonmap
