#include "core/math/frame.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/math/rng.h"
#include "core/math/sampling.h"

namespace caustics {
namespace {

std::vector<Vec3> directions_with_the_poles() {
    std::vector<Vec3> directions = {Vec3::UnitX(),  -Vec3::UnitX(), Vec3::UnitY(),
                                    -Vec3::UnitY(), Vec3::UnitZ(),  -Vec3::UnitZ()};
    for (const float tilt : {1e-7F, 1e-5F, 1e-3F})
        for (const float z : {-1.0F, 1.0F}) {
            directions.push_back(Vec3(tilt, -tilt, z).normalized());
            directions.push_back(Vec3(1, tilt, z * tilt).normalized());
        }
    directions.emplace_back(1.0F, 0.0F, -0.0F);
    Rng rng(1, Stage::test, 0);
    for (int i = 0; i < 10'000; ++i) {
        const float u0 = rng.next();
        directions.push_back(uniform_cap(2, u0, rng.next()).normalized());
    }
    return directions;
}

TEST(Frame, IsOrthonormalAndRightHandedEverywhere) {
    for (const Vec3& n : directions_with_the_poles()) {
        const Frame frame(n);
        Eigen::Matrix3f m;
        m << frame.s, frame.t, frame.n;
        EXPECT_LT((m.transpose() * m - Eigen::Matrix3f::Identity()).cwiseAbs().maxCoeff(), 2e-6F)
            << n.transpose();
        EXPECT_NEAR(frame.s.cross(frame.t).dot(n), 1, 2e-6F) << n.transpose();
        EXPECT_EQ(frame.n, n);
    }
}

TEST(Frame, LocalAndWorldAreInverse) {
    const Vec3 local(0.3F, -0.5F, 0.7F);
    for (const Vec3& n : directions_with_the_poles()) {
        const Frame frame(n);
        EXPECT_LT((frame.to_local(frame.to_world(local)) - local).norm(), 2e-6F) << n.transpose();
        EXPECT_LT((frame.to_world(Vec3::UnitZ()) - n).norm(), 1e-6F);
    }
}

}  // namespace
}  // namespace caustics
