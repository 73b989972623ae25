#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "beamtree/beam_tree.h"
#include "core/geometry/tessellate.h"
#include "photonmap/photon_map.h"
#include "tests/support/build_scene.h"
#include "tests/support/fresnel.h"

namespace caustics {
namespace {

constexpr double light_z = 3;
constexpr double light_intensity = 5;
constexpr double index = 1.5;
constexpr int events = 4;
constexpr double ring = 0.04;
constexpr std::size_t rings = 11;

/// A sphere about the axis, or, of radius 0, a horizontal plane.
struct Surface {
    double z = 0;
    double radius = 0;
    double inside = index;  ///< ior within the sphere, or below the plane
    double outside = 1;
};

/// Glass round an axis, under a point light on it. Every ray stays in a plane through the axis, so that
/// all branches of all rays are followed one by one, what is reflected and refracted, into rings of
/// the floor.
class RingTracer {
public:
    explicit RingTracer(std::vector<Surface> surfaces)
        : surfaces_(std::move(surfaces)), flux_(rings, 0.0) {
        constexpr int rays = 1'000'000;
        constexpr double step = pi_d / 2 / rays;
        for (int i = 0; i < rays; ++i) {
            const double u = step * (i + 0.5);
            follow({0, light_z}, {std::sin(u), -std::cos(u)},
                   2 * pi_d * light_intensity * std::sin(u) * step, 0);
        }
    }

    /// Mean over a ring [W m^-2].
    double irradiance(std::size_t i) const {
        return flux_[i] / (pi_d * ring * ring * static_cast<double>(2 * i + 1));
    }

private:
    static double distance(const Surface& surface, const Vec2d& at, const Vec2d& direction) {
        const auto ahead = [](double t) { return t > 1e-9 ? t : 1e9; };
        const Vec2d from = at - Vec2d(0, surface.z);
        if (surface.radius == 0) return ahead(-from.y() / direction.y());
        const double b = from.dot(direction);
        const double square = b * b - from.squaredNorm() + surface.radius * surface.radius;
        if (square < 0) return 1e9;
        return std::min(ahead(-b - std::sqrt(square)), ahead(-b + std::sqrt(square)));
    }

    void follow(Vec2d at, Vec2d direction, double flux, int count) {
        const Surface* hit = nullptr;
        double nearest = direction.y() < 0 ? -at.y() / direction.y() : 1e8;
        for (const Surface& surface : surfaces_)
            if (const double t = distance(surface, at, direction); t < nearest) {
                nearest = t;
                hit = &surface;
            }
        if (nearest == 1e8) return;
        at += nearest * direction;
        if (hit == nullptr) {
            if (count > 0) land(at, flux);
            return;
        }
        if (count == events || flux < 1e-12) return;
        Vec2d normal = hit->radius > 0 ? (at - Vec2d(0, hit->z)) / hit->radius : Vec2d(0, 1);
        double n = hit->inside / hit->outside;
        if (direction.dot(normal) > 0) {
            normal = -normal;
            n = 1 / n;
        }
        const double cosine = -direction.dot(normal);
        const double sine2 = (1 - cosine * cosine) / (n * n);
        const double reflected = sine2 >= 1 ? 1 : support::fresnel(cosine, n);
        follow(at, direction + 2 * cosine * normal, flux * reflected, count + 1);
        if (sine2 < 1)
            follow(at, direction / n + (cosine / n - std::sqrt(1 - sine2)) * normal,
                   flux * (1 - reflected), count + 1);
    }

    void land(const Vec2d& at, double flux) {
        const auto i = static_cast<std::size_t>(std::abs(at.x()) / ring);
        if (i < rings) flux_[i] += flux;
    }

