#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "beamtree/beam_tree.h"
#include "beamtree/caustic_polygons.h"
#include "core/illumination_map/illumination_map.h"
#include "core/reference/indirect_path_trace.h"
#include "core/reference/light_trace.h"
#include "core/reference/path_trace.h"
#include "core/render/direct_light.h"
#include "core/render/eye_path.h"
#include "photonmap/global_photon_map.h"
#include "photonmap/photon_map.h"
#include "tests/support/build_scene.h"
#include "tests/support/fresnel.h"
#include "tests/support/statistics.h"

namespace caustics {
namespace {

const Spectrum ink(0.2F, 0.5F, 1.1F);

/// A method of the caustic layer, and the scatter of its answers beyond which a mean over 60 points is wrong.
struct LightWay {
    std::string name;
    std::function<std::unique_ptr<const CausticEstimator>(const Scene&)> make;
    double tolerance;
};

std::vector<LightWay> light_ways() {
    const auto map = [](auto change) {
        return [change](const Scene& scene) {
            photonmap::PhotonMapParams params;
            params.photons = 0;
            params.emitted = 200'000;
            params.nearest = 100;
            params.kernel = photonmap::KernelKind::point;
            change(params);
            return build(scene, params, {});
        };
    };
    using Map = photonmap::PhotonMapParams;
    return {
        {"photonmap", map([](Map&) {}), 0.03},
        {"photonmap stratified", map([](Map& p) { p.emission = Map::Emission::stratified; }), 0.03},
        {"photonmap split", map([](Map& p) { p.interaction = Interaction::split; }), 0.03},
        {"lighttrace",
         [](const Scene& scene) {
             return build(scene, LightTraceParams{.paths = 600'000, .radius = 0.1}, {});
         },
         0.03},
        {"illuminationmap",
         [](const Scene& scene) {
             return build(scene, IlluminationMapParams{.emitted = 400'000, .resolution = 32}, {});
         },
         0.03},
        {"beamtree",
         [](const Scene& scene) { return build(scene, beamtree::BeamTreeParams{}, {}); }, 0.01},
        {"causticpolygons",
         [](const Scene& scene) { return build(scene, beamtree::CausticPolygonsParams{}, {}); },
         0.01}};
}

using Truth = std::function<Spectrum(const Vec3d&)>;

// The mean of estimate / truth, each channel.
void expect_near(const LightWay& way, const Scene& scene, const std::vector<ReceiverPoint>& points,
                 const Truth& truth) {
    const std::vector<Estimate> found = support::irradiance(*way.make(scene), points);
    for (Eigen::Index channel = 0; channel < 3; ++channel) {
        support::Moments ratio;
        for (std::size_t i = 0; i < points.size(); ++i)
            ratio.add(static_cast<double>(found[i].value[channel]) /
                      static_cast<double>(truth(points[i].position.cast<double>())[channel]));
        EXPECT_NEAR(ratio.mean(), 1, way.tolerance) << way.name << ", channel " << channel;
    }
}

// Even over a rectangle.
std::vector<ReceiverPoint> points_on(const Scene& scene, std::size_t shape, const Vec3d& centre,
                                     const Vec3d& half_u, const Vec3d& half_v) {
    std::vector<ReceiverPoint> points;
    const Vec3d normal = half_u.cross(half_v).normalized();
    for (int i = 0; i < 60; ++i) {
        const double u = 2 * std::fmod(0.5 + 0.7548776662466927 * i, 1.0) - 1;
        const double v = 2 * std::fmod(0.5 + 0.5698402909980532 * i, 1.0) - 1;
        points.push_back(support::probe(scene, shape, centre + u * half_u + v * half_v, normal,
                                        static_cast<std::uint64_t>(i), 0.1F));
        const Vec3 n = normal.cast<float>();
        const auto hit = scene.intersect({points.back().position + 0.01F * n, -n});
        points.back().uv = hit.value().uv;
        points.back().shape = static_cast<std::uint32_t>(shape);
    }
    return points;
}

// Sunlight goes down into water, and a mirror under it turns it level, on to a wall: 2.5 m by any way.
// Shapes: water, mirror, wall.
SceneDesc mirror_under_water() {
    SceneDesc desc;
    desc.shapes = {
        support::horizontal("water", 0, 0.8, true, support::glass(1.33F, 1, ink)),
        support::rectangle("mirror", {0, 0, -1}, {0, -0.5, 0}, {0.5, 0, -0.5}, support::mirror()),
        support::rectangle("wall", {1.5, 0, -1}, {0, -0.5, 0}, {0, 0, 0.5},
                           support::diffuse(0.5F))};
    desc.lights = {support::directional_light({0, 0, -1}, 3)};
    return desc;
}

TEST(Medium, GoesOnBehindAMirrorUnderWater) {
    const Scene scene(mirror_under_water());
    const auto points = points_on(scene, 2, {1.5, 0, -1}, {0, -0.4, 0}, {0, 0, 0.4});
    const Spectrum expected =
        (-2.5F * ink).exp() * 3 * static_cast<float>(1 - support::fresnel(1, 1.33));
    for (const LightWay& way : light_ways())
        expect_near(way, scene, points, [&](const Vec3d&) { return expected; });
}

TEST(Medium, OfTheEyesPathGoesOnBehindAMirror) {
    const Scene scene(mirror_under_water());
    const Spectrum clear = black();
    Rng rng(1, Stage::test, 0);
    std::vector<WeightedPoint> points;
    trace_eye_path(scene, {Vec3(0.1F, 0, 2), -Vec3::UnitZ()}, clear, rng, points);
    ASSERT_EQ(points.size(), 1U);
    // Of both ways at the water the eye has drawn one, at its share of the light.
    for (Eigen::Index i = 0; i < 3; ++i)
        EXPECT_NEAR(points[0].weight[i], std::exp(-2.5F * ink[i]) / (1.33F * 1.33F), 1e-5F);
    ASSERT_NE(points[0].point.medium, nullptr);
    EXPECT_TRUE((*points[0].point.medium == ink).all());
}

// Ink of index 1 without end above a surface, up to the height of a mast: light from afar begins there. Shapes: floor,
// surface, mast.
SceneDesc ink_without_end() {
    SceneDesc desc;
    desc.shapes = {
        support::horizontal("floor", 0, 0.4, true, support::diffuse(0.5F)),
        support::horizontal("surface", 1, 2, true, support::glass(1, 1, black(), ink)),
        support::rectangle("mast", {1.95, 0, 2}, {0, 0.05, 0}, {0, 0, 1}, support::diffuse(0))};
    return desc;
}

TEST(Medium, WithoutEndAbsorbsLightFromAfarFromTheBoundsOn) {
    SceneDesc desc = ink_without_end();
    desc.lights = {support::directional_light({0, 0, -1}, 3)};
    const Scene sunny(desc);
    const Spectrum two_metres = (-2 * ink).exp();
    const auto points = points_on(sunny, 0, {0, 0, 0}, {0.3, 0, 0}, {0, 0.3, 0});
    for (const LightWay& way : light_ways())
        expect_near(way, sunny, points, [&](const Vec3d&) { return 3 * two_metres; });
    Rng rng(1, Stage::test, 0);
    const Spectrum through = direct_radiance(sunny, points[0], rng, Shadows::transparent);
    for (Eigen::Index i = 0; i < 3; ++i)
        EXPECT_NEAR(through[i] * pi / 0.5F, 3 * two_metres[i], 1e-5F);

    desc.lights = {ConstantLight{Spectrum::Ones()}};
    const Scene grey(desc);
    std::vector<WeightedPoint> met;
    const EyePath up =
        trace_eye_path(grey, {Vec3(0.1F, 0, 0.5F), Vec3::UnitZ()}, black(), rng, met);
    for (Eigen::Index i = 0; i < 3; ++i) EXPECT_NEAR(up.emitted[i], two_metres[i], 1e-5F);
    const auto traced = support::irradiance(*build(grey, PathTraceParams{.spp = 4000}, {}), points);
    const auto of_path = [&](const Vec3d& at) -> Spectrum {
        for (std::size_t i = 0; i < points.size(); ++i)
            if (points[i].position.cast<double>() == at) return traced[i].value;
        return black();
    };
    for (const LightWay& way : light_ways())
        if (way.name == "lighttrace") expect_near(way, grey, points, of_path);
}

// A lamp before a mirror over a floor, all in ink of index 1, whose surface above reflects nothing: light that
// comes by the mirror is that of the lamp's image. Shapes: floor, mirror, surface.
const Vec3d lamp(0.5, 0.25, 1);
Vec3d image_of(const Vec3d& s) { return {s.x(), 2 - s.y(), s.z()}; }

SceneDesc in_ink() {
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", 0, 2, true, support::diffuse(0.5F)),
                   support::rectangle("mirror", {0, 1, 1}, {1, 0, 0}, {0, 0, 1}, support::mirror()),
                   support::horizontal("surface", 2.5, 1, true, support::glass(1, 1, ink))};
    return desc;
}
Scene point_in_ink() {
    SceneDesc desc = in_ink();
    desc.lights = {support::point_light(lamp, 3)};
    return Scene(std::move(desc));
}
Scene square_in_ink(const Vec3d& half_u, const Vec3d& half_v) {
    SceneDesc desc = in_ink();
    desc.shapes.push_back(support::rectangle("lamp", lamp, half_u, half_v, support::diffuse(0)));
    desc.shapes.back().radiance = Spectrum(Spectrum::Constant(20));
    return Scene(std::move(desc));
}
std::vector<ReceiverPoint> floor_points(const Scene& scene) {
    return points_on(scene, 0, {0.3, -0.3, 0}, {0.6, 0, 0}, {0, 0.6, 0});
}

Spectrum from_point(const Vec3d& p, const Vec3d& at) {
    const Vec3d way = at - p;
    return (-ink * static_cast<float>(way.norm())).exp() *
           static_cast<float>(3 * way.z() / std::pow(way.norm(), 3));
}

// `mirrored` by the mirror y = 1, or straight.
Spectrum from_square(const Vec3d& p, const Vec3d& half_u, const Vec3d& half_v, bool mirrored) {
    constexpr int n = 24;
    SpectrumSum sum = SpectrumSum::Zero();
    const Vec3d area = half_u.cross(half_v) * 4 / (n * n);
    const Vec3d facing = mirrored ? Vec3d(area.x(), -area.y(), area.z()) : area;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const Vec3d s =
                lamp + ((2 * i + 1.0) / n - 1) * half_u + ((2 * j + 1.0) / n - 1) * half_v;
            const Vec3d way = (mirrored ? image_of(s) : s) - p;
            sum += (-ink.cast<double>() * way.norm()).exp() * 20 * way.z() *
                   std::max(0.0, -facing.dot(way)) / std::pow(way.squaredNorm(), 2);
        }
    return sum.cast<float>();
}

TEST(Medium, OfALampAbsorbsOnTheWayToAMirrorAndOn) {
    const Scene scene = point_in_ink();
    for (const LightWay& way : light_ways())
        expect_near(way, scene, floor_points(scene),
                    [](const Vec3d& p) { return from_point(p, image_of(lamp)); });
}

TEST(Medium, OfALampWithAreaToo) {
    const Vec3d u(0, 0, 0.2);
    const Vec3d v(0.3, 0, 0);
    const Scene scene = square_in_ink(u, v);
    std::vector<LightWay> ways;
    for (const LightWay& way : light_ways())
        if (way.name == "photonmap" || way.name == "lighttrace" || way.name == "beamtree")
            ways.push_back(way);
    ways.push_back({"pathtrace",
                    [](const Scene& s) { return build(s, PathTraceParams{.spp = 1'500}, {}); },
                    0.03});
    for (const LightWay& way : ways)
        expect_near(way, scene, floor_points(scene),
                    [&](const Vec3d& p) { return from_square(p, u, v, true); });
}

// The square lamp faces down and sees no dielectric itself: what it lights does.
TEST(Medium, OfALampAbsorbsItsDirectLight) {
    const Scene points = point_in_ink();
    const Vec3d u(0.15, 0, 0);
    const Vec3d v(0, -0.15, 0);
    const Scene squares = square_in_ink(u, v);
    const ReceiverPoint p = support::probe(points, 0, {0.1, -0.4, 0}, Vec3d::UnitZ(), 0);
    for (const Shadows shadows : {Shadows::opaque, Shadows::transparent}) {
        Rng rng(1, Stage::test, 0);
        const Spectrum point = direct_radiance(points, p, rng, shadows) * (pi / 0.5F);
        SpectrumSum square = SpectrumSum::Zero();
        const ReceiverPoint q = support::probe(squares, 0, {0.1, -0.4, 0}, Vec3d::UnitZ(), 0);
        constexpr int samples = 40'000;
        for (int i = 0; i < samples; ++i)
            square += direct_radiance(squares, q, rng, shadows).cast<double>();
        const Spectrum of_point = from_point({0.1, -0.4, 0}, lamp);
        const Spectrum of_square = from_square({0.1, -0.4, 0}, u, v, false);
        for (Eigen::Index i = 0; i < 3; ++i) {
            EXPECT_NEAR(point[i] / of_point[i], 1, 1e-5F);
            EXPECT_NEAR(square[i] * pi_d / 0.5 / samples / static_cast<double>(of_square[i]), 1,
                        0.01);
        }
    }
}

// A hollow ball of radius 1 full of ink, a lamp of 1 W/sr in its middle; a speck of clear glass, of index 1 as all
// else, says what is round it. Walls are diffuse, or mirrors in part. Shapes: wall, speck.
SceneDesc ball_of_ink(const Bsdf& wall) {
    SceneDesc desc;
    desc.shapes = {
        support::enclosure(1, wall),
        support::sphere("speck", {0.1, 0.05, 0.3}, 0.02, support::glass(1, 1, black(), ink))};
    desc.lights = {support::point_light({0, 0, 0}, 1)};
    return desc;
}
std::vector<ReceiverPoint> ink_wall_points(const Scene& scene) {
    std::vector<ReceiverPoint> points;
    constexpr int count = 96;
    for (int i = 0; i < count; ++i) {
        const double z = (2 * i + 1.0) / count - 1;
        const double angle = i * pi_d * (3 - std::sqrt(5.0));
        const double across = std::sqrt(1 - z * z);
        const Vec3d out(across * std::cos(angle), across * std::sin(angle), z);
        points.push_back(support::probe(scene, 0, out, -out, static_cast<std::uint64_t>(i), 0.1F));
        points.back().medium = &std::get<Dielectric>(scene.shapes()[1].bsdf.model).ext_absorption;
    }
    return points;
}

// From wall to wall evenly: the mean of e^(-2 sigma cos) over a cosine lobe.
double even_share(double sigma) {
    const double a = 2 * sigma;
    return 2 * (1 - std::exp(-a) * (1 + a)) / (a * a);
}

TEST(Medium, AbsorbsLightBetweenSurfaces) {
    constexpr float rho = 0.6F;
    const Scene scene(ball_of_ink(support::diffuse(rho)));
    const auto points = ink_wall_points(scene);
    IndirectLightTraceParams traced;
    traced.paths = 400'000;
    photonmap::GlobalMapParams map{.photons = 300'000, .nearest = 200, .gather = 0};
    photonmap::GlobalMapParams gathered{.photons = 200'000, .nearest = 100, .gather = 400};
    std::vector<std::pair<std::string, std::unique_ptr<const IndirectEstimator>>> ways;
    ways.emplace_back("lighttrace", build(scene, traced, {}));
    ways.emplace_back("globalphotonmap", build(scene, map, {}));
    ways.emplace_back("globalphotonmap, gathered", build(scene, gathered, {}));
    for (const auto& [name, way] : ways) {
        SpectrumSum sum = SpectrumSum::Zero();
        for (const Estimate& e : support::irradiance(*way, points))
            sum += e.value.cast<double>() / static_cast<double>(points.size());
        for (Eigen::Index i = 0; i < 3; ++i) {
            const auto sigma = static_cast<double>(ink[i]);
            const double kept = static_cast<double>(rho) * even_share(sigma);
            EXPECT_NEAR(sum[i] / (std::exp(-sigma) * kept / (1 - kept)), 1, 0.03) << name << i;
        }
    }
}

// A mirror that is a receiver too sends light through the middle, again and again.
TEST(Medium, AbsorbsBetweenEventsOfAMirror) {
    constexpr double weight = 0.4;
    Bsdf wall = support::diffuse(0.5F);
    wall.mirror = MirrorPart{static_cast<float>(weight), Spectrum(Spectrum::Ones())};
    const Scene scene(ball_of_ink(wall));
    std::vector<LightWay> ways = light_ways();
    for (const std::string name : {"photonmap", "photonmap split", "lighttrace"}) {
        const auto way = std::ranges::find(ways, name, &LightWay::name);
        const Spectrum q = static_cast<float>(weight) * (-2 * ink).exp();
        const Spectrum expected = (-ink).exp() * q / (1 - q);
        LightWay even = *way;
        even.tolerance = 0.04;
        expect_near(even, scene, ink_wall_points(scene), [&](const Vec3d&) { return expected; });
    }
}

TEST(LightMedia, AreThoseOfTheDielectricsAbout) {
    SceneDesc desc = in_ink();
    desc.lights = {support::point_light(lamp, 1), support::point_light({0, 0, 4}, 1),
                   support::directional_light({0, 0, -1}, 1)};
    const Scene scene(desc);
    const std::vector<PlaceMedium>& media = scene.light_media();
    ASSERT_NE(media[0].absorption, nullptr);
    EXPECT_TRUE((*media[0].absorption == ink).all());
    ASSERT_NE(media[1].absorption, nullptr);
    EXPECT_TRUE(is_black(*media[1].absorption));
    EXPECT_EQ(media[2].absorption, nullptr);
    desc.shapes.push_back(support::sphere("ball", {1, -1, 1}, 0.3, support::glass(1.5F)));
    const Scene others(desc);
    EXPECT_TRUE(others.light_media()[0].ambiguous);
    EXPECT_FALSE(others.light_media()[1].ambiguous);
}

}  // namespace
}  // namespace caustics
