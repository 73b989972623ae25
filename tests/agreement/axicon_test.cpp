#include <gtest/gtest.h>

#include <cmath>

#include "beamtree/beam_tree.h"
#include "core/geometry/lathe.h"
#include "core/math/rng.h"
#include "tests/support/build_scene.h"
#include "tests/support/fresnel.h"

namespace caustics {
namespace {

// A cone of glass turned on a lathe, its tip down over the floor, under the sun. A ray at the distance r from the axis lands at
// k r - a, with k = 1 - tan(slope) tan(deviation) and a = height tan(deviation): beyond a the floor has
// E(q) = T (q + a) / (k^2 q), and within a both sides of the cone light it, E(q) = T 2 a / (k^2 q).
constexpr double index = 1.5;
constexpr double slope = 12 * pi_d / 180;
constexpr double height = 1.2;

double irradiance(double q) {
    const double deviation = std::asin(index * std::sin(slope)) - slope;
    const double k = 1 - std::tan(slope) * std::tan(deviation);
    const double a = height * std::tan(deviation);
    const double passed =
        (1 - support::fresnel(1, index)) * (1 - support::fresnel(std::cos(slope), 1 / index));
    return passed * (q > a ? q + a : 2 * a) / (k * k * q);
}

Scene axicon(int sectors) {
    LatheProfile profile;
    const double top = height + std::tan(slope);
    profile.points.push_back({{0, height}});
    profile.points.push_back({{1, top}, true});
    profile.points.push_back({{0, top}});
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", 0, 3, true, support::diffuse(0.5F)),
                   support::mesh("cone", tessellate_lathe(profile, sectors), Transform::Identity(),
                                 support::glass(static_cast<float>(index)))};
    desc.lights = {support::directional_light(-Vec3d::UnitZ(), 1)};
    return Scene(std::move(desc));
}

// Light of beams over the truth, at random points between two distances from the axis. Each point stands for as wide a ring.
double light_over_truth(const CausticEstimator& method, const Scene& scene, double from,
                        double to) {
    constexpr int count = 4000;
    Rng chance(3, Stage::test, 0);
    double found = 0;
    double truth = 0;
    for (int i = 0; i < count; ++i) {
        const double q = from + (to - from) * (i + static_cast<double>(chance.next())) / count;
        const double angle = 2 * pi_d * static_cast<double>(chance.next());
        const Vec3d at(q * std::cos(angle), q * std::sin(angle), 0);
        found += q * static_cast<double>(
                         support::irradiance(method,
                                             {support::probe(scene, 0, at, Vec3d::UnitZ(), 0)})[0]
                             .value.mean());
        truth += q * irradiance(q);
    }
    return found / truth;
}

// Its straight profile meets the axis aslant, without a crease: a rounded normal at the tip took four fifths of the light.
// The corner that all triangles of its flat side share lies over the tip, where one ray served for all of them; and
// towards the rim the glass is thinner than the distance by which rays were kept off their surface: a tenth was lost in each.
TEST(Axicon, HasItsLightWithoutACreaseAtItsTip) {
    const Scene scene = axicon(128);
    beamtree::BeamTreeParams params;
    params.max_bounces = 2;
    const auto method = beamtree::build(scene, params, RunOptions{});
    EXPECT_NEAR(light_over_truth(*method, scene, 0, 0.1), 1, 0.02) << "round the axis";
    EXPECT_NEAR(light_over_truth(*method, scene, 0.1, 0.7), 1, 0.02) << "between";
    EXPECT_NEAR(light_over_truth(*method, scene, 0.7, 0.84), 1, 0.02) << "from the rim";
}

}  // namespace
}  // namespace caustics
