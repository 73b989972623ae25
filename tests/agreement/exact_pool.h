#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "beamtree/beam_tree.h"
#include "beamtree/beams/light_sample.h"
#include "core/geometry/tessellate.h"
#include "core/math/rng.h"
#include "tests/support/build_scene.h"
#include "tests/support/fresnel.h"

namespace caustics::exact_pool {

// A pool deep enough for caustics to fold. The truth at a point of the floor is the light along every ray
// through the exact water that comes there: each root of the map from the surface to the floor brings
// its flux over the map's determinant.
constexpr double floor_depth = 3;
constexpr double ior = 1.333;

inline SineHeightfield water() {
    SineHeightfield field;
    field.waves = {{0.024, {7.1, 2.3}, 0.4}, {0.019, {-4.2, 8.6}, 1.9}, {0.011, {12.7, -6.1}, 3.1}};
    return field;
}

enum class Lamp { point, directional, area };

inline Shape meshed(TriangleMesh surface) {
    return support::mesh("water", std::move(surface), Transform::Identity(),
                         support::glass(static_cast<float>(ior)));
}

inline SceneDesc pool(Shape surface, Lamp lamp) {
    SceneDesc desc;
    desc.shapes = {std::move(surface),
                   support::horizontal("floor", -floor_depth, 3.2, true, support::diffuse(0.5F))};
    if (lamp == Lamp::point) desc.lights = {support::point_light({0.4, 0.3, 2.5}, 10)};
    if (lamp == Lamp::directional) desc.lights = {support::directional_light({0.3, -0.2, -1}, 2)};
    if (lamp == Lamp::area) {
        desc.shapes.push_back(support::horizontal("lamp", 2.5, 0.3, false, support::diffuse(0)));
        desc.shapes.back().radiance = Spectrum(Spectrum::Constant(20));
    }
    return desc;
}

/// The floor under the exact water, lit by some light samples.
class ExactPool {
public:
    explicit ExactPool(std::vector<beamtree::LightSample> lights) : lights_(std::move(lights)) {
        for (const beamtree::LightSample& light : lights_) sort_cells(light);
    }

    /// Irradiance [W m^-2]; none where a ray from near the rim of the water comes, where meshes know
    /// derivatives from one side only.
    std::optional<double> irradiance(const Vec2d& at) const {
        double sum = 0;
        for (std::size_t i = 0; i < lights_.size(); ++i) {
            const auto found = irradiance(i, at);
            if (!found) return {};
            sum += *found;
        }
        return sum;
    }

private:
    static constexpr int side = 256;
    static constexpr int bins = 160;
    static constexpr double half_floor = 2;

    struct Bent {
        Vec2d at;
        double flux;  ///< for an area of the undisturbed surface
    };

    Bent bend(const beamtree::LightSample& light, const Vec2d& xy) const {
        const Vec2d slope = field_.gradient(xy);
        const Vec3d p(xy.x(), xy.y(), field_.height(xy));
        const Vec3d across(-slope.x(), -slope.y(), 1);
        const double area = across.norm();
        const Vec3d normal = across / area;
        Vec3d w = -light.travel.cast<double>();
        double strength = static_cast<double>(light.strength.mean());
        if (light.kind != beamtree::LightSample::Kind::directional) {
            const Vec3d away = light.position.cast<double>() - p;
            w = away.normalized();
            strength /= away.squaredNorm();
        }
        if (light.kind == beamtree::LightSample::Kind::area)
            strength *= -light.normal.cast<double>().dot(w);
        const double cosine = w.dot(normal);
        const double inner = support::refracted_cosine(cosine, ior);
        const Vec3d down = (cosine * normal - w) / ior - inner * normal;
        const double way = (p.z() + floor_depth) / -down.z();
        return {xy + way * down.head<2>(),
                strength * cosine * area * (1 - support::fresnel(cosine, ior))};
    }

    Eigen::Matrix2d jacobian(const beamtree::LightSample& light, const Vec2d& xy) const {
        constexpr double step = 1e-5;
        Eigen::Matrix2d found;
        for (int i = 0; i < 2; ++i)
            found.col(i) = (bend(light, xy + step * Vec2d::Unit(i)).at -
                            bend(light, xy - step * Vec2d::Unit(i)).at) /
                           (2 * step);
        return found;
    }

    // Half cells of a grid on the water by the places of the floor that they light.
    void sort_cells(const beamtree::LightSample& light) {
        std::vector<Vec2d> at;
        for (int j = 0; j <= side; ++j)
            for (int i = 0; i <= side; ++i) at.push_back(bend(light, corner(i, j)).at);
        std::vector<std::vector<Half>> sorted(bins * bins);
        for (int j = 0; j < side; ++j)
            for (int i = 0; i < side; ++i)
                for (const bool upper : {false, true}) add({i, j, upper}, at, sorted);
        images_.push_back(std::move(at));
        sorted_.push_back(std::move(sorted));
    }

    struct Half {
        int i, j;
        bool upper;
    };

