#include "core/lights/spot_cone.h"

#include <gtest/gtest.h>

#include "core/math/spectrum.h"

namespace caustics {
namespace {

constexpr float degree = std::numbers::pi_v<float> / 180;

Vec3 at_angle(float angle) { return {std::sin(angle), 0, std::cos(angle)}; }

TEST(SpotCone, FallsLinearlyInTheAngle) {
    const SpotCone cone{Vec3::UnitZ(), 15 * degree, 30 * degree};
    EXPECT_EQ(cone.falloff(at_angle(0)), 1);
    EXPECT_EQ(cone.falloff(at_angle(14.9F * degree)), 1);
    EXPECT_NEAR(cone.falloff(at_angle(20 * degree)), 2.0F / 3, 1e-5F);
    EXPECT_NEAR(cone.falloff(at_angle(29.85F * degree)), 0.01F, 1e-5F);
    EXPECT_EQ(cone.falloff(at_angle(30.1F * degree)), 0);
    EXPECT_EQ(cone.falloff(-Vec3::UnitZ()), 0);
}

TEST(SpotCone, MayEndAtOnce) {
    const SpotCone cone{Vec3::UnitZ(), 20 * degree, 20 * degree};
    EXPECT_EQ(cone.falloff(at_angle(19.9F * degree)), 1);
    EXPECT_EQ(cone.falloff(at_angle(20.1F * degree)), 0);
}

TEST(SpotCone, SendsTheFluxOfItsFormula) {
    for (const auto& [b, c] : {std::pair{15.0, 20.0}, {0.0, 90.0}, {10.0, 170.0}}) {
        const double beam = b * pi_d / 180;
        const double cutoff = c * pi_d / 180;
        const SpotCone cone{Vec3::UnitZ(), static_cast<float>(beam), static_cast<float>(cutoff)};
        constexpr int steps = 20'000;
        double flux = 0;
        for (int i = 0; i < steps; ++i) {
            const double angle = pi_d * (i + 0.5) / steps;
            flux += 2 * pi_d * std::sin(angle) * pi_d / steps *
                    static_cast<double>(cone.falloff(at_angle(static_cast<float>(angle))));
        }
        const double truth = 2 * pi_d * (1 - (std::sin(cutoff) - std::sin(beam)) / (cutoff - beam));
        EXPECT_NEAR(flux / truth, 1, 1e-4) << b << " " << c;
    }
}

}  // namespace
}  // namespace caustics
