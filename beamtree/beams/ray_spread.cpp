#include "beamtree/beams/ray_spread.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <Eigen/Cholesky>
#include <numeric>
#include <optional>
#include <vector>

#include "core/math/frame.h"

namespace caustics::beamtree {
namespace {

// Below this share of the largest, a pivot says that the vertices round one do not tell its derivatives.
constexpr double least_pivot = 1e-5;
constexpr std::size_t fewest_neighbours = 5;

using Matrix5 = Eigen::Matrix<double, 5, 5>;
// Of the first surface's height, the ray's place and its direction, by (u, v).
using Matrix57 = Eigen::Matrix<double, 5, 7>;

/// The first derivatives of a ray's values along two coordinates.
struct Derivatives {
    Vec2d height;
    std::array<Vec3d, 2> place;
    std::array<Vec3d, 2> direction;
};

class SpreadFit {
public:
    SpreadFit(const BeamSet& set, std::span<const RayOrigin> origins,
              const MeshNeighbours& neighbours)
        : set_(set), origins_(origins), neighbours_(neighbours) {
        for (std::uint32_t ray = 0; ray < origins.size(); ++ray) {
            const std::uint32_t vertex = origins[ray].vertex;
            if (vertex == RayOrigin::no_vertex) continue;
            if (vertex >= ray_of_.size()) ray_of_.resize(vertex + 1, Beam::none);
            ray_of_[vertex] = ray;
        }
        join();
    }

    RaySpread spread(std::uint32_t ray) {
        const RayOrigin& origin = origins_[ray];
        if (origin.vertex == RayOrigin::no_vertex) return {};
        const Frame frame(origin.normal);
        around_.clear();
        add_round(origin.vertex, ray);
        if (around_.size() > fewest_neighbours)
            if (const auto found = fit(ray, frame)) return spread(ray, frame, *found);
        const std::size_t inner = around_.size();
        for (std::size_t i = 0; i < inner; ++i) add_round(origins_[around_[i]].vertex, ray);
        if (around_.size() >= fewest_neighbours)
            if (const auto found = fit(ray, frame)) return spread(ray, frame, *found);
        return {};
    }

private:
    // Rays that whole beams join have gone the same way, over no crease.
    void join() {
        group_.resize(origins_.size());
        std::iota(group_.begin(), group_.end(), 0U);
        for (const Beam& beam : set_.beams)
            for (std::size_t i = 1; i < 4; ++i)
                if (beam.corners[i] != Beam::none)
                    group_[group(beam.corners[i])] = group(beam.corners[0]);
    }
    std::uint32_t group(std::uint32_t ray) {
        while (group_[ray] != ray) ray = group_[ray] = group_[group_[ray]];
        return ray;
    }

    // Rays beside a vertex that have gone the same way as `ray`.
    void add_round(std::uint32_t vertex, std::uint32_t ray) {
        for (const std::uint32_t other : neighbours_.round(vertex)) {
            const std::uint32_t found = other < ray_of_.size() ? ray_of_[other] : Beam::none;
            if (found == Beam::none || found == ray || group(found) != group(ray)) continue;
            if (std::find(around_.begin(), around_.end(), found) == around_.end())
                around_.push_back(found);
        }
    }

