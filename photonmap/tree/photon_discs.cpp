#include "photonmap/tree/photon_discs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "photonmap/kernels/left_balanced.h"

namespace caustics::photonmap {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
/// Boxes are wider than the discs in them by more than rounding takes off.
constexpr float box_rounding = 1.00001F;
/// Cells whose sides are closer to parallel have no area to average over.
constexpr double least_cell_sine = 1e-3;

/// Leaves those that count at the test's point, in their order; returns their number.
std::size_t keep_counted(const SideTest& side, const CoveringPhotons& photons, std::size_t count) {
    const CopiedPhotons& copies = photons.copies;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (!counts_at(side, copies.direction[i] & 0xFFU, copies.direction[i] >> 8U,
                       copies.flags[i]))
            continue;
        photons.squared_distance[kept] = photons.squared_distance[i];
        photons.radius[kept] = photons.radius[i];
        copies.energy[kept] = copies.energy[i];
        copies.direction[kept] = copies.direction[i];
        for (float* const position : copies.position) position[kept] = position[i];
        ++kept;
    }
    return kept;
}

}  // namespace

PhotonDiscs::PhotonDiscs(std::unique_ptr<const PackedKdTree> tree, const DiscWidths& widths,
                         float cell_reach, const RunOptions& options)
    : tree_(std::move(tree)),
      radius_(photon_widths(*tree_, widths, options)),
      cell_reach_(cell_reach) {
    bound_discs();
}

std::uint64_t PhotonDiscs::bytes() const {
    return tree_->bytes() + bucket_count() * bucket_photons * sizeof(float) +
           bounds_.size() * sizeof(Bounds);
}

void PhotonDiscs::bound_discs() {
    const std::size_t buckets = bucket_count();
    bounds_.resize(2 * buckets);
    for (std::size_t node = bounds_.size(); node-- > 1;) {
        Bounds& all = bounds_[node];
        if (node >= buckets) {
            all = bounds_of(leaf_number(node, buckets));
            continue;
        }
        all = bounds_[2 * node];
        const Bounds& other = bounds_[2 * node + 1];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            all.low[axis] = std::min(all.low[axis], other.low[axis]);
            all.high[axis] = std::max(all.high[axis], other.high[axis]);
        }
    }
}

PhotonDiscs::Bounds PhotonDiscs::bounds_of(std::size_t bucket) const {
    Bounds bounds{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    const std::size_t first = bucket * bucket_photons;
    const std::size_t end = std::min(first + bucket_photons, tree_->size());
    for (std::size_t i = first; i < end; ++i) {
        const Photon photon = tree_->photon(i);
        const float reach = box_rounding * std::max(1.0F, cell_reach_) * radius_.data()[i];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float x = photon.position[axis];
            // Far from the origin x + reach may be rounded by more than the disc is wide.
            const float rounding = 2e-7F * std::abs(x);
            bounds.low[axis] = std::min(bounds.low[axis], x - reach - rounding);
            bounds.high[axis] = std::max(bounds.high[axis], x + reach + rounding);
        }
    }
    return bounds;
}

/// Writes the buckets that have a disc near the point or cell; returns their number.
std::size_t PhotonDiscs::buckets_near(const ReceiverPoint& point, const PixelCell* cell,
                                      std::uint32_t* buckets) const {
    const std::size_t count = bucket_count();
    if (count == 0) return 0;
    Bounds asked;
    std::copy_n(point.position.data(), 3, asked.low);
    std::copy_n(point.position.data(), 3, asked.high);
    if (cell != nullptr)
        for (std::size_t corner = 0; corner < 4; ++corner) {
            const Vec3 at = point.position + cell->corner(corner).cast<float>();
            for (std::size_t axis = 0; axis < 3; ++axis) {
                asked.low[axis] = std::min(asked.low[axis], at[static_cast<Eigen::Index>(axis)]);
                asked.high[axis] = std::max(asked.high[axis], at[static_cast<Eigen::Index>(axis)]);
            }
        }
    const auto overlaps = [&asked](const Bounds& box) {
        return asked.low[0] <= box.high[0] && asked.high[0] >= box.low[0] &&
               asked.low[1] <= box.high[1] && asked.high[1] >= box.low[1] &&
               asked.low[2] <= box.high[2] && asked.high[2] >= box.low[2];
    };
    std::array<std::size_t, 64> pending;
    std::size_t pending_count = 0, found = 0;
    pending[pending_count++] = 1;
    while (pending_count > 0) {
        const std::size_t node = pending[--pending_count];
        if (!overlaps(bounds_[node])) continue;
        if (node >= count) {
            buckets[found++] = static_cast<std::uint32_t>(leaf_number(node, count));
        } else {
            pending[pending_count++] = 2 * node + 1;
            pending[pending_count++] = 2 * node;
        }
    }
    return found;
}

GatheredPhotons PhotonDiscs::covering(const ReceiverPoint& point, GatherScratch& scratch) const {
    const PixelCell* const cell =
        cell_reach_ > 0 && point.cell != nullptr && point.cell->sides().sine > least_cell_sine
            ? point.cell
            : nullptr;
    scratch.buckets.reserve(bucket_count());
    const std::size_t near = buckets_near(point, cell, scratch.buckets.data());
    const std::size_t room = near * bucket_photons;
    scratch.reserve(room, true);
    scratch.radius.reserve(room + widest_register);
    const bool certain = tree_->directions_.all_count(point.geometric_normal);
    const CoveringPhotons found{scratch.found.candidates().squared_distance, scratch.radius.data(),
                                scratch.copies.copied(true, !certain)};
    DiscQuery query{{}, 1, 0};
    std::copy_n(point.position.data(), 3, query.point);
    if (cell != nullptr) {
        query.widening = cell_reach_;
        query.margin = static_cast<float>(cell->radius);
    }
    std::size_t count = tree_->kernels_.find_covering({tree_->view_, radius_.data()}, query,
                                                      scratch.buckets.data(), near, found);
    if (!certain) {
        const SideTest side = side_test(point.geometric_normal);
        if (!all_count(side, found.copies, count)) count = keep_counted(side, found, count);
    }
    const CopiedPhotons& copies = found.copies;
    return {.squared_distance = found.squared_distance,
            .energy = copies.energy,
            .direction = copies.direction,
            .count = count,
            .position = {copies.position[0], copies.position[1], copies.position[2]},
            .radius = found.radius,
            .cell = cell};
}

void PhotonDiscs::gather(std::span<const ReceiverPoint> points, const GatherLimits&,
                         GatherScratch& scratch, const Consumer& consume) const {
    for (std::size_t i = 0; i < points.size(); ++i) {
        ++scratch.single_queries;
        consume(i, covering(points[i], scratch));
    }
}

}  // namespace caustics::photonmap
