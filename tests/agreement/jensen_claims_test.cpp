#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <numeric>
#include <utility>
#include <vector>

#include "core/material/bsdf.h"
#include "core/math/sampling.h"
#include "core/render/renderer.h"
#include "photonmap/photon_map.h"
#include "tests/support/build_scene.h"

// What [J96 sec. 5] claims of its figures 1 and 2, where a closed form or a measure of shape can
// check it.
namespace caustics {
namespace {

// The ring of figure 1 as experiments/papers/scenes/jensen_ring.json has it.
constexpr double cardioid_radius = 0.5;
constexpr double cardioid_wall_low = 0.001;
constexpr double cardioid_wall_high = 0.25;
const Vec3d cardioid_lamp(0, 0.49, 0.4);

Scene cardioid_scene(float alpha) {
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", 0, 1.2, true, support::schlick(0.7F, alpha))};
    Shape ring;
    ring.name = "ring";
    ring.primitive = Primitive::cylinder;
    ring.to_world =
        Eigen::Translation3d(0, 0, cardioid_wall_low) *
        Eigen::Scaling(cardioid_radius, cardioid_radius, cardioid_wall_high - cardioid_wall_low);
    ring.bsdf = support::mirror(0.95F);
    desc.shapes.push_back(ring);
    desc.lights = {support::point_light(cardioid_lamp, 1)};
    return Scene(std::move(desc));
}

struct CardioidPoint {
    Vec3d place;
    Vec3d along;  // against the light, which runs along the tangent
    Vec3d lamp;   // towards the lamp
};

// Light that the wall mirrors at a point, an angle about the axis, meets its neighbours' where
// 1/s + 1/s' = 2 / (R cos): the caustic of a circle, on whose tangent it runs.
CardioidPoint cardioid_point(double degrees) {
    const double angle = degrees * pi_d / 180;
    const Vec2d wall = cardioid_radius * Vec2d(std::cos(angle), std::sin(angle));
    const Vec2d way = wall - cardioid_lamp.head<2>();
    const double s = way.norm();
    const Vec2d normal = -wall / cardioid_radius;
    const double cosine = -way.dot(normal) / s;
    const Vec2d onwards = way / s + 2 * cosine * normal;
    const double further = 1 / (2 / (cardioid_radius * cosine) - 1 / s);
    const double height = cardioid_lamp.z() * further / (s + further);
    EXPECT_GT(height, cardioid_wall_low) << degrees;
    EXPECT_LT(height, cardioid_wall_high) << degrees;
    const Vec2d place = wall + further * onwards;
    CardioidPoint found;
    found.place = Vec3d(place.x(), place.y(), 0);
    found.along = Vec3d(-onwards.x(), -onwards.y(), cardioid_lamp.z() / (s + further)).normalized();
    found.lamp = (cardioid_lamp - found.place).normalized();
    return found;
}

const double cardioid_angles[] = {206, 230, 254, 286, 310, 334};

std::vector<CardioidPoint> cardioid_points() {
    std::vector<CardioidPoint> points;
    for (const double degrees : cardioid_angles) points.push_back(cardioid_point(degrees));
    return points;
}

// Of the caustic at the points, towards the eye.
std::vector<double> cardioid_radiance(float alpha, const std::vector<CardioidPoint>& points,
                                      const Vec3d& eye) {
    const Scene scene = cardioid_scene(alpha);
    photonmap::PhotonMapParams params;
    params.photons = 200'000;
    params.nearest = 30;
    const auto map = build(scene, params, RunOptions{});
    std::vector<ReceiverPoint> seen;
    for (const CardioidPoint& point : points) {
        seen.push_back(support::probe(scene, 0, point.place, Vec3d::UnitZ(), seen.size()));
        seen.back().wo = (eye - point.place).normalized().cast<float>();
    }
    std::vector<Estimate> found(seen.size());
    map->radiance(seen, found, *map->make_context());
    std::vector<double> radiance;
    for (const Estimate& each : found) radiance.push_back(static_cast<double>(each.value[1]));
    return radiance;
}

// What is left at an alpha of the light at alpha 1, by the BRDF for light from one direction.
double left_by_schlick(float alpha, const Vec3d& wi, const Vec3d& wo) {
    const auto f_r = [&](float a) {
        return static_cast<double>(evaluate(support::schlick(0.7F, a), Vec2::Zero(), Vec3::UnitZ(),
                                            wo.cast<float>(), wi.cast<float>())[1]);
    };
    return f_r(alpha) / f_r(1);
}

// "The incoming direction of the light at the edge of the cardioid equals the tangent to the
// cardioid": seen across from the lamp, what is left of the light at smaller alphas is what the
// BRDF leaves of light along the tangent. Light straight from the lamp would leave something else.
TEST(JensenClaims, LightAtTheCardioidsEdgeRunsAlongItsTangent) {
    const Vec3d eye(0, -1.1, 1.5);
    const std::vector<CardioidPoint> points = cardioid_points();
    const std::vector<double> lambertian = cardioid_radiance(1, points, eye);
    for (const float alpha : {0.5F, 0.1F, 0.01F}) {
        const std::vector<double> glossy = cardioid_radiance(alpha, points, eye);
        double straight = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Vec3d wo = (eye - points[i].place).normalized();
            const double left = glossy[i] / lambertian[i];
            EXPECT_NEAR(left / left_by_schlick(alpha, points[i].along, wo), 1, 0.05)
                << "alpha " << alpha << ", wall at " << cardioid_angles[i] << " degrees";
            straight += std::abs(left / left_by_schlick(alpha, points[i].lamp, wo) - 1);
        }
        EXPECT_GT(straight / static_cast<double>(points.size()), 0.15) << "alpha " << alpha;
    }
}

// Ranks of values from 0.
std::vector<double> ranks_of(const std::vector<double>& values) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
    std::vector<double> ranks(values.size());
    for (std::size_t i = 0; i < order.size(); ++i) ranks[order[i]] = static_cast<double>(i);
    return ranks;
}

