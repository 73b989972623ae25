#include "core/geometry/box_view.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/rng.h"
#include "core/math/sampling.h"

namespace caustics {
namespace {

// A square above a point straight below its middle, parallel to it: 4 times that of a quarter, a / sqrt(1 + a^2)
// atan(a / sqrt(1 + a^2)) for a quarter of the side a at the distance 1.
TEST(BoxView, IsTheFormulaBelowASquare) {
    for (const double a : {0.01, 0.5, 1.0, 30.0}) {
        const auto half = static_cast<float>(a);
        const Box square(Vec3(-half, -half, 1), Vec3(half, half, 1));
        const double root = std::sqrt(1 + a * a);
        EXPECT_NEAR(cosine_over(square, Vec3::Zero(), Vec3::UnitZ()),
                    4 * a / root * std::atan(a / root), 1e-6 * pi_d);
        EXPECT_EQ(cosine_over(square, Vec3::Zero(), -Vec3::UnitZ()), 0);
        // Half of it, of an upright surface.
        EXPECT_NEAR(cosine_over(square, Vec3::Zero(), Vec3::UnitX()),
                    std::atan(a) - std::atan(a / root) / root, 1e-6 * pi_d)
            << a;
    }
}

bool meets(const Box& box, const Vec3& from, const Vec3& direction) {
    float near = 0;
    float far = 1e30F;
    for (int axis = 0; axis < 3; ++axis) {
        const float a = (box.min()[axis] - from[axis]) / direction[axis];
        const float b = (box.max()[axis] - from[axis]) / direction[axis];
        near = std::max(near, std::min(a, b));
        far = std::min(far, std::max(a, b));
    }
    return near <= far;
}

// By directions whose density is the cosine: five standard errors.
TEST(BoxView, IsTheShareOfTheDirectionsThatMeetTheBox) {
    constexpr int draws = 20'000;
    Rng rng(1, Stage::test, 0);
    const auto any = [&] { return 2 * rng.next() - 1; };
    for (int k = 0; k < 40; ++k) {
        Box box(Vec3(any(), any(), any()));
        box.extend(Vec3(any(), any(), any()));
        const Vec3 position = 1.5F * Vec3(any(), any(), any());
        const Vec3 normal = Vec3(any(), any(), any()).normalized();
        int met = 0;
        for (int i = 0; i < draws; ++i) {
            const float u = rng.next();
            met += meets(box, position, Frame(normal).to_world(cosine_hemisphere(u, rng.next())));
        }
        const double share = box.contains(position) ? 1 : cosine_over(box, position, normal) / pi_d;
        const double error = std::sqrt(share * (1 - share) / draws);
        EXPECT_NEAR(met / double{draws}, share, 5 * error + 1e-4) << k;
    }
}

}  // namespace
}  // namespace caustics
