#include "beamtree/beams/ray_spread.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <Eigen/Cholesky>
#include <optional>
#include <vector>

#include "beamtree/beams/pieces.h"
#include "core/base/parallel.h"
#include "core/math/frame.h"

namespace caustics::beamtree {
namespace {

// Below this share of the largest, a pivot says that the vertices round one do not tell its derivatives.
constexpr double least_pivot = 1e-5;
constexpr std::size_t fewest_neighbours = 5;
// What threads take at a time.
constexpr std::size_t together = 512;

using Matrix5 = Eigen::Matrix<double, 5, 5>;
// Of the first surface's height, the ray's place and its direction, by (u, v).
using Matrix57 = Eigen::Matrix<double, 5, 7>;

class SpreadFit {
public:
    SpreadFit(const BeamSet& set, std::span<const RayOrigin> origins,
              const MeshNeighbours& neighbours, int threads)
        : set_(set),
          origins_(origins),
          neighbours_(neighbours),
          ray_of_(neighbours.vertex_count(), Beam::none),
          group_(origins.size()) {
        join(threads);
    }

    /// Of a ray; `around` is scratch.
    RaySpread spread(std::uint32_t ray, std::vector<std::uint32_t>& around) const {
        const RayOrigin& origin = origins_[ray];
        if (origin.vertex == RayOrigin::no_vertex) return {};
        const Frame frame(origin.normal);
        around.clear();
        add_round(origin.vertex, ray, around);
        if (around.size() > fewest_neighbours)
            if (const auto found = fit(ray, frame, around))
                return spread_of(set_.rays[ray], origin, set_.light, *found);
        const std::size_t inner = around.size();
        for (std::size_t i = 0; i < inner; ++i) add_round(origins_[around[i]].vertex, ray, around);
        if (around.size() >= fewest_neighbours)
            if (const auto found = fit(ray, frame, around))
                return spread_of(set_.rays[ray], origin, set_.light, *found);
        return {};
    }

private:
    // Rays that whole beams join have gone the same way, over no crease.
    void join(int threads) {
        Pieces groups(origins_.size());
        parallel_chunks(threads, set_.beams.size(), together, [&](const Chunk& chunk) {
            for (std::size_t i = chunk.first; i < chunk.end; ++i)
                for (const std::uint32_t corner : set_.beams[i].corners)
                    if (corner != Beam::none) groups.join(corner, set_.beams[i].corners[0]);
        });
        parallel_chunks(threads, origins_.size(), together, [&](const Chunk& chunk) {
            for (auto ray = static_cast<std::uint32_t>(chunk.first); ray < chunk.end; ++ray) {
                group_[ray] = groups.find(ray);
                // Rays of one set that start at one vertex are one.
                const std::uint32_t vertex = origins_[ray].vertex;
                if (vertex != RayOrigin::no_vertex) ray_of_[vertex] = ray;
            }
        });
    }

    // Rays beside a vertex that have gone the same way as `ray`.
    void add_round(std::uint32_t vertex, std::uint32_t ray,
                   std::vector<std::uint32_t>& around) const {
        for (const std::uint32_t other : neighbours_.round(vertex)) {
            const std::uint32_t found = ray_of_[other];
            if (found == Beam::none || found == ray || group_[found] != group_[ray]) continue;
            if (std::find(around.begin(), around.end(), found) == around.end())
                around.push_back(found);
        }
    }

    // By least squares through the ray's own values.
    std::optional<RayDerivatives> fit(std::uint32_t ray, const Frame& frame,
                                      std::span<const std::uint32_t> around) const {
        const Vec3& centre = origins_[ray].position;
        float reach = 0;
        for (const std::uint32_t other : around)
            reach = std::max(reach, (origins_[other].position - centre).norm());
        if (!(reach > 0)) return {};
        Matrix5 left = Matrix5::Zero();
        Matrix57 right = Matrix57::Zero();
        for (const std::uint32_t other : around) {
            const Vec3d away =
                (origins_[other].position - centre).cast<double>() / static_cast<double>(reach);
            const double u = away.dot(frame.s.cast<double>());
            const double v = away.dot(frame.t.cast<double>());
            Eigen::Matrix<double, 5, 1> terms;
            terms << u, v, u * u, u * v, v * v;
            Eigen::Matrix<double, 1, 7> values;
            values[0] = away.dot(frame.n.cast<double>()) * static_cast<double>(reach);
            values.segment<3>(1) =
                (set_.rays[other].position - set_.rays[ray].position).cast<double>();
            values.segment<3>(4) =
                (set_.rays[other].direction - set_.rays[ray].direction).cast<double>();
            left += terms * terms.transpose();
            right += terms * values;
        }
        const Eigen::LDLT<Matrix5> solver(left);
        const auto pivots = solver.vectorD();
        if (!(pivots.minCoeff() > least_pivot * pivots.maxCoeff())) return {};
        const Matrix57 found = solver.solve(right) / static_cast<double>(reach);
        const Vec3d s = frame.s.cast<double>(), t = frame.t.cast<double>(),
                    n = frame.n.cast<double>();
        return RayDerivatives{
            {s + found(0, 0) * n, t + found(1, 0) * n},
            {found.block<1, 3>(0, 1).transpose(), found.block<1, 3>(1, 1).transpose()},
            {found.block<1, 3>(0, 4).transpose(), found.block<1, 3>(1, 4).transpose()}};
    }

