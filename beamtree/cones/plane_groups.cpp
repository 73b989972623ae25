#include "beamtree/cones/plane_groups.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "beamtree/cones/cap.h"

namespace caustics::beamtree {
namespace {

constexpr float good_sine = 0.5F;

// Of the six: +x, -x, +y, ...
Vec3 axis_of(std::size_t i) {
    return (i % 2 == 0 ? 1.0F : -1.0F) * Vec3::Unit(static_cast<Eigen::Index>(i / 2));
}

// Of a ray at all wavelengths of its set.
float least_along(const BeamSet& set, std::uint32_t ray, const Vec3& axis) {
    float least = 1;
    for (const double place : set.places())
        least = std::min(least, set.ray(ray, place).direction.dot(axis));
    return least;
}

// The rays of edges' middles included.
float least_along(const BeamSet& set, std::uint32_t number, const Beam& beam, const Vec3& axis) {
    float least = 1;
    for (const std::uint32_t corner : beam.corners)
        if (corner != Beam::none) least = std::min(least, least_along(set, corner, axis));
    if (!set.has_roots()) return least;
    for (std::size_t i = 0; i < beam.triangle_count(); ++i)
        for (const VertexRay& ray : set.middles_of(number, i))
            if (set.has_roots(number, i)) least = std::min(least, ray.direction.dot(axis));
    return least;
}

// True where all rays of the set, and of edges' middles, run along the axis at this cosine at least.
bool all_run_along(const BeamSet& set, const Vec3& axis, float least) {
    for (std::uint32_t ray = 0; ray < set.rays.size(); ++ray)
        if (least_along(set, ray, axis) < least) return false;
    return std::ranges::all_of(set.middles, [&](const EdgeMiddles& middles) {
        return std::ranges::all_of(middles, [&](const VertexRay& ray) {
            return ray.direction.isZero(0) || ray.direction.dot(axis) >= least;
        });
    });
}

// What a beam prefers. Scenes are often symmetric about the axes and the planes between them, and so are their meshes: if beams
// changed their planes there, the common edge of two would be asked about on two planes, and points just on it would be met
// by none or by both.
constexpr std::array<float, 3> preference = {1, 1.07F, 1.15F};

// The axis of the six that the beam runs along best.
std::size_t main_axis(const BeamSet& set, std::uint32_t number) {
    std::size_t best = 6;
    float best_score = 0;
    for (std::size_t i = 0; i < 6; ++i) {
        const float least = least_along(set, number, set.beams[number], axis_of(i));
        const float score = preference[i / 2] * least;
        if (least < least_sine || score <= best_score) continue;
        best_score = score;
        best = i;
    }
    return best;
}

}  // namespace

std::vector<PlaneGroup> receiver_planes(const BeamSet& set) {
    PlaneGroup all;
    all.beams.resize(set.beams.size());
    std::iota(all.beams.begin(), all.beams.end(), 0U);
    return {all};
}

std::vector<PlaneGroup> fixed_planes(const BeamSet& set) {
    // Most receivers lie across an axis: then both leaf tests are on the same plane.
    for (std::size_t i = 0; i < 6; ++i) {
        if (!all_run_along(set, axis_of(i), good_sine)) continue;
        std::vector<PlaneGroup> one = receiver_planes(set);
        one[0].normal = -axis_of(i);
        return one;
    }
    std::vector<Vec3d> directions;
    for (std::uint32_t ray = 0; ray < set.rays.size(); ++ray)
        for (const double place : set.places())
            directions.emplace_back(set.ray(ray, place).direction.cast<double>());
    for (const EdgeMiddles& middles : set.middles)
        for (const VertexRay& ray : middles)
            if (!ray.direction.isZero(0)) directions.emplace_back(ray.direction.cast<double>());
    const Cap cap = smallest_cap(directions);
    if (cap.cosine > static_cast<double>(least_sine) + 1e-6) {
        std::vector<PlaneGroup> one = receiver_planes(set);
        one[0].normal = Vec3d(-cap.axis).cast<float>();
        return one;
    }
    std::vector<PlaneGroup> groups(7);
    for (std::size_t i = 0; i < 6; ++i) groups[i].normal = -axis_of(i);
    for (std::uint32_t i = 0; i < set.beams.size(); ++i)
        groups[main_axis(set, i)].beams.push_back(i);
    std::erase_if(groups, [](const PlaneGroup& group) { return group.beams.empty(); });
    return groups;
}

}  // namespace caustics::beamtree
