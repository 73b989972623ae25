#include "photonmap/photons/facing_code.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/rng.h"
#include "core/math/sampling.h"

namespace caustics::photonmap {
namespace {

Vec3d decoded(unsigned flags) {
    const Facing at = facing_of(flags);
    return Vec3d(at.x, at.y, at.z).normalized();
}

TEST(FacingCode, KeepsTheAxesExactlyAndOthersWithinItsStep) {
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {-1.0F, 1.0F}) {
            const Vec3 n = sign * Vec3::Unit(axis);
            EXPECT_EQ(decoded(facing_flags({n.x(), n.y(), n.z()})), n.cast<double>());
        }
    Rng rng(3, Stage::test, 0);
    double worst = 1;
    for (int i = 0; i < 100'000; ++i) {
        const float u = rng.next(), v = rng.next();
        const Vec3 n = uniform_cap(2, u, v);
        const auto flags = facing_flags({n.x(), n.y(), n.z()});
        ASSERT_EQ(flags & ~facing_mask, 0U);
        worst = std::min(worst, decoded(flags).dot(n.cast<double>().normalized()));
    }
    // Half a step of both coordinates, 1/88, moves (x, y, z) by up to sqrt(6)/88 where its length is
    // least, 1/sqrt(3).
    EXPECT_LT(std::acos(worst), std::sqrt(18.0) / 88);
}

TEST(FacingCode, CountsWithinSixtyDegrees) {
    for (double degrees = 0; degrees < 180; degrees += 1) {
        const double angle = degrees * pi_d / 180;
        const float normal[3] = {static_cast<float>(std::sin(angle)), 0,
                                 static_cast<float>(std::cos(angle))};
        if (degrees != 60) {
            EXPECT_EQ(is_same_surface(facing_flags({0, 0, 1}), normal), degrees < 60) << degrees;
        }
        EXPECT_TRUE(is_same_surface(3, normal)) << "a tree's axis alone says nothing";
    }
}

TEST(FacingCode, DoesNotKnowWhatIsNoDirection) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(facing_flags({0, 0, 0}), 0);
    EXPECT_EQ(facing_flags({nan, 0, 1}), 0);
    EXPECT_EQ(facing_flags({0, std::numeric_limits<float>::infinity(), 1}), 0);
}

}  // namespace
}  // namespace caustics::photonmap
