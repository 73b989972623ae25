#include <gtest/gtest.h>

#include <cmath>

#include "core/reference/light_trace.h"
#include "core/reference/path_trace.h"
#include "photonmap/photon_map.h"
#include "tests/support/build_scene.h"
#include "tests/support/fresnel.h"
#include "tests/support/statistics.h"

namespace caustics {
namespace {

// A light before the mirror |x| <= 1, 0 <= z <= 2 of the plane y = 1, over the floor z = 0. By the
// method of images a point light of intensity I at S gives a floor point p the irradiance
//   E = I rho n.w / |S' - p|^2,  w = (S' - p) / |S' - p|,  S' the mirror image of S,
// where the segment from p to S' crosses the mirror, and 0 elsewhere.
const Vec3d light_position(0.5, 0.25, 1);
constexpr double mirror_intensity = 3;
constexpr double half_light = 0.15;
constexpr float light_radiance = 20;

Vec3d image_of(const Vec3d& s) { return {s.x(), 2 - s.y(), s.z()}; }

bool through_mirror(const Vec3d& p, const Vec3d& image) {
    const double t = (1 - p.y()) / (image.y() - p.y());
    const Vec3d crossing = p + t * (image - p);
    return t > 0 && t < 1 && std::abs(crossing.x()) <= 1 && crossing.z() >= 0 && crossing.z() <= 2;
}

double from_point(const Vec3d& p) {
    const Vec3d to_image = image_of(light_position) - p;
    if (!through_mirror(p, image_of(light_position))) return 0;
    return mirror_intensity * to_image.z() / std::pow(to_image.norm(), 3);
}

// A square light that faces the mirror: 64 x 64 images of points, cosines on both sides.
double from_square(const Vec3d& p) {
    constexpr int n = 64;
    double sum = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const Vec3d s = light_position +
                            half_light * Vec3d((2 * i + 1.0) / n - 1, 0, (2 * j + 1.0) / n - 1);
            const Vec3d to_image = image_of(s) - p;
            if (through_mirror(p, image_of(s)))
                sum += to_image.z() * to_image.y() / std::pow(to_image.squaredNorm(), 2);
        }
    return static_cast<double>(light_radiance) * sum * std::pow(2 * half_light / n, 2);
}

enum Shapes : std::size_t { floor_shape, mirror_shape };

SceneDesc mirror_scene(const Bsdf& mirror_bsdf) {
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", 0, 6, true, support::diffuse(0.5F)),
                   support::rectangle("mirror", {0, 1, 1}, {1, 0, 0}, {0, 0, 1}, mirror_bsdf)};
    return desc;
}

Scene with_point_light(const Bsdf& mirror_bsdf) {
    SceneDesc desc = mirror_scene(mirror_bsdf);
    desc.lights = {support::point_light(light_position, static_cast<float>(mirror_intensity))};
    return Scene(std::move(desc));
}

Scene with_square_light() {
    SceneDesc desc = mirror_scene(support::mirror());
    // u x v = +y, towards the mirror.
    desc.shapes.push_back(support::rectangle("light", light_position, {0, 0, half_light},
                                             {half_light, 0, 0}, support::diffuse(0)));
    desc.shapes.back().radiance = Spectrum(Spectrum::Constant(light_radiance));
    return Scene(std::move(desc));
}

// `count` points of the floor spread over |x - 0.3| < 0.6, -1 < y < 0.4, which lies inside the
// footprint with a margin of 0.1 for either light.
std::vector<ReceiverPoint> inside_points(const Scene& scene, std::size_t count, float radius) {
    std::vector<ReceiverPoint> points;
    for (std::size_t i = 0; i < count; ++i) {
        // The R2 sequence: an even spread without a grid.
        const double u = std::fmod(0.5 + 0.7548776662466927 * static_cast<double>(i), 1.0);
        const double v = std::fmod(0.5 + 0.5698402909980532 * static_cast<double>(i), 1.0);
        points.push_back(support::probe(scene, floor_shape, {-0.3 + 1.2 * u, -1 + 1.4 * v, 0},
                                        Vec3d::UnitZ(), i, radius));
    }
    return points;
}

// The mean of estimate / truth over 500 points, and its scatter, against its bounds.
// With N nearest of a Poisson process (N-1)/(pi r_N^2) has relative deviation 1/sqrt(N-2): 500
// points tell it to 1/sqrt(1000) = 3 %, so 20 % is 6 sigma. Their mean is sure to
// 1/sqrt(500 (N-2)) = 0.32 % while the discs do not overlap, so 1 % is 3 sigma.
template <typename Truth>
void expect_photon_map_is(const Scene& scene, const Truth& truth) {
    photonmap::PhotonMapParams params;
    params.photons = 600'000;
    params.nearest = 200;
    params.kernel = photonmap::KernelKind::point;
    const auto map = build(scene, params, RunOptions{});
    const std::vector<ReceiverPoint> points = inside_points(scene, 500, 0);
    const std::vector<Estimate> found = support::irradiance(*map, points);
    support::Moments ratio;
    for (std::size_t i = 0; i < points.size(); ++i)
        ratio.add(static_cast<double>(found[i].value.mean()) /
                  truth(points[i].position.cast<double>()));
    EXPECT_NEAR(ratio.mean(), 1, 0.01);
    EXPECT_NEAR(ratio.deviation() * std::sqrt(params.nearest - 2.0), 1, 0.2);
}