    const BeamSet& set_;
    std::span<const RayOrigin> origins_;
    const MeshNeighbours& neighbours_;
    std::vector<std::uint32_t> ray_of_;  ///< one a vertex
    std::vector<std::uint32_t> group_;   ///< one a ray: the same for all of a group
};

bool is_whole(const Beam& beam, std::span<const RayOrigin> origins) {
    return beam.triangle_count() == 1 &&
           std::all_of(beam.corners.begin(), beam.corners.begin() + 3, [&](std::uint32_t ray) {
               return origins[ray].vertex != RayOrigin::no_vertex;
           });
}

std::vector<std::uint32_t> find_partners(const BeamSet& set, std::span<const RayOrigin> origins,
                                         const MeshNeighbours& neighbours, int threads) {
    std::vector<std::uint8_t> whole(set.beams.size());
    parallel_chunks(threads, whole.size(), together, [&](const Chunk& chunk) {
        for (std::size_t i = chunk.first; i < chunk.end; ++i)
            whole[i] = is_whole(set.beams[i], origins) ? 1 : 0;
    });
    std::vector<std::uint32_t> beam_of(neighbours.triangle_count(), Beam::none);
    for (std::uint32_t i = 0; i < set.beams.size(); ++i)
        if (whole[i] != 0) beam_of[set.beams[i].triangle] = i;
    std::vector<std::uint32_t> partners(set.beams.size(), Beam::none);
    parallel_chunks(threads, partners.size(), together, [&](const Chunk& chunk) {
        for (std::size_t i = chunk.first; i < chunk.end; ++i) {
            if (whole[i] == 0) continue;
            const std::uint32_t triangle = neighbours.partner(set.beams[i].triangle);
            if (triangle != MeshNeighbours::none) partners[i] = beam_of[triangle];
        }
    });
    return partners;
}

// One a ray: whether one of its beams is kept.
std::vector<std::uint8_t> rays_of(const BeamSet& set, const std::vector<bool>& kept, int threads) {
    std::vector<std::uint8_t> rays(set.rays.size());
    parallel_chunks(threads, set.beams.size(), together, [&](const Chunk& chunk) {
        for (std::size_t i = chunk.first; i < chunk.end; ++i)
            for (const std::uint32_t corner : set.beams[i].corners)
                if (kept[i] && corner != Beam::none)
                    std::atomic_ref(rays[corner]).store(1, std::memory_order_relaxed);
    });
    return rays;
}

}  // namespace

// Areas for a square of the two ways: across the ray at any distance, and across the light at the first surface,
// times the strength that is left.
RaySpread spread_of(const VertexRay& ray, const RayOrigin& origin, const LightSample& light,
                    const RayDerivatives& by) {
    const Vec3d w = to_light(light, origin.position).cast<double>();
    double flux = std::abs(by.surface[0].cross(by.surface[1]).dot(w)) *
                  static_cast<double>(origin.weight.mean());
    if (light.kind != LightSample::Kind::directional)
        flux /= (light.position - origin.position).cast<double>().squaredNorm();
    const Vec3d d = ray.direction.cast<double>();
    const double constant = d.dot(by.place[0].cross(by.place[1]));
    const double linear =
        d.dot(by.place[0].cross(by.direction[1]) + by.direction[0].cross(by.place[1]));
    const double quadratic = d.dot(by.direction[0].cross(by.direction[1]));
    const double scale = (constant < 0 ? -1 : 1) / flux;
    const RaySpread found{static_cast<float>(constant * scale), static_cast<float>(linear * scale),
                          static_cast<float>(quadratic * scale)};
    const bool finite = std::isfinite(found.constant) && std::isfinite(found.linear) &&
                        std::isfinite(found.quadratic);
    return finite ? found : RaySpread{};
}

void refine(BeamSet& set, std::span<const RayOrigin> origins, const MeshNeighbours& neighbours,
            const std::vector<bool>& kept, int threads, const ProgressPart& part) {
    const std::vector<std::uint8_t> asked = rays_of(set, kept, threads);
    const SpreadFit fit(set, origins, neighbours, threads);
    set.spreads.assign(set.rays.size(), {});
    parallel_chunks(threads, set.rays.size(), together, [&](const Chunk& chunk) {
        std::vector<std::uint32_t> around;
        for (auto ray = static_cast<std::uint32_t>(chunk.first); ray < chunk.end; ++ray)
            if (asked[ray] != 0) set.spreads[ray] = fit.spread(ray, around);
        part.progress.add(part.share * static_cast<double>(chunk.end - chunk.first) /
                          static_cast<double>(set.rays.size()));
    });
    set.partners = find_partners(set, origins, neighbours, threads);
}

}  // namespace caustics::beamtree
