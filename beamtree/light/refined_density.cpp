#include "beamtree/light/refined_density.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace caustics::beamtree {
namespace {

// Corners' spreads between which the light is taken as smooth differ by no more than this.
constexpr double most_varied = 4;

/// A node of the rule of degree 5 for a triangle [Radon 1948]: its weight and two coordinates.
struct Node {
    double weight;
    Vec3d at;
};

std::array<Node, 7> nodes() {
    const double root = std::sqrt(15.0);
    const auto node = [](double weight, double a, int which) {
        Vec3d at = Vec3d::Constant(a);
        at[which] = 1 - 2 * a;
        return Node{weight, at};
    };
    const double far = (6 + root) / 21;
    const double near = (6 - root) / 21;
    const double far_weight = (155 + root) / 1200;
    const double near_weight = (155 - root) / 1200;
    return {Node{9.0 / 40, Vec3d::Constant(1.0 / 3)},
            node(far_weight, far, 0),
            node(far_weight, far, 1),
            node(far_weight, far, 2),
            node(near_weight, near, 0),
            node(near_weight, near, 1),
            node(near_weight, near, 2)};
}

/// One triangle of a beam where it is lit evenly and smoothly.
class SmoothTriangle {
public:
    static std::optional<SmoothTriangle> on(const TestPlane& plane, const BeamSet& set,
                                            const Beam& beam, std::size_t which, double place) {
        SmoothTriangle found;
        const std::array<std::uint32_t, 3> rays = beam.triangle_corners(which);
        std::array<Vec2d, 3> at;
        for (std::size_t i = 0; i < 3; ++i) {
            const VertexRay ray = set.ray(rays[i], place);
            const double height = plane.height(ray.position);
            const double steepness = plane.steepness(ray.direction);
            if (!(height > 0 && steepness > 0) || !set.spreads[rays[i]].is_known()) return {};
            const double distance = height / steepness;
            at[i] = plane.project(ray.position, distance, ray.direction);
            const auto k = static_cast<Eigen::Index>(i);
            found.spread_[k] = set.spreads[rays[i]].at(distance) / steepness;
            found.steepness_[k] = steepness;
        }
        if (!found.is_smooth()) return {};
        const Vec2d u = at[1] - at[0];
        const Vec2d v = at[2] - at[0];
        found.area_ = std::abs(u.x() * v.y() - u.y() * v.x()) / 2 * plane.area_scale();
        return found;
    }

    /// At the point with these barycentric weights, to a factor [W m^-2].
    double irradiance(const Vec3d& weights) const { return 1 / std::abs(weights.dot(spread_)); }
    /// The mean of it over the hit's part of a cell, to second order of how the spread varies there.
    double irradiance(const BeamHit& hit) const {
        const double spread = hit.weights.cast<double>().dot(spread_);
        const Vec3d apart(spread_[1] - spread_[2], spread_[2] - spread_[0],
                          spread_[0] - spread_[1]);
        const double variance = -hit.covariances.cast<double>().dot(apart.cwiseAbs2());
        return (1 + variance / (spread * spread)) / std::abs(spread);
    }
    double flux() const {
        static const std::array<Node, 7> rule = nodes();
        double mean = 0;
        for (const Node& node : rule) mean += node.weight * irradiance(node.at);
        return mean * area_;
    }

private:
    bool is_smooth() const {
        if (steepness_.maxCoeff() > most_uneven * steepness_.minCoeff()) return false;
        if (spread_.minCoeff() < 0 && spread_.maxCoeff() > 0) return false;
        const Vec3d size = spread_.cwiseAbs();
        return size.minCoeff() * most_varied > size.maxCoeff();
    }

    Vec3d spread_;     ///< 1 / irradiance on the plane, signed [m^2 W^-1]
    Vec3d steepness_;  ///< cosines
    double area_ = 0;
};

double flux_of_triangle(const Beam& beam, std::size_t which) {
    const auto flux = static_cast<double>(beam.flux.mean());
    if (beam.triangle_count() == 1) return flux;
    const auto first = static_cast<double>(beam.first_share);
    return flux * (which == 0 ? first : 1 - first);
}

/// The other triangle of a hit's pair.
struct Partner {
    const Beam* beam = nullptr;
    std::size_t triangle = 0;
};

Partner partner_of(const BeamSet& set, const BeamHit& hit) {
    const Beam& beam = set.beams[hit.beam];
    if (beam.triangle_count() == 2) return {&beam, 1U - hit.triangle};
    const std::uint32_t other = set.partners[hit.beam];
    return other == Beam::none ? Partner{} : Partner{&set.beams[other], 0};
}

std::optional<double> density_on(const TestPlane& plane, const BeamSet& set, const BeamHit& hit) {
    const Beam& beam = set.beams[hit.beam];
    const auto own = SmoothTriangle::on(plane, set, beam, hit.triangle, hit.place());
    if (!own) return {};
    double flux = flux_of_triangle(beam, hit.triangle);
    double found = own->flux();
    const Partner partner = partner_of(set, hit);
    std::optional<SmoothTriangle> other;
    if (partner.beam != nullptr)
        other = SmoothTriangle::on(plane, set, *partner.beam, partner.triangle, hit.place());
    if (other) {
        flux += flux_of_triangle(*partner.beam, partner.triangle);
        found += other->flux();
    } else if (beam.triangle_count() == 2 && hit.flux_share == 1) {
        return {};  // the other half shares [CC95 (11)]'s flux of the whole quad with this one
    }
    const double irradiance = own->irradiance(hit) * flux / found;
    return irradiance / static_cast<double>(beam.flux.mean());
}

Vec3 arriving_direction(const BeamSet& set, const BeamHit& hit) {
    const auto rays = set.triangle(set.beams[hit.beam], hit.triangle, hit.place());
    Vec3 direction = Vec3::Zero();
    for (std::size_t i = 0; i < 3; ++i)
        direction += hit.weights[static_cast<Eigen::Index>(i)] * rays[i].direction;
    return direction.stableNormalized();
}

}  // namespace

std::optional<double> refined_density(const BeamSet& set, const BeamHit& hit, const Vec3& point) {
    if (set.spreads.empty()) return {};
    const TestPlane plane(point, hit.plane_normal);
    if (const auto found = density_on(plane, set, hit)) return found;
    // Of a cell [CC95 (11)] keeps the flux; on another plane the covered part is another one.
    if (hit.is_part_of_cell()) return {};
    const Vec3 direction = arriving_direction(set, hit);
    const auto across = density_on(TestPlane(point, -direction), set, hit);
    if (!across) return {};
    return *across * plane.steepness(direction);
}

}  // namespace caustics::beamtree