double rank_correlation(const std::vector<double>& x, const std::vector<double>& y) {
    const std::vector<double> a = ranks_of(x);
    const std::vector<double> b = ranks_of(y);
    double squares = 0;
    for (std::size_t i = 0; i < a.size(); ++i) squares += (a[i] - b[i]) * (a[i] - b[i]);
    const double n = static_cast<double>(a.size());
    return 1 - 6 * squares / (n * (n * n - 1));
}

// "The intensity of the caustic is reduced mostly in those parts where the incoming direction of
// the light differs mostly from the incoming direction of the viewing ray", mirrored.
TEST(JensenClaims, TheCardioidFadesWhereItsLightDiffersMostFromTheViewingRay) {
    const std::vector<CardioidPoint> points = cardioid_points();
    for (const Vec3d& eye : {Vec3d(0.2, 1.1, 1.5), Vec3d(0.2, -1.1, 1.5)}) {
        const std::vector<double> lambertian = cardioid_radiance(1, points, eye);
        const std::vector<double> glossy = cardioid_radiance(0.01F, points, eye);
        std::vector<double> tilt;
        std::vector<double> left;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Vec3d wo = (eye - points[i].place).normalized();
            tilt.push_back(std::acos((points[i].along + wo).normalized().z()));
            left.push_back(glossy[i] / lambertian[i]);
        }
        EXPECT_LT(rank_correlation(tilt, left), -0.8) << "eye at y = " << eye.y();
        const auto most = std::max_element(tilt.begin(), tilt.end()) - tilt.begin();
        const auto least = std::min_element(tilt.begin(), tilt.end()) - tilt.begin();
        EXPECT_LT(left[static_cast<std::size_t>(most)], 0.6 * left[static_cast<std::size_t>(least)])
            << "eye at y = " << eye.y();
    }
}

