#include "beamtree/beams/area_light_points.h"

#include <algorithm>
#include <cmath>
#include <Eigen/Core>
#include <span>

#include "core/geometry/box_view.h"
#include "core/geometry/exact_shape.h"
#include "core/math/recombination.h"

namespace caustics::beamtree {
namespace {

constexpr int least_candidates = 4096;
constexpr int candidates_per_point = 16;
constexpr int most_functions = 16;

struct Candidate {
    AreaSampler::Sample point;
    double sent;  ///< into the casters' boxes, times its area
    Vec3 side;    ///< of the lamp: its direction from the middle where the lamp is a ball
};

float fraction(float x) { return std::min(x - std::floor(x), 0x1.fffffep-1F); }

// A rank-1 lattice of the unit square, shifted at random.
class Lattice {
public:
    Lattice(int count, Rng& rng) : count_(count), shift_u_(rng.next()), shift_v_(rng.next()) {}

    AreaSampler::Sample point(const Scene& scene, const AreaLight& light, int i) const {
        constexpr float golden = 0.618033988F;
        const auto at = static_cast<float>(i);
        return light.sampler.sample(scene.shapes()[light.shape],
                                    fraction((at + shift_u_) / static_cast<float>(count_)),
                                    fraction(at * golden + shift_v_));
    }

private:
    int count_;
    float shift_u_;
    float shift_v_;
};

std::vector<Candidate> candidates_of(const Scene& scene, const AreaLight& light, int count,
                                     Rng& rng) {
    std::vector<Box> casters;
    for (const std::uint32_t caster : scene.casters())
        casters.push_back(bounds(scene.shapes()[caster]));
    const Box box = bounds(scene.shapes()[light.shape]);
    const Vec3 middle = box.center();
    const float size = box.diagonal().norm() / 2;
    const Lattice lattice(count, rng);
    std::vector<Candidate> all;
    for (int i = 0; i < count; ++i) {
        const AreaSampler::Sample point = lattice.point(scene, light, i);
        double sent = 0;
        for (const Box& caster : casters) sent += cosine_over(caster, point.position, point.normal);
        if (sent > 0)
            all.push_back({point, sent, (point.normal + (point.position - middle) / size) / 2});
    }
    return all;
}

// The first of the harmonics up to degree 3.
Eigen::VectorXd harmonics(const Vec3d& side, int count) {
    const double x = side.x(), y = side.y(), z = side.z();
    Eigen::Matrix<double, most_functions, 1> all;
    all << 1, x, y, z, x * y, y * z, z * x, x * x - y * y, 3 * z * z - side.squaredNorm(),
        x * (x * x - 3 * y * y), y * (3 * x * x - y * y), z * (x * x - y * y), x * y * z,
        x * (4 * z * z - x * x - y * y), y * (4 * z * z - x * x - y * y),
        z * (2 * z * z - 3 * x * x - 3 * y * y);
    return all.head(count);
}

// Draws the points of each part of the lamp.
class PointDraw {
public:
    PointDraw(double area, Rng& rng) : area_(area), rng_(rng) {}

    void draw(std::span<Candidate> part, int count) {
        if (count <= most_functions) return recombine_part(part, count);
        const std::span<Candidate> rest = cut(part, count / 2, count);
        draw(part.first(part.size() - rest.size()), count / 2);
        draw(rest, count - count / 2);
    }
    std::vector<AreaLightPoint> points() { return std::move(points_); }

private:
    // Orders the candidates along the widest axis of their sides; what sends share / count of the light is first.
    static std::span<Candidate> cut(std::span<Candidate> part, int share, int count) {
        Box box;
        double sent = 0;
        for (const Candidate& one : part) {
            box.extend(one.side);
            sent += one.sent;
        }
        int axis = 0;
        box.sizes().maxCoeff(&axis);
        std::ranges::stable_sort(part, {}, [axis](const Candidate& c) { return c.side[axis]; });
        std::size_t first = 0;
        for (double before = 0; first < part.size() && before * count < sent * share; ++first)
            before += part[first].sent;
        return part.subspan(first);
    }

    void recombine_part(std::span<const Candidate> part, int count) {
        Eigen::MatrixXd values(count, static_cast<Eigen::Index>(part.size()));
        for (std::size_t i = 0; i < part.size(); ++i)
            values.col(static_cast<Eigen::Index>(i)) =
                part[i].sent * harmonics(part[i].side.cast<double>(), count);
        std::vector<double> areas(part.size(), area_);
        recombine(areas, values, rng_);
        for (std::size_t i = 0; i < part.size(); ++i)
            if (areas[i] > 0)
                points_.push_back(
                    {part[i].point.position, part[i].point.normal, part[i].point.offset, areas[i]});
    }

    double area_;  ///< of a candidate's part [m^2]
    Rng& rng_;
    std::vector<AreaLightPoint> points_;
};

std::vector<AreaLightPoint> even_points(const Scene& scene, const AreaLight& light, int count,
                                        Rng& rng) {
    const Lattice lattice(count, rng);
    std::vector<AreaLightPoint> points;
    for (int i = 0; i < count; ++i) {
        const AreaSampler::Sample point = lattice.point(scene, light, i);
        points.push_back({point.position, point.normal, point.offset,
                          light.sampler.area() / static_cast<double>(count)});
    }
    return points;
}

}  // namespace

std::vector<AreaLightPoint> area_light_points(const Scene& scene, const AreaLight& light, int count,
                                              Rng rng) {
    if (exact_is_flat(scene.shapes()[light.shape])) return even_points(scene, light, count, rng);
    const int candidates = std::max(least_candidates, candidates_per_point * count);
    std::vector<Candidate> all = candidates_of(scene, light, candidates, rng);
    if (all.empty()) return even_points(scene, light, count, rng);
    PointDraw draw(light.sampler.area() / candidates, rng);
    draw.draw(all, count);
    return draw.points();
}

}  // namespace caustics::beamtree
