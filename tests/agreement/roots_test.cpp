#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "beamtree/beam_tree.h"
#include "core/geometry/tessellate.h"
#include "core/math/rng.h"
#include "tests/support/build_scene.h"
#include "tests/support/fresnel.h"

namespace caustics {
namespace {

// `intensity: refined` at points finds every ray that reaches a point, beside folds as well. Chords of a fold lie inside
// it: polygons whose straight-sided image has to hold the point lose light to first order in their size.

beamtree::BeamTreeParams refined(int resolution, int bounces) {
    beamtree::BeamTreeParams params;
    params.mesh_resolution = resolution;
    params.max_bounces = bounces;
    return params;
}

/// What a method says of points, and how many of its polygons were not settled by roots.
struct Answer {
    std::vector<double> irradiance;
    std::uint64_t unsettled = 0;
};

Answer ask(const CausticEstimator& method, const std::vector<ReceiverPoint>& points) {
    std::vector<Estimate> found(points.size());
    const auto context = method.make_context();
    method.irradiance(points, found, *context);
    Answer answer;
    for (const Estimate& each : found)
        answer.irradiance.push_back(static_cast<double>(each.value.mean()));
    Counters counters;
    context->add_to(counters);
    answer.unsettled = counters["roots_unsettled"];
    return answer;
}

double mean(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Water with one wave under the sun straight above: light moves along the wave vector alone, so that the rays of a
/// point are the roots of a function of one variable.
class WaveUnderTheSun {
public:
    static constexpr double amplitude = 0.03, depth = 0.8, index = 1.33, half_size = 2;

    WaveUnderTheSun() : along_(k_.normalized()), across_(-along_.y(), along_.x()) {
        for (int i = 0; i <= count; ++i) {
            places_.push_back(-8 + 16.0 * i / count);
            landings_.push_back(landing(places_.back()));
        }
    }

    SceneDesc scene() const {
        Shape water;
        water.name = "water";
        water.primitive = Primitive::heightfield;
        water.field.waves = {{amplitude, k_, 0}};
        water.field.half_size = {half_size, half_size};
        water.to_world = Eigen::Translation3d(0, 0, depth);
        water.bsdf = support::glass(static_cast<float>(index));
        SceneDesc desc;
        desc.shapes = {water, support::horizontal("floor", 0, 1, true, support::diffuse(0.5F))};
        desc.lights = {support::directional_light(-Vec3d::UnitZ(), 1)};
        return desc;
    }
    double irradiance(const Vec2d& floor) const {
        const double q = floor.dot(along_);
        double sum = 0;
        for (std::size_t i = 0; i < count; ++i) {
            if ((landings_[i] < q) == (landings_[i + 1] < q)) continue;
            double low = places_[i];
            double high = places_[i + 1];
            for (int halving = 0; halving < 50; ++halving) {
                const double middle = (low + high) / 2;
                ((landing(middle) < q) == (landings_[i] < q) ? low : high) = middle;
            }
            const Vec2d place = low * along_ + floor.dot(across_) * across_;
            if (place.cwiseAbs().maxCoeff() > half_size) continue;
            const double slope = (landing(low + 1e-6) - landing(low - 1e-6)) / 2e-6;
            sum += left(low) / std::abs(slope);
        }
        return sum;
    }

    /// Over the floor: what lands there of light that goes through places all over the water.
    double mean_irradiance() const {
        constexpr int side = 2000;
        double sum = 0;
        for (int i = 0; i < side; ++i)
            for (int j = 0; j < side; ++j) {
                const Vec2d place =
                    half_size * Vec2d((2 * i + 1.0) / side - 1, (2 * j + 1.0) / side - 1);
                const double s = place.dot(along_);
                const Vec2d lands = place + (landing(s) - s) * along_;
                if (lands.cwiseAbs().maxCoeff() < 1) sum += left(s);
            }
        return sum * half_size * half_size / side / side;
    }

private:
    static constexpr int count = 40'000;

    double tilt(double s) const { return amplitude * k_.norm() * std::cos(k_.norm() * s); }
    double left(double s) const {
        return 1 - support::fresnel(1 / std::hypot(1.0, tilt(s)), index);
    }
    // Down, bent by the surface of this tilt.
    double landing(double s) const {
        const double in = std::atan(tilt(s));
        const double out = std::asin(std::sin(in) / index);
        return s + std::tan(in - out) * (depth + amplitude * std::sin(k_.norm() * s));
    }

    Vec2d k_ = {-6, 15};
    Vec2d along_, across_;
    std::vector<double> places_, landings_;
};

std::vector<Vec2d> jittered_floor(int side) {
    Rng rng(3, Stage::test, 0);
    std::vector<Vec2d> points;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j)
            points.emplace_back(2 * (i + static_cast<double>(rng.next())) / side - 1,
                                2 * (j + static_cast<double>(rng.next())) / side - 1);
    return points;
}

TEST(Roots, AreAllFoundBesideLongFolds) {
    const WaveUnderTheSun wave;
    const Scene scene(wave.scene());
    const std::vector<Vec2d> floor = jittered_floor(40);
    std::vector<ReceiverPoint> points;
    std::vector<double> truth;
    for (const Vec2d& at : floor) {
        points.push_back(support::probe(scene, 1, {at.x(), at.y(), 0}, Vec3d::UnitZ(), 0));
        truth.push_back(wave.irradiance(points.back().position.head<2>().cast<double>()));
    }
    for (const int cells : {32, 64, 128}) {
        const Answer found = ask(*build(scene, refined(cells, 1), {}), points);
        EXPECT_NEAR(mean(found.irradiance) / mean(truth), 1, 2e-4) << cells;
        EXPECT_EQ(found.unsettled, 0U) << cells;
        // A ray too many or too few is off by much more.
        std::size_t off = 0;
        for (std::size_t i = 0; i < truth.size(); ++i)
            off += std::abs(found.irradiance[i] / truth[i] - 1) > 1e-3 ? 1 : 0;
        EXPECT_EQ(off, 0U) << cells;
    }
    // The control: polygons that have to hold the point.
    beamtree::BeamTreeParams area = refined(32, 1);
    area.intensity = beamtree::Intensity::area;
    const Answer polygons = ask(*build(scene, area, {}), points);
    EXPECT_GT(std::abs(mean(polygons.irradiance) / mean(truth) - 1), 1e-3);
}

/// Light of a point above a glass ball: where rays land by their angle at the light, and what is left of them.
class BallOnAxis {
public:
    static constexpr double light_z = 3, ball_z = 0.5, radius = 0.3, index = 1.5, strength = 5;