// Figure 2: a glass ball that touches the floor, light 30 degrees high, the eye across it.
const Vec3d spot_ball(0, 0, 0.3);
constexpr double spot_ball_radius = 0.3;

Scene spot_scene(float alpha) {
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", 0, 3, true, support::schlick(0.5F, alpha)),
                   support::sphere("ball", spot_ball, spot_ball_radius, support::glass(1.5F))};
    desc.lights = {support::point_light({-2.165, 0, 1.25}, 12)};
    desc.camera = support::camera({0.684, 1.472, 0.85}, {0.684, 0, 0}, {0, 0, 1}, 28, 160, 120);
    return Scene(std::move(desc));
}

bool sees_the_ball(const Vec3d& eye, const Vec3d& direction) {
    const Vec3d way = spot_ball - eye;
    return way.cross(direction).norm() < spot_ball_radius && way.dot(direction) > 0;
}

struct LitPlace {
    Vec2d place;
    double light;
};

std::vector<LitPlace> floor_of_the_picture(float alpha) {
    const Scene scene = spot_scene(alpha);
    photonmap::PhotonMapParams params;
    params.nearest = 100;
    RunOptions options;
    options.samples_per_pixel = 1;
    const Rendering rendering = render(scene, *build(scene, params, options), options);
    const std::vector<float>& caustic = *rendering.film.find("caustic.G");
    const Camera& camera = scene.camera();
    const Vec3d eye = camera.position().cast<double>();
    std::vector<LitPlace> floor;
    for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x) {
            const Vec3d direction = camera.direction(x + 0.5, y + 0.5).cast<double>();
            if (direction.z() >= 0 || sees_the_ball(eye, direction)) continue;
            const Vec3d place = eye - eye.z() / direction.z() * direction;
            const auto pixel = static_cast<std::size_t>(y * camera.width + x);
            floor.push_back({place.head<2>(), static_cast<double>(caustic[pixel])});
        }
    return floor;
}

// The spot, above 0.3 of the 99.5 % quantile, by a parabola y = c x^2 along its principal axes:
// c var x / sqrt(var y), 0 for an oval.
double curvature_index(std::vector<LitPlace> floor) {
    std::sort(floor.begin(), floor.end(),
              [](const LitPlace& a, const LitPlace& b) { return a.light < b.light; });
    const double level = 0.3 * floor[floor.size() * 995 / 1000].light;
    std::vector<Vec2d> spot;
    for (const LitPlace& each : floor)
        if (each.light > level) spot.push_back(each.place);
    const auto n = static_cast<Eigen::Index>(spot.size());
    Eigen::MatrixX2d places(n, 2);
    for (Eigen::Index i = 0; i < n; ++i) places.row(i) = spot[static_cast<std::size_t>(i)];
    places.rowwise() -= places.colwise().mean().eval();
    const Eigen::Matrix2d covariance = places.transpose() * places / static_cast<double>(n);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(covariance);
    const Eigen::VectorXd along = places * axes.eigenvectors().col(1);
    const Eigen::VectorXd across = places * axes.eigenvectors().col(0);
    Eigen::MatrixX3d powers(n, 3);
    powers << Eigen::VectorXd::Ones(n), along, along.cwiseAbs2();
    const Eigen::Vector3d parabola = powers.colPivHouseholderQr().solve(across);
    return std::abs(parabola[2]) * axes.eigenvalues()[1] / std::sqrt(axes.eigenvalues()[0]);
}

// "Notice how the caustic becomes curved instead of oval as it would on a Lambertian surface."
TEST(JensenClaims, TheBallsCausticIsOvalAtAlphaOneAndCurvedAtATenth) {
    EXPECT_LT(curvature_index(floor_of_the_picture(1)), 0.1);
    EXPECT_GT(curvature_index(floor_of_the_picture(0.1F)), 0.25);
}

}  // namespace
}  // namespace caustics
