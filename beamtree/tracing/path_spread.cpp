#include "beamtree/tracing/path_spread.h"

#include <algorithm>
#include <array>

#include "beamtree/beams/ray_spread.h"
#include "core/base/parallel.h"

namespace caustics::beamtree {
namespace {

// Corners whose rays part by less (half a degree), at the light and behind the last event, tell as much of the light
// between them by their area.
constexpr float narrow_cosine = 0.999962F;
// How far from a corner the points beside it lie, over the longest side of its beam.
constexpr double inwards = 1.0 / 32;
// The second point's distance from the line of corner and first point, over that: the largest that goes the beam's
// way. Parts of a polygon may be slivers, and what neighbours them goes the same way on one side at least.
constexpr std::array<double, 4> to_a_side = {1, -1, 0.25, -0.25};
// What threads take at a time.
constexpr std::size_t rays_of_a_chunk = 256;

/// A ray as a corner of a beam's triangle, first of `rays`.
struct BeamCornerRay {
    std::uint32_t beam = Beam::none;
    std::array<std::uint32_t, 3> rays;
};

bool is_narrow(const Vec3& a, const Vec3& b, const Vec3& c) {
    return a.dot(b) > narrow_cosine && b.dot(c) > narrow_cosine && c.dot(a) > narrow_cosine;
}

bool is_narrow(const TracedSet& traced, const std::array<std::uint32_t, 3>& rays) {
    const auto from_light = [&](std::uint32_t ray) {
        return to_light(traced.set.light, traced.origins[ray].position);
    };
    const auto onwards = [&](std::uint32_t ray) { return traced.set.rays[ray].direction; };
    const auto& [a, b, c] = rays;
    return is_narrow(from_light(a), from_light(b), from_light(c)) &&
           is_narrow(onwards(a), onwards(b), onwards(c));
}

// Of each ray without a spread the first kept beam that it is a corner of, unless all of them are narrow.
std::vector<BeamCornerRay> corners_of(const TracedSet& traced, const std::vector<bool>& kept) {
    const BeamSet& set = traced.set;
    std::vector<BeamCornerRay> corners(set.rays.size());
    for (std::uint32_t beam = 0; beam < set.beams.size(); ++beam) {
        if (!kept[beam]) continue;
        for (std::size_t which = 0; which < set.beams[beam].triangle_count(); ++which) {
            std::array<std::uint32_t, 3> rays = set.beams[beam].triangle_corners(which);
            const auto known = [&](std::uint32_t ray) { return set.spreads[ray].is_known(); };
            if (std::ranges::all_of(rays, known) || is_narrow(traced, rays)) continue;
            for (std::size_t i = 0; i < 3; ++i) {
                BeamCornerRay& corner = corners[rays[0]];
                if (corner.beam == Beam::none && !known(rays[0])) corner = {beam, rays};
                std::rotate(rays.begin(), rays.begin() + 1, rays.end());
            }
        }
    }
    return corners;
}

// From the corner into the beam, as far as the points beside it lie.
Vec3d way_in(const std::array<const RayOrigin*, 3>& origins) {
    std::array<Vec3d, 3> at;
    for (std::size_t i = 0; i < 3; ++i) at[i] = origins[i]->position.cast<double>();
    const double longest =
        std::max({(at[1] - at[0]).norm(), (at[2] - at[1]).norm(), (at[0] - at[2]).norm()});
    return inwards * longest * ((at[1] + at[2]) / 2 - at[0]).normalized();
}

class SpreadAlongPaths {
public:
    SpreadAlongPaths(const Path& path, const VertexRay& ray, const RayOrigin& origin)
        : path_(path), ray_(ray), origin_(origin) {}

    // Whether the light beside the ray goes the same way.
    bool move(std::size_t which, const Vec3d& by) {
        RayOrigin beside = origin_;
        beside.position += by.cast<float>();
        const PathPoint point = path_.from(beside, true);
        if (!point.alive) return false;
        by_.surface[which] = (beside.position - origin_.position).cast<double>();
        by_.place[which] = (point.ray.position - ray_.position).cast<double>();
        by_.direction[which] = (point.ray.direction - ray_.direction).cast<double>();
        return true;
    }
    RaySpread spread(const LightSample& light) const {
        return spread_of(ray_, origin_, light, by_);
    }

private:
    const Path& path_;
    const VertexRay& ray_;
    const RayOrigin& origin_;
    RayDerivatives by_;
};

RaySpread spread_along(const Scene& scene, const LitCaster& surface, const Level& level,
                       const BeamCornerRay& corner) {
    const BeamSet& set = level.traced.set;
    std::array<const RayOrigin*, 3> origins;
    for (std::size_t i = 0; i < 3; ++i) origins[i] = &level.traced.origins[corner.rays[i]];
    if (!is_flat_between(origins[0]->normal, origins[1]->normal) ||
        !is_flat_between(origins[0]->normal, origins[2]->normal))
        return {};
    const Path path(scene, surface, level, corner.beam);
    const Vec3d along = way_in(origins);
    const Vec3d across = origins[0]->normal.cast<double>().cross(along);
    SpreadAlongPaths found(path, set.rays[corner.rays[0]], *origins[0]);
    if (!found.move(0, along)) return {};
    for (const double side : to_a_side)
        if (found.move(1, along + side * across)) return found.spread(set.light);
    return {};
}

}  // namespace

void spread_along_paths(const Scene& scene, const LitCaster& surface, Level& level,
                        const std::vector<bool>& kept, int threads) {
    const std::vector<BeamCornerRay> corners = corners_of(level.traced, kept);
    parallel_chunks(threads, corners.size(), rays_of_a_chunk, [&](const Chunk& chunk) {
        for (std::size_t ray = chunk.first; ray < chunk.end; ++ray)
            if (corners[ray].beam != Beam::none)
                level.traced.set.spreads[ray] = spread_along(scene, surface, level, corners[ray]);
    });
}

}  // namespace caustics::beamtree
