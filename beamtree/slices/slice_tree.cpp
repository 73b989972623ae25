#include "beamtree/slices/slice_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "beamtree/light/find_in_beam.h"
#include "beamtree/slices/beam_square.h"
#include "beamtree/slices/slice_build.h"
#include "beamtree/slices/slice_hierarchy.h"
#include "core/base/parallel.h"

namespace caustics::beamtree {
namespace {

constexpr float share_rounding = 1e-6F;  // more than a share is rounded by
// Groups of points that walk by turns.
constexpr std::size_t groups_together = 8;
constexpr std::size_t taken_together = 1024;  // beams or rays that threads take at a time

WalkSlices walk_for([[maybe_unused]] Isa isa) {
#ifdef CAUSTICS_X86_KERNELS
    // Eight floats are what a node has; both axes in one register of AVX-512 take a tenth longer.
    if (isa != Isa::plain) return walk_slices_avx2;
#endif
    return walk_slices_plain;
}

template <typename Do>
void for_each_ray(const SlicedBeams& from, const BeamNumber& number, const Do& act) {
    const BeamSet& set = from.sets[number.set];
    for (const std::uint32_t corner : set.beams[number.beam].corners)
        if (corner != Beam::none) act(corner);
}

// The slab from above all polygons to below all receivers, both a little beyond: heights are
// rounded.
SliceFrame frame_of(const SlicedBeams& from) {
    const Vec3d up = from.normal.cast<double>();
    double top = -std::numeric_limits<double>::infinity();
    for (const BeamNumber& number : from.beams)
        for_each_ray(from, number, [&](std::uint32_t ray) {
            for (const double place : from.sets[number.set].places())
                top = std::max(
                    top, up.dot(from.sets[number.set].ray(ray, place).position.cast<double>()));
        });
    double bottom = top;
    for (int i = 0; i < 8; ++i) {
        const auto corner = static_cast<Box::CornerType>(i);
        bottom = std::min(bottom, up.dot(from.receivers.corner(corner).cast<double>()));
    }
    const double beyond = 1e-3 * static_cast<double>(from.receivers.diagonal().norm());
    const BeamNumber& first = from.beams.front();
    const BeamSet& set = from.sets[first.set];
    const Vec3& origin = set.rays[set.beams[first.beam].corners[0]].position;
    return {from.normal, top + 1e-3 * beyond, bottom - beyond, origin};
}

/// The beams' rays on the planes.
class Slicer {
public:
    Slicer(const SlicedBeams& from, const SliceFrame& frame, int threads)
        : from_(from), frame_(frame), slices_(from.sets.size()), drifts_(from.sets.size()) {
        std::vector<std::vector<std::uint8_t>> asked(from.sets.size());
        for (const BeamNumber& number : from.beams) {
            std::vector<std::uint8_t>& of_set = asked[number.set];
            if (of_set.empty()) of_set.resize(from.sets[number.set].rays.size());
            for_each_ray(from, number, [&](std::uint32_t ray) { of_set[ray] = 1; });
        }
        for (std::size_t set = 0; set < asked.size(); ++set) {
            slices_[set].resize(asked[set].size());
            drifts_[set].resize(asked[set].size());
            parallel_chunks(threads, asked[set].size(), taken_together, [&](const Chunk& chunk) {
                for (std::size_t i = chunk.first; i < chunk.end; ++i)
                    if (asked[set][i] != 0)
                        slice(from.sets[set], static_cast<std::uint32_t>(i), slices_[set][i],
                              drifts_[set][i]);
            });
        }
    }

    SliceBox box(const BeamNumber& number) const {
        SliceBox box;
        const BeamSet& set = from_.sets[number.set];
        SliceReach bulge = {};
        if (set.has_roots())
            for (std::size_t i = 0; i < set.beams[number.beam].triangle_count(); ++i)
                bulge = widest(bulge, bulge_of(number, i));
        for_each_ray(from_, number, [&](std::uint32_t ray) {
            box.extend(slices_[number.set][ray],
                       set.has_roots() ? bulge : drifts_[number.set][ray]);
        });
        return box;
    }

