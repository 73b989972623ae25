#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <utility>

#include "core/geometry/tessellate.h"
#include "core/reference/light_trace.h"
#include "core/reference/path_trace.h"
#include "core/render/renderer.h"
#include "tests/support/build_scene.h"
#include "tests/support/picture_agreement.h"

namespace caustics {
namespace {

// Two references that share little but the surfaces' optics: particles from the light connected to
// the camera, and paths from the receiver that find the light.

Shape square_light(const Vec3d& centre, double half, float radiance) {
    Shape light = support::horizontal("light", 0, half, false, support::diffuse(0));
    light.to_world = Eigen::Translation3d(centre) * light.to_world;
    light.radiance = Spectrum(Spectrum::Constant(radiance));
    return light;
}

// A camera above that sees the middle of the floor.
SceneDesc over_floor(double half_view) {
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", 0, 6, true, support::diffuse(0.5F))};
    const double fov = 360 / pi_d * std::atan(half_view / 5);
    desc.camera = support::camera({0.1, -0.2, 5}, {0.1, -0.2, 0}, {0, 1, 0}, fov, 6, 6);
    return desc;
}

// Both pictures of a scene agree pixel by pixel, the ratio of their means being sure to `sigma`.
void expect_references_agree(SceneDesc desc, std::uint64_t light_paths, int eye_samples,
                             double sigma = 0.0075) {
    const Scene scene(std::move(desc));
    RunOptions options;
    options.samples_per_pixel = eye_samples;
    const auto light_trace = build(scene, LightTraceParams{.paths = light_paths}, options);
    const auto path_trace = build(scene, PathTraceParams{.spp = eye_samples}, options);
    EXPECT_EQ(support::disagreement(render(scene, *light_trace, options).film,
                                    render(scene, *path_trace, options).film, sigma),
              "");
}

TEST(References, AgreeOnAMirrorRing) {
    SceneDesc desc = over_floor(0.9);
    Shape ring;
    ring.name = "ring";
    ring.primitive = Primitive::cylinder;
    ring.to_world = Eigen::Translation3d(0, 0, 0.01) * Eigen::Scaling(1.0, 1.0, 0.5);
    ring.bsdf = support::mirror(0.9F);
    desc.shapes.push_back(ring);
    desc.shapes.push_back(square_light({1.5, 0.3, 1.6}, 0.6, 10));
    expect_references_agree(std::move(desc), 2'000'000, 20'000, 0.02);
}

TEST(References, AgreeOnAGlassBall) {
    SceneDesc desc = over_floor(1.2);
    desc.shapes.push_back(support::sphere("ball", {0.2, 0.1, 0.9}, 0.6,
                                          support::glass(1.5F, 1, Spectrum(0.5F, 0.2F, 0.1F))));
    // The camera looks from aside, past the ball, at what it focuses on the floor.
    desc.camera = support::camera({-3, 0.2, 2.5}, {-0.36, 0, 0}, {0, 0, 1}, 7, 6, 6);
    desc.shapes.push_back(square_light({1.5, 0.3, 3}, 0.8, 10));
    expect_references_agree(std::move(desc), 2'000'000, 20'000);
}

// The camera under the water, beside the floor's receiver: eye paths meet no interface.
SceneDesc under_water(Shape water) {
    SceneDesc desc = over_floor(1);
    desc.camera = support::camera({0.1, -0.2, 0.9}, {0.1, -0.2, 0}, {0, 1, 0}, 90, 6, 6);
    water.bsdf = support::glass(1.333F);
    desc.shapes.push_back(std::move(water));
    desc.shapes.push_back(square_light({0.5, 0.3, 3}, 1.2, 10));
    return desc;
}

Shape wavy(double amplitude) {
    Shape water;
    water.name = "water";
    water.primitive = Primitive::heightfield;
    water.field.half_size = Vec2d::Constant(2);
    water.field.waves = {{amplitude, {4, 1}, 0.3}, {0.7 * amplitude, {-2, 5}, 1}};
    water.to_world = Eigen::Translation3d(0, 0, 1);
    return water;
}

TEST(References, AgreeUnderAFlatPool) {
    expect_references_agree(under_water(support::horizontal("water", 1, 2, true, {})), 1'500'000,
                            20'000);
}

TEST(References, AgreeUnderAnExactWavyPool) {
    expect_references_agree(under_water(wavy(0.02)), 1'500'000, 20'000);
}

// Coarse triangles with normals of the smooth surface: shading and geometric normals differ by up
// to 0.2 rad, and paths from the eye need the correction that particles do without.
TEST(References, AgreeUnderACoarseSmoothShadedMesh) {
    const Shape exact = wavy(0.05);
    Shape water =
        support::mesh("water", tessellate_heightfield(exact.field, 12), exact.to_world, exact.bsdf);
    ASSERT_FALSE(water.mesh.normals.empty());
    expect_references_agree(under_water(std::move(water)), 1'500'000, 20'000);
}

TEST(References, AgreeOnASmoothShadedMirrorAndAGlossyFloor) {
    SceneDesc desc = over_floor(0.9);
    desc.shapes[0].bsdf = support::schlick(0.7F, 0.2F);
    const Shape exact = wavy(0.06);
    const Transform upright = Eigen::Translation3d(1.6, 0, 0.8) *
                              Eigen::AngleAxisd(-pi_d / 2, Vec3d::UnitY()) *
                              Eigen::Scaling(0.35, 0.8, 1.0);
    desc.shapes.push_back(support::mesh("mirror", tessellate_heightfield(exact.field, 10), upright,
                                        support::mirror()));
    desc.shapes.push_back(square_light({0.2, 0.3, 2}, 0.8, 10));
    desc.shapes.back().to_world.linear() =
        Eigen::AngleAxisd(-0.8, Vec3d::UnitY()) * desc.shapes.back().to_world.linear();
    expect_references_agree(std::move(desc), 3'000'000, 20'000, 0.03);
}

// A small mirror ball far from an emitting enclosure's wall reflects the wall's radiance L into
// its whole solid angle: irradiance pi L sin^2 at the wall point it stands over.
TEST(References, PathTraceSeesSmallBallsFarAway) {
    constexpr double d = 5;
    for (const double sine : {0.1, 0.03, 0.01, 3e-3, 1e-3, 5e-4}) {
        SceneDesc desc;
        desc.shapes = {support::enclosure(d, support::diffuse(0.5F)),
                       support::sphere("ball", Vec3d::Zero(), sine * d, support::mirror())};
        desc.shapes[0].radiance = Spectrum(Spectrum::Ones());
        const Scene scene(std::move(desc));
        const Vec3d outward(0.48, 0.6, 0.64);
        const auto path_trace = build(scene, PathTraceParams{.spp = 100'000}, RunOptions{});
        const Estimate found =
            support::irradiance(*path_trace, {support::probe(scene, 0, d * outward, -outward, 1)})
                .front();
        const double expected = pi_d * sine * sine;
        // Half of the paths go into the ball's cone: 1/sqrt(n) = 0.32 % a sigma.
        EXPECT_LT(found.standard_error[0], 0.004 * expected) << "r / d = " << sine;
        EXPECT_NEAR(static_cast<double>(found.value[0]) / expected, 1, 0.013) << "r / d = " << sine;
    }
}

}  // namespace
}  // namespace caustics
