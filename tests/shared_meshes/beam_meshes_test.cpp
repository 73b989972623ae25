#include <gtest/gtest.h>

#include <cmath>

#include "beamtree/beam_tree.h"
#include "core/light_path/aimed_emission.h"
#include "core/mesh/mesh_io.h"
#include "tests/support/build_scene.h"
#include "tests/support/light_flux.h"
#include "tests/support/statistics.h"

namespace caustics {
namespace {

/// A mesh of glass, turned and scaled into a cube of 0.8 m round (0, 0, 1.2) over a floor, under a lamp.
SceneDesc over_a_floor(const std::string& file, const Eigen::AngleAxisd& turn, const Bsdf& bsdf) {
    TriangleMesh mesh = load_mesh(std::filesystem::path(CAUSTICS_SHARED_DIR) / "meshes" / file, {});
    Box box;
    for (const Vec3& p : mesh.positions) box.extend(p);
    const double scale = 0.8 / static_cast<double>(box.sizes().maxCoeff());
    const Transform place = Eigen::Translation3d(0, 0, 1.2) * turn * Eigen::Scaling(scale) *
                            Eigen::Translation3d(-box.center().cast<double>());
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", 0, 2, true, support::diffuse(0.5F)),
                   support::mesh("mesh", std::move(mesh), place, bsdf)};
    desc.lights = {support::point_light({0.3, -0.2, 4}, 10)};
    return desc;
}

struct RealMesh {
    const char* file;
    float ior;
    double x_turn;  ///< round the x axis [rad]
    int max_bounces;
    double least_captured;
    double tolerance;  ///< of the floor's flux
};

class BeamsOfRealMeshes : public testing::TestWithParam<RealMesh> {};

// No number that is none, and what photons bring to the floor: both see one mesh.
TEST_P(BeamsOfRealMeshes, BringTheirFluxToTheFloor) {
    const RealMesh& real = GetParam();
    const Scene scene(over_a_floor(real.file, Eigen::AngleAxisd(real.x_turn, Vec3d::UnitX()),
                                   support::glass(real.ior)));
    beamtree::BeamTreeParams params;
    params.bound = beamtree::Bound::two_slice;
    params.hierarchy = beamtree::BeamTreeParams::Tree::binned;
    params.leaf = beamtree::BeamTreeParams::Leaf::fixed;
    params.intensity = beamtree::Intensity::refined;
    params.max_bounces = real.max_bounces;
    const auto method = build(scene, params, {});
    EXPECT_GT(method->build_report().resolved.at("flux_share_captured"), real.least_captured);
    constexpr int side = 80;
    Rng rng(4, Stage::test, 0);
    std::vector<ReceiverPoint> points;
    for (int i = 0; i < side * side; ++i) {
        const double u = (i % side + static_cast<double>(rng.next())) / side;
        const double v = (i / side + static_cast<double>(rng.next())) / side;
        points.push_back(support::probe(scene, 0, {4 * u - 2, 4 * v - 2, 0}, Vec3d::UnitZ(), 0));
    }
    support::Moments irradiance;
    for (const Estimate& e : support::irradiance(*method, points)) {
        ASSERT_TRUE(e.value.allFinite());
        ASSERT_GE(e.value.minCoeff(), 0);
        irradiance.add(static_cast<double>(e.value.mean()));
    }
    const AimedEmission emission(scene);
    const auto photons =
        support::flux_by_shape(scene, support::aimed(emission), 60'000, 2, real.max_bounces);
    const double error = std::sqrt(std::pow(photons.standard_error[0], 2) +
                                   std::pow(16 * irradiance.standard_error(), 2));
    EXPECT_NEAR(16 * irradiance.mean() / photons.mean[0], 1,
                real.tolerance + 3 * error / photons.mean[0]);
}

INSTANTIATE_TEST_SUITE_P(All, BeamsOfRealMeshes,
                         testing::Values(RealMesh{"tungsten/water.ply", 1.333F, pi_d / 2, 1, 0.99,
                                                  0.01},
                                         RealMesh{"sms/torus.obj", 1.5F, 0.5, 4, 0.98, 0.02},
                                         RealMesh{"sms/slab18_plane_2.obj", 1.5F, 0, 8, 0.99, 0.01},
                                         RealMesh{"ignis/Diamond.ply", 2.4F, 0.3, 4, 0.9, 0.05}));

}  // namespace
}  // namespace caustics