    /// Writes those of one beam.
    void triangles(const BeamNumber& number, std::uint32_t place, SlicedTriangle* to) const {
        const BeamSet& set = from_.sets[number.set];
        const Beam& beam = set.beams[number.beam];
        for (std::size_t i = 0; i < beam.triangle_count(); ++i) {
            SlicedTriangle& triangle = to[i];
            const std::array<std::uint32_t, 3> corners = beam.triangle_corners(i);
            double highest = frame_.bottom();
            double lowest = frame_.top();
            for (std::size_t c = 0; c < 3; ++c) {
                triangle.corners[c] = slices_[number.set][corners[c]];
                triangle.drift = widest(triangle.drift, drifts_[number.set][corners[c]]);
                for (const double at : set.places()) {
                    const double height = frame_.height(set.ray(corners[c], at).position);
                    highest = std::max(highest, height);
                    lowest = std::min(lowest, height);
                }
            }
            if (set.has_roots(number.beam, i)) {
                triangle.bulge = bulge_of(number, i);
                for (const VertexRay& ray : set.middles_of(number.beam, i))
                    highest = std::max(highest,
                                       2 * frame_.height(ray.position) - std::min(highest, lowest));
            }
            triangle.begun_from = static_cast<float>(frame_.share(highest)) - share_rounding;
            triangle.whole_from = static_cast<float>(frame_.share(lowest)) + share_rounding;
            triangle.beam = place;
        }
    }

private:
    static SliceReach widest(const SliceReach& a, const SliceReach& b) {
        SliceReach reach;
        for (std::size_t i = 0; i < reach.size(); ++i) reach[i] = std::max(a[i], b[i]);
        return reach;
    }
    // A quadratic lies within 4/3 of what the middles of a triangle's edges are off their ends' means; what is not
    // quadratic has the rest.
    SliceReach bulge_of(const BeamNumber& number, std::size_t which) const {
        constexpr float over_middles = 1.4F;
        const BeamSet& set = from_.sets[number.set];
        const std::array<std::uint32_t, 3> corners = set.beams[number.beam].triangle_corners(which);
        const EdgeMiddles& middles = set.middles_of(number.beam, which);
        SliceReach bulge = {};
        if (!set.has_roots(number.beam, which)) return bulge;
        for (std::size_t i = 0; i < 3; ++i) {
            const RaySlices& a = slices_[number.set][corners[i]];
            const RaySlices& b = slices_[number.set][corners[(i + 1) % 3]];
            const RaySlices middle = frame_.slices(middles[i]);
            for (std::size_t k = 0; k < bulge.size(); ++k)
                bulge[k] =
                    std::max(bulge[k], over_middles * std::abs(middle[k] - (a[k] + b[k]) / 2));
        }
        return bulge;
    }
    // Of a ray that moves, the middle of its way and half of it.
    void slice(const BeamSet& set, std::uint32_t ray, RaySlices& middle, SliceReach& drift) const {
        if (!set.drifts()) {
            middle = frame_.slices(set.rays[ray]);
            return;
        }
        const RaySlices first = frame_.slices(set.ends[0][ray]);
        const RaySlices last = frame_.slices(set.ends[1][ray]);
        for (std::size_t i = 0; i < middle.size(); ++i) {
            middle[i] = (first[i] + last[i]) / 2;
            drift[i] = std::abs(last[i] - first[i]) / 2;
        }
    }