    BallOnAxis() {
        const double widest = std::asin(radius / (light_z - ball_z));
        for (int i = 1; i < count; ++i) {
            angles_.push_back(widest * i / count);
            rays_.push_back(ray(angles_.back()));
        }
    }

    SceneDesc scene() const {
        SceneDesc desc;
        desc.shapes = {support::sphere("ball", {0, 0, ball_z}, radius,
                                       support::glass(static_cast<float>(index))),
                       support::horizontal("floor", 0, 3, true, support::diffuse(0.5F))};
        desc.lights = {support::point_light({0, 0, light_z}, static_cast<float>(strength))};
        return desc;
    }
    /// Light of two refractions.
    double irradiance(double r) const {
        double sum = 0;
        for (std::size_t i = 0; i + 1 < rays_.size(); ++i)
            for (const double side : {1.0, -1.0}) {
                const Landing &a = rays_[i], &b = rays_[i + 1];
                if (!a.lands || !b.lands || (side * a.r < r) == (side * b.r < r)) continue;
                const double share = (side * r - a.r) / (b.r - a.r);
                const double angle = angles_[i] + share * (angles_[i + 1] - angles_[i]);
                const double slope = (b.r - a.r) / (angles_[i + 1] - angles_[i]);
                sum += strength * std::sin(angle) * a.left / (r * std::abs(slope));
            }
        return sum;
    }

private:
    struct Landing {
        double r = 0;
        double left = 0;
        bool lands = false;
    };
    static constexpr int count = 200'000;

