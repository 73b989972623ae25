#include "photonmap/tree/packed_kd_tree.h"

#include <bit>

#include "photonmap/kernels/left_balanced.h"
#include "photonmap/tree/select_photons.h"
#include "photonmap/tree/split_ranges.h"

namespace caustics::photonmap {

namespace {

/// Splits the range at a plane: returns its left side, and leaves the right one.
BucketRange take_left(BucketRange& range, const TreeKernels& kernels) {
    const std::span<Photon> photons(reinterpret_cast<Photon*>(range.photons), range.count);
    const unsigned axis = widest_axis(photons, kernels);
    const std::uint64_t on_left = left_leaves(range.leaves);
    const std::size_t middle = on_left * bucket_photons;
    select_photon(photons, middle, axis);
    // Now, because the photon moves on when its side is split.
    range.planes[range.node] =
        (std::bit_cast<std::uint32_t>(photons[middle].position[axis]) & ~3U) | axis;
    BucketRange left = range;
    left.count = middle;
    left.node = 2 * range.node;
    left.leaves = on_left;
    range.photons += middle * sizeof(Photon);
    range.count -= middle;
    range.node = 2 * range.node + 1;
    range.leaves -= on_left;
    return left;
}

/// Splits the range down to what the kernels order.
void fill_buckets(BucketRange range, const TreeKernels& kernels, OrderScratch& scratch) {
    while (range.count > small_range) fill_buckets(take_left(range, kernels), kernels, scratch);
    kernels.fill_buckets(range, scratch);
}

}  // namespace

PackedKdTree::PackedKdTree(PhotonStore photons, Isa isa, int threads)
    : KdTreeBase(tree_kernels(isa), ArrivalDirections(photons.photons(), threads)),
      photons_(std::move(photons)),
      planes_(std::make_unique<std::uint32_t[]>(std::max<std::size_t>(1, bucket_count()))) {
    order(threads);
}

void PackedKdTree::order(int threads) {
    const std::size_t buckets = bucket_count();
    if (buckets == 0) return;
    static_assert(PhotonStore::block_photons % bucket_photons == 0,
                  "buckets fill the store's blocks");
    unsigned char* const memory = bytes_of(photons_.photons());
    split_on_threads(
        BucketRange{memory, photons_.size(), 1, buckets, planes_.get()}, photons_.size(), threads,
        [&](BucketRange& range) { return take_left(range, kernels_); },
        [&](const BucketRange& range) {
            const auto scratch = std::make_unique<OrderScratch>();
            fill_buckets(range, kernels_, *scratch);
        });
    view_ = {memory, planes_.get(), buckets};
}

std::uint64_t PackedKdTree::bytes() const {
    return bucket_count() * (bucket_bytes + sizeof(std::uint32_t));
}

void PackedKdTree::find(const NearestQuery& query, GatherScratch& scratch) const {
    kernels_.find_packed(view_, query, scratch.found.candidates());
}

void PackedKdTree::copy_out(const Candidates& found, const CopiedPhotons& to) const {
    // Addresses by value: no photon that is stored could change those.
    const unsigned char* const buckets = view_.buckets;
    const Candidates all = found;
    const CopiedPhotons copies = to;
    for (std::size_t i = 0; i < all.count; ++i) {
        const unsigned char* const x = buckets + all.index[i] / bucket_photons * bucket_bytes +
                                       4 * (all.index[i] % bucket_photons);
        std::memcpy(copies.energy + i, x + 12 * bucket_photons, 4);
        std::memcpy(copies.direction + i,
                    x + 16 * bucket_photons - 2 * (all.index[i] % bucket_photons), 2);
        if (copies.flags != nullptr)
            std::memcpy(copies.flags + i,
                        x + 18 * bucket_photons - 2 * (all.index[i] % bucket_photons), 2);
        if (copies.position[0] == nullptr) continue;
        for (std::size_t axis = 0; axis < 3; ++axis)
            std::memcpy(copies.position[axis] + i, x + 4 * axis * bucket_photons, 4);
    }
}

Photon PackedKdTree::photon(std::size_t index) const {
    const unsigned char* const x =
        view_.buckets + index / bucket_photons * bucket_bytes + 4 * (index % bucket_photons);
    const unsigned char* const direction = x + 16 * bucket_photons - 2 * (index % bucket_photons);
    Photon photon;
    for (std::size_t axis = 0; axis < 3; ++axis)
        std::memcpy(photon.position + axis, x + 4 * axis * bucket_photons, 4);
    std::memcpy(&photon.energy, x + 12 * bucket_photons, 4);
    std::memcpy(&photon.theta, direction, 2);
    std::memcpy(&photon.flags, direction + 2 * bucket_photons, 2);
    set_axis(photon, 0);
    return photon;
}

std::uint64_t PackedKdTree::code_of(std::uint32_t photon) const {
    std::uint32_t energy = 0;
    std::uint16_t direction = 0;
    const Candidates one{nullptr, &photon, 1, 1};
    copy_out(one, {&energy, &direction, {nullptr, nullptr, nullptr}, nullptr});
    return code(energy, direction);
}

}  // namespace caustics::photonmap
