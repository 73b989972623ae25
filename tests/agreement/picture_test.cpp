#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/reference/light_trace.h"
#include "core/reference/path_trace.h"
#include "core/render/renderer.h"
#include "photonmap/photon_map.h"
#include "tests/support/build_scene.h"

namespace caustics {
namespace {

constexpr int width = 24;
constexpr int height = 18;

// A small tilted mirror throws one bright spot onto the floor, seen from above and aside: off
// centre on both axes, so that any exchange of left and right, up and down shows. The mirror
// |u|, |v| <= 0.15 about (0, 0, 1.5) sends light from straight above towards (1, 0.6, -1.5).
struct SpotScene {
    Vec3d spot{1, 0.6, 0};
    SceneDesc desc;

    explicit SpotScene(bool area_light) {
        const Vec3d middle(0, 0, 1.5);
        const Vec3d normal = ((spot - middle).normalized() + Vec3d::UnitZ()).normalized();
        const Vec3d u = normal.unitOrthogonal();
        desc.shapes = {support::horizontal("floor", 0, 6, true, support::diffuse(0.5F)),
                       support::rectangle("mirror", middle, 0.15 * u, 0.15 * normal.cross(u),
                                          support::mirror())};
        // Far enough that the spot is little larger than the mirror.
        const Vec3d light(0, 0, 12);
        if (area_light) {
            desc.shapes.push_back(support::horizontal("light", 0, 0.5, false, support::diffuse(0)));
            desc.shapes.back().to_world = Eigen::Translation3d(light) * desc.shapes.back().to_world;
            desc.shapes.back().radiance = Spectrum(Spectrum::Constant(100));
        } else {
            desc.lights = {support::point_light(light, 100)};
        }
        desc.camera = support::camera({-1, -5, 4}, {-0.5, 1.5, 0}, {0, 0, 1}, 40, width, height);
    }
};

Film picture(const Scene& scene, const CausticEstimator& estimator, int threads = 1,
             std::uint64_t seed = 1) {
    RunOptions options;
    options.samples_per_pixel = 16;
    options.threads = threads;
    options.seed = seed;
    return render(scene, estimator, options).film;
}

// Where the caustic's light is in the picture, in pixels.
Vec2d centroid(const Film& film) {
    Vec2d sum = Vec2d::Zero();
    double total = 0;
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        const auto value = static_cast<double>(film.rgb("caustic", i)[1]);
        sum += value *
               Vec2d(static_cast<double>(i % width) + 0.5, static_cast<double>(i / width) + 0.5);
        total += value;
    }
    EXPECT_GT(total, 0);
    return sum / total;
}

// By elementary geometry, apart from core/scene/camera: angles to the right of and above the view.
Vec2d expected_place(const Vec3d& p) {
    const Vec3d eye(-1, -5, 4);
    const Vec3d forward = (Vec3d(-0.5, 1.5, 0) - eye).normalized();
    const Vec3d right = forward.cross(Vec3d::UnitZ()).normalized();
    const Vec3d up = right.cross(forward);
    const Vec3d to_p = p - eye;
    const double scale = width / 2.0 / std::tan(20 * pi_d / 180) / to_p.dot(forward);
    return {width / 2.0 + scale * to_p.dot(right), height / 2.0 - scale * to_p.dot(up)};
}

// The spot, 0.4 m or 2.5 pixels wide, has its centroid within half a pixel of its middle: parallax
// over a spot of this size and a receiver point's jitter leave less.
void expect_at_the_spot(const Film& film, const Vec3d& spot) {
    const Vec2d expected = expected_place(spot);
    ASSERT_GT(expected.x(), width * 0.6);  // Right of the middle, and below it.
    ASSERT_GT(expected.y(), height * 0.58);
    EXPECT_LT((centroid(film) - expected).norm(), 0.5)
        << centroid(film).transpose() << " instead of " << expected.transpose();
}

TEST(Camera, TheSpotIsWhereItBelongsForEveryMethod) {
    const SpotScene with_point(false);
    const Scene point(with_point.desc);
    expect_at_the_spot(picture(point, *build(point, LightTraceParams{.paths = 50'000}, {})),
                       with_point.spot);
    photonmap::PhotonMapParams params;
    params.photons = 20'000;
    params.max_radius = 0.05;
    expect_at_the_spot(picture(point, *build(point, params, {})), with_point.spot);

    const SpotScene with_area(true);
    const Scene area(with_area.desc);
    expect_at_the_spot(picture(area, *build(area, LightTraceParams{.paths = 200'000}, {})),
                       with_area.spot);
    expect_at_the_spot(picture(area, *build(area, PathTraceParams{.spp = 256}, {})),
                       with_area.spot);
    expect_at_the_spot(picture(area, *build(area, params, {})), with_area.spot);
}

bool same(const Film& a, const Film& b) {
    if (a.planes().size() != b.planes().size()) return false;
    for (std::size_t i = 0; i < a.planes().size(); ++i)
        if (a.planes()[i].channel != b.planes()[i].channel ||
            a.planes()[i].values != b.planes()[i].values)
            return false;
    return true;
}

// The same picture bit for bit from one thread, two and three; another from another seed.
template <typename Params>
void expect_deterministic(const Scene& scene, const Params& params) {
    const auto whole_run = [&](int threads, std::uint64_t seed) {
        RunOptions options;
        options.samples_per_pixel = 16;
        options.threads = threads;
        options.seed = seed;
        return picture(scene, *build(scene, params, options), threads, seed);
    };
    const Film one = whole_run(1, 7);
    EXPECT_TRUE(same(one, whole_run(1, 7)));
    EXPECT_TRUE(same(one, whole_run(2, 7)));
    EXPECT_TRUE(same(one, whole_run(3, 7)));
    const Film other = whole_run(2, 8);
    EXPECT_NE(one.find("caustic.G")->size(), 0U);
    EXPECT_NE(*one.find("caustic.G"), *other.find("caustic.G"));
    EXPECT_NE(*one.find("depth.Z"), *other.find("depth.Z"));
}

TEST(Determinism, EveryMethodGivesTheSameBitsFromAnyNumberOfThreads) {
    const Scene scene(SpotScene(true).desc);
    expect_deterministic(scene, LightTraceParams{.paths = 30'000});
    expect_deterministic(scene, PathTraceParams{.spp = 16});
    photonmap::PhotonMapParams stored;
    stored.photons = 5'000;
    expect_deterministic(scene, stored);
    photonmap::PhotonMapParams emitted;
    emitted.photons = 0;
    emitted.emitted = 20'000;
    expect_deterministic(scene, emitted);
}

}  // namespace
}  // namespace caustics