    // By least squares through the ray's own values.
    std::optional<Derivatives> fit(std::uint32_t ray, const Frame& frame) const {
        const Vec3& centre = origins_[ray].position;
        float reach = 0;
        for (const std::uint32_t other : around_)
            reach = std::max(reach, (origins_[other].position - centre).norm());
        if (!(reach > 0)) return {};
        Matrix5 left = Matrix5::Zero();
        Matrix57 right = Matrix57::Zero();
        for (const std::uint32_t other : around_) {
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
        return Derivatives{
            {found(0, 0), found(1, 0)},
            {found.block<1, 3>(0, 1).transpose(), found.block<1, 3>(1, 1).transpose()},
            {found.block<1, 3>(0, 4).transpose(), found.block<1, 3>(1, 4).transpose()}};
    }

    // Areas for a square of (u, v): across the ray at any distance, and across the light at the first
    // surface, times the strength that is left.
    RaySpread spread(std::uint32_t ray, const Frame& frame, const Derivatives& by) const {
        const RayOrigin& origin = origins_[ray];
        const Vec3d normal = frame.n.cast<double>() - by.height[0] * frame.s.cast<double>() -
                             by.height[1] * frame.t.cast<double>();
        const Vec3d w = to_light(set_.light, origin.position).cast<double>();
        double flux = std::abs(normal.dot(w)) * static_cast<double>(origin.weight.mean());
        if (set_.light.kind != LightSample::Kind::directional)
            flux /= (set_.light.position - origin.position).cast<double>().squaredNorm();
        const Vec3d d = set_.rays[ray].direction.cast<double>();
        const double constant = d.dot(by.place[0].cross(by.place[1]));
        const double linear =
            d.dot(by.place[0].cross(by.direction[1]) + by.direction[0].cross(by.place[1]));
        const double quadratic = d.dot(by.direction[0].cross(by.direction[1]));
        const double scale = (constant < 0 ? -1 : 1) / flux;
        const RaySpread found{static_cast<float>(constant * scale),
                              static_cast<float>(linear * scale),
                              static_cast<float>(quadratic * scale)};
        const bool finite = std::isfinite(found.constant) && std::isfinite(found.linear) &&
                            std::isfinite(found.quadratic);
        return finite ? found : RaySpread{};
    }

    const BeamSet& set_;
    std::span<const RayOrigin> origins_;
    const MeshNeighbours& neighbours_;
    std::vector<std::uint32_t> ray_of_;  ///< one a vertex
    std::vector<std::uint32_t>
        group_;  ///< one a ray: another of its group, at last the group itself
    std::vector<std::uint32_t> around_;
};

std::vector<std::uint32_t> find_partners(const BeamSet& set, std::span<const RayOrigin> origins,
                                         const MeshNeighbours& neighbours) {
    const auto is_whole = [&](const Beam& beam) {
        return beam.triangle_count() == 1 &&
               std::all_of(beam.corners.begin(), beam.corners.begin() + 3, [&](std::uint32_t ray) {
                   return origins[ray].vertex != RayOrigin::no_vertex;
               });
    };
    std::vector<std::uint32_t> beam_of;
    for (std::uint32_t i = 0; i < set.beams.size(); ++i) {
        const Beam& beam = set.beams[i];
        if (!is_whole(beam)) continue;
        if (beam.triangle >= beam_of.size()) beam_of.resize(beam.triangle + 1, Beam::none);
        beam_of[beam.triangle] = i;
    }
    std::vector<std::uint32_t> partners;
    for (const Beam& beam : set.beams) {
        const std::uint32_t triangle =
            is_whole(beam) ? neighbours.partner(beam.triangle) : MeshNeighbours::none;
        partners.push_back(triangle < beam_of.size() ? beam_of[triangle] : Beam::none);
    }
    return partners;
}

std::vector<bool> rays_of(const BeamSet& set, const std::vector<bool>& kept) {
    std::vector<bool> rays(set.rays.size(), false);
    for (std::size_t i = 0; i < set.beams.size(); ++i)
        for (const std::uint32_t corner : set.beams[i].corners)
            if (kept[i] && corner != Beam::none) rays[corner] = true;
    return rays;
}

}  // namespace

void refine(BeamSet& set, std::span<const RayOrigin> origins, const MeshNeighbours& neighbours,
            const std::vector<bool>& kept, const ProgressPart& part) {
    const std::vector<bool> asked = rays_of(set, kept);
    SpreadFit fit(set, origins, neighbours);
    set.spreads.clear();
    ProgressSteps steps(part, set.rays.size());
    for (std::uint32_t ray = 0; ray < set.rays.size(); ++ray) {
        set.spreads.push_back(asked[ray] ? fit.spread(ray) : RaySpread{});
        steps.step();
    }
    set.partners = find_partners(set, origins, neighbours);
}

}  // namespace caustics::beamtree