    const SlicedBeams& from_;
    const SliceFrame& frame_;
    std::vector<std::vector<RaySlices>> slices_;  ///< of the beams' rays
    std::vector<std::vector<SliceReach>> drifts_;
};

// Sorts the beams by the hierarchy.
Hierarchy split_beams(SlicedBeams& from, const Slicer& slicer, int threads) {
    std::vector<BoxedBeam> boxed(from.beams.size());
    std::size_t most_triangles = 1;
    for (const BeamNumber& number : from.beams)
        most_triangles =
            std::max(most_triangles, from.sets[number.set].beams[number.beam].triangle_count());
    parallel_chunks(threads, boxed.size(), taken_together, [&](const Chunk& chunk) {
        for (std::size_t i = chunk.first; i < chunk.end; ++i)
            boxed[i] = {slicer.box(from.beams[i]), static_cast<std::uint32_t>(i)};
    });
    Hierarchy tree =
        binned_slices(boxed, static_cast<std::uint32_t>(slice_width / most_triangles), threads);
    std::vector<BeamNumber> sorted;
    sorted.reserve(tree.order.size());
    for (const std::uint32_t place : tree.order) sorted.push_back(from.beams[place]);
    from.beams = std::move(sorted);
    return tree;
}

// Those of one beam side by side.
std::vector<SlicedTriangle> triangles_of(const SlicedBeams& from, const Slicer& slicer,
                                         int threads) {
    std::vector<std::size_t> first = {0};
    first.reserve(from.beams.size() + 1);
    for (const BeamNumber& number : from.beams)
        first.push_back(first.back() + from.sets[number.set].beams[number.beam].triangle_count());
    std::vector<SlicedTriangle> triangles(first.back());
    parallel_chunks(threads, from.beams.size(), taken_together, [&](const Chunk& chunk) {
        for (std::size_t i = chunk.first; i < chunk.end; ++i)
            slicer.triangles(from.beams[i], static_cast<std::uint32_t>(i),
                             triangles.data() + first[i]);
    });
    return triangles;
}

}  // namespace

SliceTree::SliceTree(SlicedBeams beams, Isa isa, int threads)
    : SliceTree(std::move(beams), nullptr, isa, threads) {}

SliceTree::SliceTree(SlicedBeams beams, const Hierarchy& hierarchy, Isa isa, int threads)
    : SliceTree(std::move(beams), &hierarchy, isa, threads) {}

SliceTree::SliceTree(SlicedBeams beams, const Hierarchy* given, Isa isa, int threads)
    : frame_(frame_of(beams)), plane_(Vec3::Zero(), beams.normal), walk_(walk_for(isa)) {
    const Slicer slicer(beams, frame_, threads);
    const Hierarchy hierarchy = given != nullptr ? *given : split_beams(beams, slicer, threads);
    SliceNodes made = widen(hierarchy, triangles_of(beams, slicer, threads), threads);
    nodes_ = std::move(made.nodes);
    leaves_ = std::move(made.leaves);
    root_ = made.root;
    height_ = made.height;
    leaf_width_ = made.leaf_width;
    travel_ = made.travel;
    has_bulges_ = made.has_bulges;
    beams_ = std::move(beams.beams);
    keep_corners(beams.sets);
}

void SliceTree::keep_corners(std::span<const BeamSet> sets) {
    const auto drifts = [&](const BeamNumber& number) { return sets[number.set].drifts(); };
    if (std::ranges::any_of(beams_, drifts)) return;
    const auto is_quad = [&](const BeamNumber& number) {
        return sets[number.set].beams[number.beam].triangle_count() == 2;
    };
    corner_count_ = std::ranges::any_of(beams_, is_quad) ? 4 : 3;
    corners_.reserve(corner_count_ * beams_.size());
    for (const BeamNumber& number : beams_)
        for (std::size_t i = 0; i < corner_count_; ++i) {
            const std::uint32_t corner = sets[number.set].beams[number.beam].corners[i];
            corners_.push_back(corner == Beam::none ? VertexRay{Vec3::Zero(), Vec3::Zero()}
                                                    : sets[number.set].rays[corner]);
        }
}

/// Points, and the squares that some are asked about in their place.
struct SliceTree::Asked {
    std::span<const ReceiverPoint> points;
    std::vector<std::optional<BeamSquare>> squares;  ///< none where no point has one

    explicit Asked(std::span<const ReceiverPoint> all) : points(all) {
        const auto has_cell = [](const ReceiverPoint& point) { return point.cell != nullptr; };
        if (std::ranges::none_of(points, has_cell)) return;
        squares.resize(points.size());
        for (std::size_t i = 0; i < points.size(); ++i)
            if (has_cell(points[i]))
                squares[i] = BeamSquare::at(points[i].position, *points[i].cell);
    }
    const BeamSquare* square(std::uint32_t point) const {
        return squares.empty() || !squares[point] ? nullptr : &*squares[point];
    }
};

/// Points near each other, each with its number among those that were asked about.
struct SliceTree::Group {
    static constexpr std::uint32_t room = 16;
    std::array<SlicePoint, room> points;
    std::array<std::uint32_t, room> number;
    std::uint32_t count = 0;
    /// x, y, share, and nothing.
    Eigen::Array4f low;
    Eigen::Array4f high;
    float reach[2];  ///< of the points that reach farthest
    float last_share;

    // Unless the box round the points would become too large.
    bool take(const SlicePoint& point, const Eigen::Array4f& largest) {
        const Eigen::Array4f at(point.at[0], point.at[1], point.share, 0);
        const Eigen::Array4f new_low = count == 0 ? at : low.min(at);
        const Eigen::Array4f new_high = count == 0 ? at : high.max(at);
        if (count == room || !(new_high - new_low <= largest).all()) return false;
        low = new_low;
        high = new_high;
        const auto widen = [this](float& most, float by) {
            most = count == 0 ? by : std::max(most, by);
        };
        widen(reach[0], point.reach[0]);
        widen(reach[1], point.reach[1]);
        widen(last_share, point.last_share);
        points[count++] = point;
        return true;
    }
};

// False for a point above all polygons.
bool SliceTree::place(const ReceiverPoint& point, SlicePoint& placed) const {
    const double height = frame_.height(point.position);
    const CellReach reach = point.cell == nullptr ? CellReach{} : reach_of(*point.cell, frame_);
    if (height - reach.down > frame_.top()) return false;
    if (height < frame_.bottom()) throw std::out_of_range("a receiver point below the slab");
    const Vec2d across = frame_.across(point.position.cast<double>());
    const auto share = static_cast<float>(frame_.share(std::min(height, frame_.top())));
    placed = {{static_cast<float>(across.x()), static_cast<float>(across.y())},
              share,
              {static_cast<float>(reach.across.x()), static_cast<float>(reach.across.y())},
              reach.down == 0 ? share : static_cast<float>(frame_.share(height - reach.down))};
    return true;
}

void SliceTree::find(std::span<const BeamSet> sets, std::span<const ReceiverPoint> points,
                     std::vector<std::uint32_t>& stack, std::span<std::vector<BeamHit>> hits,
                     SearchCounts& counts) const {
    // Half a leaf across, and no more down than rays move by that.
    const float reach = leaf_width_ / 2;
    const Eigen::Array4f largest(reach, reach, reach / std::max(travel_, reach), 1);
    const Asked asked(points);
    std::array<Group, groups_together> groups;
    std::size_t count = 0;  // of groups that have points
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        SlicePoint point;
        if (!place(points[i], point)) continue;
        if (count == 0 || !groups[count - 1].take(point, largest)) {
            if (count == groups.size()) {
                find(groups, asked, sets, stack, hits, counts);
                count = 0;
            }
            groups[count].count = 0;
            groups[count++].take(point, largest);
        }
        Group& group = groups[count - 1];
        group.number[group.count - 1] = i;
    }
    if (count > 0) find(std::span(groups).first(count), asked, sets, stack, hits, counts);
}

