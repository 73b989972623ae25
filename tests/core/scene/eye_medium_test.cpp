#include "core/scene/eye_medium.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/reference/light_trace.h"
#include "core/render/renderer.h"
#include "tests/support/build_scene.h"

namespace caustics {
namespace {

const Spectrum ink(0.2F, 0.5F, 1.1F);

// An open sheet of water at z = 0 over a floor; the camera looks down on it.
SceneDesc pool(double eye_height, const Spectrum& absorption, double fov = 60) {
    SceneDesc desc;
    desc.shapes = {support::horizontal("water", 0, 3, true, support::glass(1.33F, 1, absorption)),
                   support::horizontal("floor", -2, 3, true, support::diffuse(0.5F))};
    desc.lights = {support::directional_light({0, 0, -1}, 1)};
    desc.camera = support::camera({0, 0, eye_height}, {0, 0, -2}, {0, 1, 0}, fov, 8, 8);
    return desc;
}

void expect_medium(SceneDesc desc, const Vec3d& eye, const Spectrum& expected) {
    desc.camera = support::camera(eye, eye + Vec3d::UnitX(), Vec3d::UnitZ(), 60, 8, 8);
    const EyeMedium medium = eye_medium(Scene(std::move(desc)));
    EXPECT_TRUE((medium.absorption == expected).all()) << medium.absorption.transpose();
    EXPECT_FALSE(medium.ambiguous);
}

TEST(EyeMedium, IsOnTheEyesSideOfAnOpenSheet) {
    expect_medium(pool(1, ink), {0, 0, 1}, black());
    expect_medium(pool(1, ink), {0, 0, -0.01}, ink);
    expect_medium(pool(1, ink), {0.5, 1, -1.9}, ink);
}

TEST(EyeMedium, IsThatOfTheInnermostOfNestedBalls) {
    const Spectrum syrup(3, 2, 1);
    SceneDesc desc;
    desc.shapes = {
        support::sphere("outer", {0, 0, 0}, 2, support::glass(1.5F, 1, ink)),
        support::sphere("inner", {0, 0, 0}, 1, support::glass(1.33F, 1.5F, syrup, ink)),
        support::sphere("bubble", {0, 0, 0}, 0.5, support::glass(1, 1.33F, black(), syrup)),
        support::horizontal("floor", -3, 3, true, support::diffuse(0.5F))};
    expect_medium(desc, {5, 0, 0}, black());
    expect_medium(desc, {1.5, 0, 0}, ink);
    expect_medium(desc, {0, 0.7, 0}, syrup);
    expect_medium(desc, {0, 0.1, 0.2}, black());
}

TEST(EyeMedium, IsNotGuessedWhereDielectricsDisagree) {
    SceneDesc desc = pool(-1, ink);
    desc.shapes.push_back(support::sphere("ball", {0.5, 0, -1.5}, 0.3, support::glass(1.5F)));
    const EyeMedium medium = eye_medium(Scene(desc));
    EXPECT_TRUE(medium.ambiguous);
    EXPECT_TRUE(is_black(medium.absorption));
    desc.shapes.back().bsdf = support::glass(1.5F, 1.33F, black(), ink);
    EXPECT_FALSE(eye_medium(Scene(desc)).ambiguous);
}

TEST(SurfaceMedium, IsOnTheSideOfTheNormal) {
    const Scene scene(pool(1, ink));
    const auto at = [&](double z, double up) {
        return scene.medium_before(
            {Vec3d(0.3, -0.2, z).cast<float>(), Vec3d(0, 0, up).cast<float>(), 1e-5F});
    };
    ASSERT_NE(at(-2, 1), nullptr);
    EXPECT_TRUE((*at(-2, 1) == ink).all());
    EXPECT_EQ(at(-2, -1), nullptr) << "nothing is below the floor";
    ASSERT_NE(at(0.5, -1), nullptr);
    EXPECT_TRUE(is_black(*at(0.5, -1)));
    const Scene clear(pool(1, black()));
    EXPECT_EQ(clear.medium_before({Vec3(0, 0, -2), Vec3::UnitZ(), 1e-5F}), nullptr);
}

// Gives every point the radiance 1.
class Glow final : public CausticEstimator {
public:
    void radiance(std::span<const ReceiverPoint> points, std::span<Estimate> out,
                  QueryContext&) const override {
        for (std::size_t i = 0; i < points.size(); ++i) out[i] = {Spectrum::Ones(), black()};
    }
    void irradiance(std::span<const ReceiverPoint>, std::span<Estimate>,
                    QueryContext&) const override {}
};

TEST(EyeMedium, DimsWhatIsSeenByBeersLaw) {
    const Scene scene(pool(-0.5, ink));
    RunOptions options;
    options.samples_per_pixel = 1;
    const Film film = render(scene, Glow(), options).film;
    const std::vector<float>& depth = *film.find("depth.Z");
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        EXPECT_GT(depth[i], 1.49F);
        const Spectrum expected = (-ink * depth[i]).exp();
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(film.rgb("caustic", i)[c] / expected[c], 1, 1e-5);
    }
}

// The same paths with and without ink: through 2 m of water to the floor, and 1.5 m back to the eye.
TEST(EyeMedium, DimsLightThatIsConnectedToTheEye) {
    const auto brightness = [](const Spectrum& absorption) {
        const Scene scene(pool(-0.5, absorption, 3));
        const auto layer = build(scene, LightTraceParams{.paths = 200'000}, RunOptions{})
                               ->camera_layer(RunOptions{});
        SpectrumSum sum = SpectrumSum::Zero();
        for (const Spectrum& pixel : layer->radiance) sum += pixel.cast<double>();
        return sum;
    };
    // Of one channel, so that roulette, which weighs the channels, draws alike.
    const Spectrum grey = Spectrum::Constant(0.6F);
    const SpectrumSum ratio = brightness(grey) / brightness(black());
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(ratio[c] / std::exp(-0.6 * 3.5), 1, 2e-3);
}

}  // namespace
}  // namespace caustics
