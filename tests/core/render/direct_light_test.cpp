#include "core/render/direct_light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/build_scene.h"
#include "tests/support/fresnel.h"
#include "tests/support/statistics.h"

namespace caustics {
namespace {

constexpr float reflectance = 0.5F;

SceneDesc floor_scene(const Bsdf& bsdf = support::diffuse(reflectance)) {
    SceneDesc desc;
    desc.shapes.push_back(support::horizontal("floor", 0, 5, true, bsdf));
    return desc;
}

support::Moments direct(const Scene& scene, const Vec3d& at, const Vec3& wo = Vec3::UnitZ()) {
    ReceiverPoint point = support::probe(scene, 0, at, Vec3d::UnitZ(), 0);
    point.wo = wo;
    support::Moments moments;
    for (std::uint64_t i = 0; i < 20'000; ++i) {
        Rng rng(1, Stage::test, i);
        const Spectrum value = direct_radiance(scene, point, rng);
        EXPECT_TRUE(is_finite(value));
        moments.add(static_cast<double>(value[1]));
    }
    return moments;
}

TEST(DirectLight, OfAPointFallsWithTheSquareAndTheCosine) {
    SceneDesc desc = floor_scene();
    desc.lights.push_back(support::point_light({0, 0, 2}, 7));
    const Scene scene(std::move(desc));
    const double expected = 7.0 / (1 + 4) * (2 / std::sqrt(5.0)) * 0.5 / pi_d;
    EXPECT_NEAR(direct(scene, {1, 0, 0}).mean(), expected, 1e-5);
}

TEST(DirectLight, OfADirectionIsItsIrradianceTimesTheCosine) {
    SceneDesc desc = floor_scene();
    desc.lights.push_back(support::directional_light({1, 0, -1}, 3));
    const Scene scene(std::move(desc));
    EXPECT_NEAR(direct(scene, {1, 0, 0}).mean(), 3 * std::sqrt(0.5) * 0.5 / pi_d, 1e-5);
}

// On the axis of a parallel disc E = pi L R^2 / (R^2 + d^2).
TEST(DirectLight, OfADiscIsTheClosedForm) {
    for (const double radius : {0.1, 1.0, 10.0}) {
        SceneDesc desc = floor_scene();
        Shape lamp = support::horizontal("lamp", 2, radius, false, support::diffuse(0));
        lamp.primitive = Primitive::disk;
        lamp.radiance = Spectrum(Spectrum::Constant(4));
        desc.shapes.push_back(lamp);
        const Scene scene(std::move(desc));
        const support::Moments value = direct(scene, {0, 0, 0});
        const double expected = 4 * 0.5 * radius * radius / (radius * radius + 4);
        EXPECT_NEAR(value.mean(), expected, 4 * value.standard_error() + 1e-5 * expected) << radius;
    }
}

// In two halves, as paths use it: samples of the lights, and what rays along samples of the BSDF meet.
TEST(DirectLight, IsSamplesOfLightsAndWhatRaysMeet) {
    for (const double radius : {0.1, 10.0}) {
        SceneDesc desc = floor_scene();
        Shape lamp = support::horizontal("lamp", 2, radius, false, support::diffuse(0));
        lamp.primitive = Primitive::disk;
        lamp.radiance = Spectrum(Spectrum::Constant(4));
        desc.shapes.push_back(lamp);
        const Scene scene(std::move(desc));
        const ReceiverPoint p = support::probe(scene, 0, {0, 0, 0}, Vec3d::UnitZ(), 0);
        support::Moments value;
        for (std::uint64_t i = 0; i < 20'000; ++i) {
            Rng rng(1, Stage::test, i);
            Spectrum light = sampled_light(scene, p, rng, Cosine::geometric);
            const float u0 = rng.next(), u1 = rng.next();
            const Vec3 wi = *sample_direction(*p.bsdf, p.shading_normal, p.wo, u0, u1, 0);
            const auto hit = scene.intersect(spawn_ray({p.position, wi, p.offset}, wi));
            const MetLight met = met_light(scene, hit, wi, hit ? hit->distance : 0);
            const float pdf = direction_pdf(*p.bsdf, p.shading_normal, p.wo, wi);
            light += reflectance * met.radiance * (pdf / (met.pdf + pdf));
            value.add(static_cast<double>(light[1]));
        }
        const double expected = 4 * 0.5 * radius * radius / (radius * radius + 4);
        EXPECT_NEAR(value.mean(), expected, 4 * value.standard_error() + 1e-5 * expected) << radius;
    }
}

TEST(DirectLight, IsFluxOfTheTrueAreaByTheGeometricCosine) {
    SceneDesc desc = floor_scene();
    desc.lights.push_back(support::directional_light({1, 0, -1}, 3));
    const Scene scene(std::move(desc));
    ReceiverPoint p = support::probe(scene, 0, {0, 0, 0}, Vec3d::UnitZ(), 0);
    p.shading_normal = Vec3(-1, 0, 1).normalized();
    Rng rng(1, Stage::test, 0);
    const double along = 3 * 0.5 / pi_d;
    EXPECT_NEAR(static_cast<double>(sampled_light(scene, p, rng, Cosine::shading)[0]), along, 1e-5);
    EXPECT_NEAR(static_cast<double>(sampled_light(scene, p, rng, Cosine::geometric)[0]),
                along * std::sqrt(0.5), 1e-5);
}

// E = pi L (R/d)^2 cos of a whole sphere above the horizon.
TEST(DirectLight, OfASphereIsTheClosedForm) {
    SceneDesc desc = floor_scene();
    desc.shapes.push_back(support::sphere("lamp", {1, 0, 3}, 0.8, support::diffuse(0)));
    desc.shapes.back().radiance = Spectrum(Spectrum::Constant(4));
    const Scene scene(std::move(desc));
    const support::Moments value = direct(scene, {0, 0, 0});
    EXPECT_NEAR(value.mean(), 4 * 0.5 * 0.64 / 10 * 3 / std::sqrt(10.0),
                4 * value.standard_error());
}

// All directions lit: the albedo, here the closed form of Schlick at alpha = 1.
TEST(DirectLight, OfASkyIsTheAlbedo) {
    for (const double v : {1.0, 0.4}) {
        SceneDesc desc = floor_scene(support::schlick(1, 1));
        Shape sky = support::enclosure(20, support::diffuse(0));
        sky.radiance = Spectrum(Spectrum::Ones());
        desc.shapes.push_back(sky);
        const Scene scene(std::move(desc));
        const Vec3 wo = Vec3d(std::sqrt(1 - v * v), 0, v).cast<float>();
        const support::Moments value = direct(scene, {0, 0, 0}, wo);
        EXPECT_NEAR(value.mean(), 1.25 - 2 * v / 3, 4 * value.standard_error()) << v;
    }
}

// A pane of glass between a light and the floor below it.
SceneDesc under_a_pane(const Spectrum& absorption = black()) {
    SceneDesc desc = floor_scene();
    desc.shapes.push_back(
        support::horizontal("top", 1.2, 5, true, support::glass(1.5F, 1, absorption)));
    desc.shapes.push_back(
        support::horizontal("bottom", 1, 5, false, support::glass(1.5F, 1, absorption)));
    return desc;
}

Spectrum transparent(const Scene& scene, const Vec3d& at) {
    Rng rng(1, Stage::test, 0);
    return direct_radiance(scene, support::probe(scene, 0, at, Vec3d::UnitZ(), 0), rng,
                           Shadows::transparent);
}

// (1 - F)^2 / d^2 straight through the pane, F at the angle outside of it.
TEST(DirectLight, GoesStraightThroughGlassWhereShadowsAreTransparent) {
    SceneDesc desc = under_a_pane();
    desc.lights = {support::point_light({0, 0, 2}, 7)};
    const Scene scene(std::move(desc));
    for (const double x : {0.0, 1.0, 4.0}) {
        const double distance2 = 4 + x * x;
        const double cosine = 2 / std::sqrt(distance2);
        const double passed = std::pow(1 - support::fresnel(cosine, 1.5), 2);
        EXPECT_NEAR(static_cast<double>(transparent(scene, {x, 0, 0})[0]),
                    7 / distance2 * cosine * 0.5 / pi_d * passed, 1e-5)
            << x;
    }
    EXPECT_EQ(direct(scene, {0, 0, 0}).mean(), 0);
}

// Integral over wavelengths of c_k (1 - F)^2, channel by channel.
TEST(DirectLight, PassesDispersiveGlassAtEveryWavelengthOnItsStraightWay) {
    const Ior law = Ior::cauchy(1.2, 0.08);
    SceneDesc desc = floor_scene();
    for (const double z : {1.2, 1.0}) {
        desc.shapes.push_back(support::horizontal("face", z, 5, z > 1.1, support::glass(1.5F)));
        std::get<Dielectric>(desc.shapes.back().bsdf.model).int_ior = law;
    }
    desc.lights = {support::directional_light({0, 0, -1}, 3)};
    SpectrumSum expected = SpectrumSum::Zero();
    for (double nm = shortest_wavelength + 0.5; nm < longest_wavelength; ++nm) {
        const double n = law.at(static_cast<float>(nm));
        const double reflected = std::pow((n - 1) / (n + 1), 2);
        expected += channel_density(nm) * std::pow(1 - reflected, 2) * 3 * 0.5 / pi_d;
    }
    const Spectrum value = transparent(Scene(std::move(desc)), {0, 0, 0});
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(static_cast<double>(value[c]) / expected[c], 1, 2e-4) << c;
}

// By Beer's law between, from a light far away, and from one inside the glass.
TEST(DirectLight, IsAbsorbedOnItsStraightWay) {
    SceneDesc far = under_a_pane(Spectrum(1, 2, 0));
    far.lights = {support::directional_light({0, 0, -1}, 3)};
    const double passed = std::pow(1 - support::fresnel(1, 1.5), 2) * 3 * 0.5 / pi_d;
    const Spectrum value = transparent(Scene(std::move(far)), {0, 0, 0});
    EXPECT_NEAR(static_cast<double>(value[0]), passed * std::exp(-0.2), 1e-5);
    EXPECT_NEAR(static_cast<double>(value[1]), passed * std::exp(-0.4), 1e-5);
    EXPECT_NEAR(static_cast<double>(value[2]), passed, 1e-5);
    SceneDesc inside = under_a_pane(Spectrum(1, 2, 0));
    inside.lights = {support::point_light({0, 0, 1.1}, 7)};
    EXPECT_NEAR(static_cast<double>(transparent(Scene(std::move(inside)), {0, 0, 0})[1]),
                7 / 1.21 * 0.5 / pi_d * (1 - support::fresnel(1, 1.5)) * std::exp(-0.2), 1e-5);
}

TEST(DirectLight, OfALampBehindGlassIsItsLightTimesWhatPasses) {
    SceneDesc desc = under_a_pane();
    desc.shapes.push_back(support::horizontal("lamp", 2, 0.02, false, support::diffuse(0)));
    desc.shapes.back().radiance = Spectrum(Spectrum::Constant(1e4F));
    const Scene scene(std::move(desc));
    support::Moments value;
    const ReceiverPoint point = support::probe(scene, 0, {0, 0, 0}, Vec3d::UnitZ(), 0);
    for (std::uint64_t i = 0; i < 2'000; ++i) {
        Rng rng(1, Stage::test, i);
        value.add(static_cast<double>(direct_radiance(scene, point, rng, Shadows::transparent)[1]));
    }
    const double expected =
        1e4 * 0.04 * 0.04 / 4 * 0.5 / pi_d * std::pow(1 - support::fresnel(1, 1.5), 2);
    EXPECT_NEAR(value.mean(), expected, 4 * value.standard_error() + 1e-3 * expected);
}

// Mirrors and walls shade as ever.
TEST(DirectLight, IsStoppedByAllElseWhereShadowsAreTransparent) {
    SceneDesc desc = under_a_pane();
    desc.lights = {support::point_light({0, 0, 2}, 7)};
    desc.shapes.push_back(support::sphere("ball", {0, 0, 0.5}, 0.2, support::mirror()));
    EXPECT_TRUE(is_black(transparent(Scene(std::move(desc)), {0, 0, 0})));
}

TEST(DirectLight, IsBlackInShadowBehindLampsAndBelow) {
    SceneDesc shadow = floor_scene();
    shadow.lights.push_back(support::point_light({0, 0, 2}, 7));
    shadow.lights.push_back(support::directional_light({0, 0, -1}, 7));
    shadow.shapes.push_back(support::sphere("glass", {0, 0, 1}, 0.2, support::glass(1.5F)));
    EXPECT_EQ(direct(Scene(std::move(shadow)), {0, 0, 0}).mean(), 0);

    SceneDesc behind = floor_scene();
    behind.shapes.push_back(support::horizontal("lamp", 2, 1, true, support::diffuse(0)));
    behind.shapes.back().radiance = Spectrum(Spectrum::Ones());
    EXPECT_EQ(direct(Scene(std::move(behind)), {0, 0, 0}).mean(), 0);

    SceneDesc below = floor_scene();
    below.lights.push_back(support::point_light({0, 0, -2}, 7));
    EXPECT_EQ(direct(Scene(std::move(below)), {0, 0, 0}).mean(), 0);
}

}  // namespace
}  // namespace caustics
