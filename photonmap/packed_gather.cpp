#include "photonmap/packed_gather.h"

#include <algorithm>
#include <numeric>

namespace caustics {

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

PackedGather::PackedGather(const PackedKdTree& tree, std::span<const ReceiverPoint> points,
                           const GatherLimits& limits, GatherScratch& scratch,
                           const PhotonTree::Consumer& consume)
    : tree_(tree),
      points_(points),
      limits_(limits),
      scratch_(scratch),
      consume_(consume),
      last_distance_(limits.max_radius) {
    tree.make_room(limits, scratch);
    scratch.order.resize(points.size());
    std::iota(scratch.order.begin(), scratch.order.end(), 0U);
}

void PackedGather::run() { answer(scratch_.order); }

void PackedGather::answer(Group group) {
    if (group.size() < smallest_group) return answer_one_by_one(group);
    Box box;
    for (const std::uint32_t i : group) box.extend(points_[i].position);
    const float diagonal = box.diagonal().norm();
    if (diagonal <= widest_group * last_distance_ && group.size() <= largest_group &&
        answer_together(group, box))
        return;
    if (!(diagonal > 0)) return answer_one_by_one(group);
    Vec3::Index axis = 0;
    box.sizes().maxCoeff(&axis);
    const float middle = box.center()[axis];
    const auto right = std::partition(group.begin(), group.end(), [&](std::uint32_t i) {
        return points_[i].position[axis] <= middle;
    });
    const auto left_count = static_cast<std::size_t>(right - group.begin());
    if (left_count == 0 || left_count == group.size()) return answer_one_by_one(group);
    answer(group.first(left_count));
    answer(group.subspan(left_count));
}

void PackedGather::answer_one_by_one(Group group) {
    for (const std::uint32_t i : group) {
        tree_.answer(points_, i, limits_, bound_, scratch_, consume_);
        last_distance_ = bound_.known() ? bound_.distance() : limits_.max_radius;
    }
}

/// Whether one set of photons serves all: none is to be left out, or all leave out the same.
bool PackedGather::may_share(Group group, bool& tested) const {
    const Vec3& normal = points_[group.front()].geometric_normal;
    const bool same = std::ranges::all_of(
        group, [&](std::uint32_t i) { return points_[i].geometric_normal == normal; });
    tested = !tree_.directions_.all_in_front(normal);
    if (same) return true;
    return std::ranges::all_of(group, [&](std::uint32_t i) {
        return tree_.directions_.all_in_front(points_[i].geometric_normal);
    });
}

bool PackedGather::answer_together(Group group, const Box& box) {
    if (!may_share(group, tested_)) return false;
    const Vec3 centre = box.center();
    float radius = 0;
    for (const std::uint32_t i : group)
        radius = std::max(radius, (points_[i].position - centre).norm());
    const Vec3& normal = points_[group.front()].geometric_normal;
    const SideTest side = side_test(normal);
    NearestQuery query = tree_.query_at(centre, limits_);
    query.max_squared_distance = bound_.at(centre, normal, tested_, query.max_squared_distance);
    query.margin = 2.00001F * radius + 1e-30F;
    query.side = tested_ ? &side : nullptr;
    Candidates& collected =
        scratch_.group_found.reserve(room_for_group(query.nearest, tree_.size()));
    const float nearest2 = tree_.kernels_.find_packed(tree_.view_, query, collected);
    if (nearest2 < 0) {
        // The photons are denser here than where the distance comes from.
        last_distance_ /= 4;
        return false;
    }
    columns_ = columns(collected.count);
    tree_.kernels_.copy_columns(tree_.view_, collected, columns_);
    const float distance = std::sqrt(nearest2);
    for (const std::uint32_t i : group) answer_member(i, centre, distance);
    return true;
}

PhotonColumns PackedGather::columns(std::size_t count) {
    constexpr std::size_t widest_register = 16;
    const std::size_t room = count + widest_register;
    for (auto& column : scratch_.column) column.reserve(room);
    scratch_.column_energy.reserve(room);
    scratch_.column_direction.reserve(room);
    scratch_.reserve(room, limits_.positions);
    return {{scratch_.column[0].data(), scratch_.column[1].data(), scratch_.column[2].data()},
            scratch_.column_energy.data(),
            scratch_.column_direction.data(),
            count};
}

void PackedGather::answer_member(std::uint32_t i, const Vec3& centre, float centre_distance) {
    const ReceiverPoint& point = points_[i];
    const Vec3& normal = point.geometric_normal;
    NearestQuery query = tree_.query_at(point.position, limits_);
    query.max_squared_distance =
        std::min(bound_.at(point.position, normal, tested_, query.max_squared_distance),
                 NeighbourBound::reached(centre_distance + (point.position - centre).norm()));
    Candidates& found = scratch_.found.candidates();
    const CopiedPhotons copied = scratch_.copied(limits_.positions);
    if (!tree_.kernels_.find_in_columns(columns_, query, found, copied))
        choose_among_ties(query.nearest, found, copied);
    ++scratch_.grouped_queries;
    const GatheredPhotons answer = tree_.gathered(found, copied);
    if (answer.count == limits_.nearest) {
        bound_.set(point.position, normal, tested_, answer.squared_distance[answer.farthest]);
        last_distance_ = bound_.distance();
    } else {
        bound_.forget();
        last_distance_ = limits_.max_radius;
    }
    consume_(i, answer);
}

void PackedGather::choose_among_ties(std::size_t nearest, Candidates& found,
                                     const CopiedPhotons& to) const {
    const auto direction_of = [this](std::uint32_t place) {
        return static_cast<std::uint16_t>(columns_.direction[place]);
    };
    PackedKdTree::keep_smallest_codes(found, nearest, [&](std::uint32_t place) {
        return PackedKdTree::code(columns_.energy[place], direction_of(place));
    });
    for (std::size_t k = 0; k < found.count; ++k) {
        to.energy[k] = columns_.energy[found.index[k]];
        to.direction[k] = direction_of(found.index[k]);
        if (to.position[0] == nullptr) continue;
        for (std::size_t axis = 0; axis < 3; ++axis)
            to.position[axis][k] = columns_.position[axis][found.index[k]];
    }
}

void PackedKdTree::gather(std::span<const ReceiverPoint> points, const GatherLimits& limits,
                          GatherScratch& scratch, const Consumer& consume) const {
    PackedGather(*this, points, limits, scratch, consume).run();
}

}  // namespace caustics
