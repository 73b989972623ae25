#include "photonmap/photons/direction_code.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace caustics::photonmap {
namespace {

double angle_between(const Vec3& a, const Vec3& b) {
    const Vec3d x = a.cast<double>(), y = b.cast<double>();
    return std::atan2(x.cross(y).norm(), x.dot(y));
}

Vec3 direction(double theta, double phi) {
    return Vec3d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta))
        .cast<float>();
}

TEST(DirectionCode, ErrsByAtMostHalfACellsDiagonalOverTheSphere) {
    // Half a cell is pi/512 in theta and sin(theta) pi/256 in phi; the diagonal is exact for the
    // equator and a bound elsewhere but for the curvature of a cell near the poles.
    constexpr int steps = 1'000;
    double largest = 0;
    for (int i = 0; i <= steps; ++i) {
        for (int j = 0; j < steps; ++j) {
            const Vec3 w = direction(pi_d * i / steps, 2 * pi_d * j / steps);
            const DirectionCode code = encode_direction(w);
            largest = std::max(largest, angle_between(w, decode_direction(code.theta, code.phi)));
        }
    }
    EXPECT_LE(largest, std::hypot(pi_d / 512, pi_d / 256) + 1e-6);
    EXPECT_GE(largest, 0.9 * std::hypot(pi_d / 512, pi_d / 256));
}

TEST(DirectionCode, DecodesToCentresThatEncodeToThemselves) {
    for (int theta = 0; theta < 256; ++theta) {
        for (int phi = 0; phi < 256; ++phi) {
            const Vec3 w =
                decode_direction(static_cast<std::uint8_t>(theta), static_cast<std::uint8_t>(phi));
            ASSERT_NEAR(w.norm(), 1, 1e-6);
            const DirectionCode code = encode_direction(w);
            ASSERT_EQ(code.theta, theta);
            ASSERT_EQ(code.phi, phi);
        }
    }
}

TEST(DirectionCode, ServesPolesAndTheSeam) {
    EXPECT_EQ(encode_direction(Vec3::UnitZ()).theta, 0);
    EXPECT_EQ(encode_direction(-Vec3::UnitZ()).theta, 255);
    EXPECT_EQ(encode_direction(Vec3::UnitX()).phi, 0);
    EXPECT_EQ(encode_direction(Vec3(1, -1e-6F, 0)).phi, 255);
    EXPECT_EQ(encode_direction(-Vec3::UnitX()).phi, 128);
    // Rounded unit vectors may be a little longer than 1.
    EXPECT_EQ(encode_direction(Vec3(0, 0, 1.0000002F)).theta, 0);
}

}  // namespace
}  // namespace caustics::photonmap