    std::vector<Surface> surfaces_;
    std::vector<double> flux_;
};

Scene scene(std::vector<Shape> glass) {
    SceneDesc desc;
    desc.shapes = std::move(glass);
    desc.shapes.insert(desc.shapes.begin(),
                       support::horizontal("floor", 0, 2, true, support::diffuse(0.5F)));
    desc.lights = {support::point_light({0, 0, light_z}, static_cast<float>(light_intensity))};
    return Scene(std::move(desc));
}

double mean_over_ring(const Scene& scene, const CausticEstimator& method, std::size_t i) {
    constexpr int count = 40;
    double sum = 0;
    double weights = 0;
    for (int k = 0; k < count; ++k) {
        const double r = ring * (static_cast<double>(i) + (k % 5 + 0.5) / 5);
        const double angle = 2.4 * k;
        const ReceiverPoint point = support::probe(
            scene, 0, {r * std::cos(angle), r * std::sin(angle), 0}, Vec3d::UnitZ(), 0);
        sum += r * static_cast<double>(support::irradiance(method, {point})[0].value.mean());
        weights += r;
    }
    return sum / weights;
}

/// Compares the rings from `first` on.
void expect_rings(const Scene& scene, const CausticEstimator& method, const RingTracer& truth,
                  std::size_t first, double tolerance) {
    for (std::size_t i = first; i < rings; ++i)
        EXPECT_NEAR(mean_over_ring(scene, method, i) / truth.irradiance(i), 1, tolerance)
            << "ring " << i;
}

beamtree::BeamTreeParams beams(int resolution) {
    beamtree::BeamTreeParams params;
    params.mesh_resolution = resolution;
    params.max_bounces = events;
    return params;
}

photonmap::PhotonMapParams photons() {
    photonmap::PhotonMapParams params;
    params.photons = 0;
    params.emitted = 1'000'000;
    params.nearest = 50;
    params.max_bounces = events;
    return params;
}

// A ball of glass with a hollow in its middle. Up to 0.12 m there is a fold, where beams and discs are
// as wide as what they light.
const std::vector<Surface> hollow_ball = {{0.7, 0.5}, {0.7, 0.3, 1, index}};
constexpr std::size_t behind_fold = 3;

Scene hollow_ball_scene() {
    return scene({support::sphere("ball", {0, 0, 0.7}, 0.5, support::glass(1.5F)),
                  support::sphere("hollow", {0, 0, 0.7}, 0.3, support::glass(1, 1.5F))});
}

TEST(HollowBall, PhotonMapFollowsAllEvents) {
    const Scene ball = hollow_ball_scene();
    expect_rings(ball, *build(ball, photons(), {}), RingTracer(hollow_ball), behind_fold, 0.06);
}

TEST(HollowBall, BeamTreeFollowsAllEvents) {
    const Scene ball = hollow_ball_scene();
    expect_rings(ball, *build(ball, beams(128), {}), RingTracer(hollow_ball), behind_fold, 0.03);
}

// A pane of twelve triangles, 12 m wide, and a small ball below it: what passes both comes from a
// hundredth of a triangle.
const std::vector<Surface> pane = {{2, 0}, {1.9, 0, 1, index}};

std::vector<Shape> pane_shape() {
    return {
        support::mesh("pane", tessellate_cube(1),
                      Transform(Eigen::Translation3d(0, 0, 1.95) * Eigen::Scaling(6.0, 6.0, 0.05)),
                      support::glass(1.5F))};
}

TEST(PaneOverBall, BeamTreeLightsTheFloorThroughThePane) {
    const Scene alone = scene(pane_shape());
    expect_rings(alone, *build(alone, beams(64), {}), RingTracer(pane), 0, 0.02);
}

TEST(PaneOverBall, BeamTreeFollowsWhatPassesBoth) {
    std::vector<Shape> shapes = pane_shape();
    shapes.push_back(support::sphere("ball", {0, 0, 0.4}, 0.2, support::glass(1.5F)));
    const Scene both = scene(shapes);
    std::vector<Surface> surfaces = pane;
    surfaces.push_back({0.4, 0.2});
    const auto tree = build(both, beams(64), {});
    expect_rings(both, *tree, RingTracer(surfaces), 0, 0.06);
}

}  // namespace
}  // namespace caustics