    static Landing ray(double a) {
        const Vec2d centre(0, ball_z);
        const Vec2d d(std::sin(a), -std::cos(a));
        const double c = (light_z - ball_z) * std::cos(a);
        const double out = (light_z - ball_z) * std::sin(a);
        const double t = c - std::sqrt(radius * radius - out * out);
        const Vec2d p(t * d.x(), light_z + t * d.y());
        const Vec2d n = (p - centre) / radius;
        const double cosine = -d.dot(n);
        const double inner = std::sqrt(1 - (1 - cosine * cosine) / (index * index));
        const Vec2d inside = d / index + (cosine / index - inner) * n;
        const Vec2d q = p - 2 * (p - centre).dot(inside) * inside;
        const Vec2d m = (q - centre) / radius;
        const double leaves = inside.dot(m);
        const double outer = std::sqrt(std::max(0.0, 1 - (1 - leaves * leaves) * index * index));
        const Vec2d away = index * inside + (outer - index * leaves) * m;
        const double passed = 1 - support::fresnel(cosine, index);
        if (!(away.y() < 0)) return {};
        return {q.x() - q.y() / away.y() * away.x(), passed * passed, true};
    }

    std::vector<double> angles_;
    std::vector<Landing> rays_;
};

TEST(Roots, AreAllFoundThroughAGlassBall) {
    const BallOnAxis ball;
    const Scene scene(ball.scene());
    std::vector<ReceiverPoint> points;
    std::vector<double> truth;
    // Nearer to the axis than what the ball mirrors.
    for (int i = 0; i < 160; ++i) {
        const double r = 0.013 + 0.0021 * i;
        points.push_back(
            support::probe(scene, 1, {r * std::cos(i), r * std::sin(i), 0}, Vec3d::UnitZ(), 0));
        truth.push_back(ball.irradiance(r));
    }
    const Answer found = ask(*build(scene, refined(64, 2), {}), points);
    std::size_t off = 0;
    for (std::size_t i = 0; i < truth.size(); ++i)
        off += std::abs(found.irradiance[i] - truth[i]) > 2e-3 * truth[i] + 1e-6 ? 1 : 0;
    EXPECT_LE(off, 1U);  // the truth's own step at a fold
    EXPECT_EQ(found.unsettled, 0U);
}

// The same water as a mesh: light goes by the normals that it interpolates, for particles and for beams alike.
TEST(Roots, KeepTheLightOfSmoothMeshes) {
    const WaveUnderTheSun wave;
    SceneDesc desc = wave.scene();
    Shape mesh;
    mesh.name = "water";
    mesh.primitive = Primitive::mesh;
    mesh.mesh = tessellate_shape(desc.shapes[0], 128);
    mesh.bsdf = desc.shapes[0].bsdf;
    desc.shapes[0] = mesh;
    const Scene scene(std::move(desc));
    std::vector<ReceiverPoint> points;
    for (const Vec2d& at : jittered_floor(500))
        points.push_back(support::probe(scene, 1, {at.x(), at.y(), 0}, Vec3d::UnitZ(), 0));
    const Answer found = ask(*build(scene, refined(128, 1), {}), points);
    const double average = mean(found.irradiance);
    double variance = 0;
    for (const double each : found.irradiance) variance += std::pow(each - average, 2);
    const double error = std::sqrt(variance) / static_cast<double>(points.size());
    EXPECT_LT(error, 0.005);
    EXPECT_NEAR(average, wave.mean_irradiance(), 3 * error);
    EXPECT_EQ(found.unsettled, 0U);
}

}  // namespace
}  // namespace caustics
