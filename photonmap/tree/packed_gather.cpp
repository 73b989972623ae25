#include "photonmap/tree/packed_gather.h"

#include <algorithm>
#include <numeric>

namespace caustics::photonmap {

namespace {

/// A group's diagonal over the distance of the N-th photon. Wider groups collect too many photons that
/// most members do not need.
constexpr float widest_group = 1;
constexpr std::size_t smallest_group = 4;
constexpr std::size_t largest_group = 64;

std::size_t room_for_group(std::size_t nearest, std::size_t photons) {
    return std::min(8 * nearest, photons) + 2'048;
}

}  // namespace

PackedGather::PackedGather(const PackedKdTree& tree, const PackedKdTree::Batch& batch)
    : tree_(tree), batch_(batch) {
    tree.begin(batch_);
    last_distance_ = batch_.max_radius;
    batch.scratch.order.resize(batch.points.size());
    std::iota(batch.scratch.order.begin(), batch.scratch.order.end(), 0U);
}

void PackedGather::run() { answer(batch_.scratch.order); }

void PackedGather::answer(Group group) {
    if (group.size() < smallest_group) return answer_one_by_one(group);
    Box box;
    for (const std::uint32_t i : group) box.extend(batch_.points[i].position);
    const float diagonal = box.diagonal().norm();
    if (diagonal <= widest_group * (last_distance_ + batch_.margin) &&
        group.size() <= largest_group && answer_together(group, box))
        return;
    if (!(diagonal > 0)) return answer_one_by_one(group);
    Vec3::Index axis = 0;
    box.sizes().maxCoeff(&axis);
    const float middle = box.center()[axis];
    const auto right = std::partition(group.begin(), group.end(), [&](std::uint32_t i) {
        return batch_.points[i].position[axis] <= middle;
    });
    const auto left_count = static_cast<std::size_t>(right - group.begin());
    if (left_count == 0 || left_count == group.size()) return answer_one_by_one(group);
    answer(group.first(left_count));
    answer(group.subspan(left_count));
}

void PackedGather::answer_one_by_one(Group group) {
    for (const std::uint32_t i : group) {
        tree_.answer(batch_, i);
        last_distance_ = batch_.bound.known() ? batch_.bound.distance() : batch_.max_radius;
    }
}

bool PackedGather::answer_together(Group group, const Box& box) {
    const Vec3 centre = box.center();
    float radius = 0;
    for (const std::uint32_t i : group)
        radius = std::max(radius, (batch_.points[i].position - centre).norm());
    const Vec3& normal = batch_.points[group.front()].geometric_normal;
    certain_ = all_certain(group);
    tested_ = batch_.bound.met_foreign();
    if (!tested_) {
        if (!collect(centre, normal, radius, nullptr)) return false;
        tested_ = !certain_ && !all_count_at(group);
    }
    if (tested_) {
        batch_.bound.meet_foreign();
        const bool same = std::ranges::all_of(
            group, [&](std::uint32_t i) { return batch_.points[i].geometric_normal == normal; });
        const SideTest side = side_test(normal);
        if (!same || !collect(centre, normal, radius, &side)) return false;
    }
    for (const std::uint32_t i : group) answer_member(i, centre);
    return true;
}

/// Copies the photons of all members; those that do not pass `side`, when there is one, are left out.
/// False when there are too many.
bool PackedGather::collect(const Vec3& centre, const Vec3& normal, float radius,
                           const SideTest* side) {
    NearestQuery query = batch_.query_at(centre);
    query.max_squared_distance =
        batch_.bound.at(centre, normal, side != nullptr, query.max_squared_distance);
    query.margin = 2.00001F * (radius + 0.5F * batch_.margin) + 1e-30F;
    query.side = side;
    Candidates& collected =
        batch_.scratch.group_found.reserve(room_for_group(query.nearest, tree_.size()));
    const float nearest2 = tree_.kernels_.find_packed(tree_.view_, query, collected);
    if (nearest2 < 0) {
        // The photons are denser here than where the distance comes from.
        last_distance_ /= 4;
        return false;
    }
    centre_distance_ = std::sqrt(nearest2);
    copy_for_group(collected);
    return true;
}

/// Whether something holds for the normal of each member; equal ones in a row are asked once.
template <typename Holds>
bool PackedGather::holds_for_normals(Group group, const Holds& holds) const {
    const Vec3* last = nullptr;
    return std::ranges::all_of(group, [&](std::uint32_t i) {
        const Vec3& normal = batch_.points[i].geometric_normal;
        if (last != nullptr && *last == normal) return true;
        last = &normal;
        return holds(normal);
    });
}

/// Whether the whole map's photons count at each member.
bool PackedGather::all_certain(Group group) const {
    return holds_for_normals(
        group, [&](const Vec3& normal) { return tree_.directions_.all_count(normal); });
}

/// Whether all collected photons count at each member.
bool PackedGather::all_count_at(Group group) const {
    return holds_for_normals(group, [&](const Vec3& normal) {
        return all_count(side_test(normal), columns_, column_count_);
    });
}

void PackedGather::copy_for_group(const Candidates& collected) {
    column_count_ = collected.count;
    batch_.scratch.group_copies.reserve(column_count_, true);
    columns_ = batch_.scratch.group_copies.copied(true, !certain_);
    tree_.copy_out(collected, columns_);
    // A member's candidates may be all of them.
    batch_.scratch.reserve(column_count_, batch_.limits.positions);
}

void PackedGather::answer_member(std::uint32_t i, const Vec3& centre) {
    const ReceiverPoint& point = batch_.points[i];
    const Vec3& normal = point.geometric_normal;
    NearestQuery query = batch_.query_at(point.position);
    query.max_squared_distance =
        std::min(batch_.bound.at(point.position, normal, tested_, query.max_squared_distance),
                 reached(centre_distance_ + (point.position - centre).norm()));
    Candidates& found = batch_.scratch.found.candidates();
    const CopiedPhotons copied = batch_.scratch.copies.copied(batch_.limits.positions);
    if (batch_.margin > 0) widen(query, found);
    if (!tree_.kernels_.find_in_columns(columns_, column_count_, query, found, copied))
        choose_among_ties(query.nearest, found, copied);
    ++batch_.scratch.grouped_queries;
    const GatheredPhotons answer = tree_.gathered(batch_, found, copied);
    PackedKdTree::renew_bound(batch_, i, answer);
    last_distance_ = answer.full ? batch_.bound.distance() : batch_.max_radius;
    batch_.consume(i, answer);
}

/// Makes the query one for all up to the margin beyond the N-th.
void PackedGather::widen(NearestQuery& query, Candidates& found) {
    const bool enough = batch_.limits.nearest <= tree_.size();
    batch_.nth = enough ? tree_.kernels_.nth_in_columns(columns_, column_count_, query,
                                                        found.squared_distance)
                        : -1;
    query.nearest = GatherLimits::all;
    query.max_squared_distance = batch_.reach();
}

void PackedGather::choose_among_ties(std::size_t nearest, Candidates& found,
                                     const CopiedPhotons& to) const {
    PackedKdTree::keep_smallest_codes(found, nearest, [this](std::uint32_t place) {
        return PackedKdTree::code(columns_.energy[place], columns_.direction[place]);
    });
    for (std::size_t k = 0; k < found.count; ++k) {
        to.energy[k] = columns_.energy[found.index[k]];
        to.direction[k] = columns_.direction[found.index[k]];
        if (to.position[0] == nullptr) continue;
        for (std::size_t axis = 0; axis < 3; ++axis)
            to.position[axis][k] = columns_.position[axis][found.index[k]];
    }
}

void PackedKdTree::gather(std::span<const ReceiverPoint> points, const GatherLimits& limits,
                          GatherScratch& scratch, const Consumer& consume) const {
    PackedGather(*this, {points, limits, scratch, consume}).run();
}

}  // namespace caustics::photonmap