void SliceTree::find(std::span<const Group> groups, const Asked& asked,
                     std::span<const BeamSet> sets, std::vector<std::uint32_t>& stack,
                     std::span<std::vector<BeamHit>> hits, SearchCounts& counts) const {
    constexpr std::size_t found_room = 16 * Group::room;
    std::array<std::array<SliceCandidate, found_room>, groups_together> found;
    std::array<SliceWalk, groups_together> walks;
    const std::size_t room = 7 * height_ + 8;
    if (stack.size() < groups.size() * room) stack.resize(groups.size() * room);
    for (std::size_t i = 0; i < groups.size(); ++i) {
        const Group& group = groups[i];
        walks[i] = {group.points.data(),
                    group.count,
                    {group.low[0] - group.reach[0], group.low[1] - group.reach[1]},
                    {group.high[0] + group.reach[0], group.high[1] + group.reach[1]},
                    group.low[2],
                    group.last_share,
                    stack.data() + i * room,
                    1,
                    found[i].data(),
                    found_room,
                    0,
                    0};
        walks[i].stack[0] = root_;
    }
    const SliceView view{nodes_.data(), leaves_.data(),
                         reinterpret_cast<const char*>(corners_.data()),
                         corner_count_ * sizeof(VertexRay), has_bulges_};
    for (bool more = true; more;) {
        walk_(view, walks.data(), groups.size());
        more = false;
        for (std::size_t i = 0; i < groups.size(); ++i) {
            test(walks[i], groups[i], asked, sets, hits, counts);
            walks[i].found_count = 0;
            more = more || walks[i].stacked > 0;
        }
    }
    for (std::size_t i = 0; i < groups.size(); ++i) counts.cone_point_tests += walks[i].tests;
}

// Exactly, what a walk has found.
void SliceTree::test(const SliceWalk& walk, const Group& group, const Asked& asked,
                     std::span<const BeamSet> sets, std::span<std::vector<BeamHit>> hits,
                     SearchCounts& counts) const {
    TestPlane plane = plane_;
    SliceCandidate last{Group::room, 0};
    for (std::size_t i = 0; i < walk.found_count; ++i) {
        const SliceCandidate& candidate = walk.found[i];
        // The other triangle of four corners.
        if (candidate.point == last.point && candidate.beam == last.beam) continue;
        last = candidate;
        const BeamNumber& number = beams_[candidate.beam];
        const BeamSet& set = sets[number.set];
        const std::uint32_t point = group.number[candidate.point];
        plane.move_to(asked.points[point].position);
        std::vector<BeamHit>& found_here = hits[point];
        if (corner_count_ == 0) {
            find_in_beam(set, number, plane, found_here, counts);
            continue;
        }
        const VertexRay* const corner = corners_.data() + candidate.beam * corner_count_;
        std::array<const VertexRay*, 4> rays = {corner, corner + 1, corner + 2, nullptr};
        if (corner_count_ == 4 && !corner[3].direction.isZero(0)) rays[3] = corner + 3;
        if (const BeamSquare* const square = asked.square(point))
            find_on_square(set, rays, number, plane, *square, found_here, counts);
        else
            find_in_beam(set, rays, number, plane, found_here, counts);
    }
}

std::uint64_t SliceTree::bytes() const {
    return beams_.size() * sizeof(BeamNumber) + corners_.size() * sizeof(VertexRay) +
           nodes_.size() * sizeof(SliceNode) + leaves_.size() * sizeof(SliceLeaf);
}

}  // namespace caustics::beamtree