template <typename Truth>
void expect_within_stderr(const CausticEstimator& estimator, const Scene& scene, const Truth& truth,
                          float radius = 0.1F) {
    // Over a disc of 10 cm the irradiance differs from that at its centre by r^2 / 8 times its
    // relative Laplacian (about 3 / m^2): 4e-3, a tenth of a point's standard error.
    const std::vector<ReceiverPoint> points = inside_points(scene, 24, radius);
    const std::vector<Estimate> found = support::irradiance(estimator, points);
    support::Moments ratio;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double expected = truth(points[i].position.cast<double>());
        const auto error = static_cast<double>(found[i].standard_error.mean());
        EXPECT_GT(error, 0);
        EXPECT_LT(error, 0.15 * expected);
        EXPECT_LT(std::abs(static_cast<double>(found[i].value.mean()) - expected) / error,
                  support::sidak_bound(points.size()))
            << points[i].position.transpose() << ": " << found[i].value.mean() << " for "
            << expected;
        ratio.add(static_cast<double>(found[i].value.mean()) / expected);
    }
    EXPECT_NEAR(ratio.mean(), 1, 4 * ratio.standard_error());
}

// Points of the floor that no reflected light can reach: beside the footprint, behind the mirror.
void expect_dark_outside(const CausticEstimator& estimator, const Scene& scene) {
    std::vector<ReceiverPoint> points;
    for (const Vec3d& p : {Vec3d(-4, 0, 0), Vec3d(4, 0.5, 0), Vec3d(0, 2, 0), Vec3d(0.5, 4, 0)})
        points.push_back(
            support::probe(scene, floor_shape, p, Vec3d::UnitZ(), points.size(), 0.05F));
    for (const Estimate& e : support::irradiance(estimator, points))
        EXPECT_TRUE(is_black(e.value)) << e.value.transpose();
}

TEST(FlatMirror, PhotonMapOfAPointLight) {
    expect_photon_map_is(with_point_light(support::mirror()), from_point);
}

TEST(FlatMirror, PhotonMapOfASquareLight) {
    expect_photon_map_is(with_square_light(), from_square);
}

TEST(FlatMirror, PhotonMapIsDarkOutside) {
    const Scene scene = with_point_light(support::mirror());
    photonmap::PhotonMapParams params;
    params.photons = 100'000;
    params.max_radius = 0.1;
    expect_dark_outside(*build(scene, params, RunOptions{}), scene);
}

TEST(FlatMirror, LightTraceOfAPointLight) {
    const Scene scene = with_point_light(support::mirror());
    const auto reference = build(scene, LightTraceParams{.paths = 800'000}, RunOptions{});
    expect_within_stderr(*reference, scene, from_point);
    expect_dark_outside(*reference, scene);
}

// The whole disc lies in the shade of the shelf, which is nearer to it than its radius.
TEST(FlatMirror, LightTraceCountsNoLightOfAShelfAboveThePoint) {
    SceneDesc desc = mirror_scene(support::mirror());
    desc.shapes.push_back(support::rectangle("shelf", {0.3, -0.3, 0.03}, {0.3, 0, 0}, {0, 0.3, 0},
                                             support::diffuse(0.5F)));
    desc.lights = {support::point_light(light_position, static_cast<float>(mirror_intensity))};
    const Scene scene(std::move(desc));
    const auto reference = build(scene, LightTraceParams{.paths = 100'000}, RunOptions{});
    const std::vector<ReceiverPoint> points = {
        support::probe(scene, floor_shape, {0.3, -0.3, 0}, Vec3d::UnitZ(), 0, 0.05F)};
    EXPECT_TRUE(is_black(support::irradiance(*reference, points)[0].value));
}

TEST(FlatMirror, LightTraceOfASquareLight) {
    const Scene scene = with_square_light();
    expect_within_stderr(*build(scene, LightTraceParams{.paths = 1'500'000}, RunOptions{}), scene,
                         from_square);
}

TEST(FlatMirror, PathTraceOfASquareLight) {
    const Scene scene = with_square_light();
    const auto reference = build(scene, PathTraceParams{.spp = 40'000}, RunOptions{});
    expect_within_stderr(*reference, scene, from_square);
    expect_dark_outside(*reference, scene);
}

TEST(FlatMirror, AGlassSheetReflectsByFresnel) {
    const Scene scene = with_point_light(support::glass(1.5F));
    // The sheet's front (u x v = -y) is the light's side, so light arrives from outside.
    const auto truth = [](const Vec3d& p) {
        const Vec3d to_image = image_of(light_position) - p;
        return from_point(p) * support::fresnel(to_image.y() / to_image.norm(), 1.5);
    };
    const auto reference = build(scene, LightTraceParams{.paths = 4'000'000}, RunOptions{});
    // Few photons are reflected: wider discs, 9e-3 off at most.
    expect_within_stderr(*reference, scene, truth, 0.15F);
}

TEST(FlatMirror, ColoursReflectEachByItsShare) {
    const Spectrum colour(0.9F, 0.5F, 0.2F);
    const Scene scene = with_point_light({Conductor{colour}, true});
    const auto reference = build(scene, LightTraceParams{.paths = 200'000}, RunOptions{});
    const std::vector<ReceiverPoint> points = inside_points(scene, 5, 0.3F);
    for (const Estimate& e : support::irradiance(*reference, points))
        for (int channel = 0; channel < 3; ++channel)
            // Every particle has the mirror's colour: the ratio is exact to rounding.
            EXPECT_NEAR(e.value[channel] / e.value[0], colour[channel] / colour[0], 1e-4);
}

}  // namespace
}  // namespace caustics