    static Vec2d corner(int i, int j) { return Vec2d(2.0 * i / side - 1, 2.0 * j / side - 1); }
    static std::array<std::size_t, 3> corners(const Half& half) {
        const auto index = [](int i, int j) {
            return static_cast<std::size_t>(j) * (side + 1) + static_cast<std::size_t>(i);
        };
        const auto& [i, j, upper] = half;
        return {index(i, j), upper ? index(i + 1, j + 1) : index(i + 1, j),
                upper ? index(i, j + 1) : index(i + 1, j + 1)};
    }
    static int bin(double x) {
        return std::clamp(static_cast<int>((x / half_floor + 1) * bins / 2), 0, bins - 1);
    }

    static void add(const Half& half, const std::vector<Vec2d>& at,
                    std::vector<std::vector<Half>>& sorted) {
        Eigen::AlignedBox2d box;
        for (const std::size_t c : corners(half)) box.extend(at[c]);
        for (int y = bin(box.min().y()); y <= bin(box.max().y()); ++y)
            for (int x = bin(box.min().x()); x <= bin(box.max().x()); ++x)
                sorted[static_cast<std::size_t>(y * bins + x)].push_back(half);
    }

    std::optional<double> irradiance(std::size_t light, const Vec2d& at) const {
        std::vector<Vec2d> roots;
        double sum = 0;
        const auto place = static_cast<std::size_t>(bin(at.y()) * bins + bin(at.x()));
        for (const Half& half : sorted_[light][place]) {
            if (!holds(light, half, at)) continue;
            const Vec2d root = newton(light, corner(half.i, half.j), at);
            const bool known = std::any_of(roots.begin(), roots.end(), [&](const Vec2d& r) {
                return (r - root).norm() < 1e-7;
            });
            if (known) continue;
            roots.push_back(root);
            if (root.cwiseAbs().maxCoeff() > 0.9) return {};
            sum += bend(lights_[light], root).flux /
                   std::abs(jacobian(lights_[light], root).determinant());
        }
        return sum;
    }

    bool holds(std::size_t light, const Half& half, const Vec2d& at) const {
        const auto c = corners(half);
        int positive = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec2d a = images_[light][c[k]] - at;
            const Vec2d b = images_[light][c[(k + 1) % 3]] - at;
            positive += a.x() * b.y() - a.y() * b.x() > 0;
        }
        return positive == 0 || positive == 3;
    }

    Vec2d newton(std::size_t light, Vec2d xy, const Vec2d& at) const {
        for (int step = 0; step < 12; ++step)
            xy -= jacobian(lights_[light], xy).inverse() * (bend(lights_[light], xy).at - at);
        return xy;
    }

    SineHeightfield field_ = water();
    std::vector<beamtree::LightSample> lights_;
    std::vector<std::vector<Vec2d>> images_;              ///< one a light
    std::vector<std::vector<std::vector<Half>>> sorted_;  ///< one a light
};

struct Errors {
    double median = 0;
    double mean = 0;  ///< of the smaller of the relative error and 1
};

/// Points of the floor with their true irradiance.
class PointwiseTruth {
public:
    explicit PointwiseTruth(Lamp lamp, int light_samples = 1) : lamp_(lamp) {
        const Scene scene(pool(meshed(tessellate_heightfield(water(), 4)), lamp));
        const ExactPool exact(beamtree::sample_lights(scene, light_samples, 1));
        Rng rng(6, Stage::test, 0);
        while (points_.size() < 1000) {
            const Vec2d at(1.6F * rng.next() - 0.8F, 1.6F * rng.next() - 0.8F);
            const auto irradiance = exact.irradiance(at.cast<float>().cast<double>());
            if (!irradiance || *irradiance == 0) continue;
            points_.push_back(at);
            irradiance_.push_back(*irradiance);
        }
    }

    Errors errors(Shape surface, const beamtree::BeamTreeParams& params) const {
        const Scene scene(pool(std::move(surface), lamp_));
        std::vector<ReceiverPoint> probes;
        for (const Vec2d& at : points_)
            probes.push_back(
                support::probe(scene, 1, {at.x(), at.y(), -floor_depth}, Vec3d::UnitZ(), 0));
        const auto found = support::irradiance(*build(scene, params, {}), probes);
        Errors errors;
        std::vector<double> all;
        for (std::size_t i = 0; i < found.size(); ++i) {
            all.push_back(
                std::abs(static_cast<double>(found[i].value.mean()) / irradiance_[i] - 1));
            errors.mean += std::min(all.back(), 1.0) / static_cast<double>(found.size());
        }
        std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2),
                         all.end());
        errors.median = all[all.size() / 2];
        return errors;
    }

private:
    Lamp lamp_;
    std::vector<Vec2d> points_;
    std::vector<double> irradiance_;
};

inline beamtree::BeamTreeParams with(beamtree::Intensity intensity) {
    beamtree::BeamTreeParams params = beamtree::BeamTreeParams::chuang1995();
    params.bound = beamtree::Bound::sphere_swept;
    params.intensity = intensity;
    params.light_samples = 1;
    return params;
}

}  // namespace caustics::exact_pool
