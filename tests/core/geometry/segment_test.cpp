#include "core/geometry/segment.h"

#include <gtest/gtest.h>

#include "core/math/rng.h"
#include "tests/support/random_direction.h"

namespace caustics {
namespace {

const Box box(Vec3(-1, -2, 0), Vec3(1, 2, 0.5F));

TEST(DistanceToEntry, IsOnTheBoundsOfLinesThatMeetThem) {
    Rng rng(1, Stage::test, 0);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 share(rng.next(), rng.next(), rng.next());
        const Vec3 inside = box.min() + box.sizes().cwiseProduct(share);
        const Vec3 direction = support::random_direction(rng);
        const Vec3 start = inside + distance_to_entry(box, inside, direction) * direction;
        EXPECT_LT(box.exteriorDistance(start), 1e-4F) << inside.transpose();
        EXPECT_FALSE(box.contains(start)) << inside.transpose();
    }
}

// Beside a side and nearly parallel to it: the side's plane is met 1e30 m away.
TEST(DistanceToEntry, StaysNearTheBounds) {
    for (const float slope : {0.0F, 1e-45F, 1e-38F, 1e-30F, 1e-10F, 1e-3F})
        for (const float side : {-1.0F, 1.0F})
            for (const float beyond : {-1.5F, 1.5F}) {
                const Vec3 direction = Vec3(side * slope, 0, -1).normalized();
                const Vec3 point(beyond, 0.3F, 0);
                const Vec3 start = point + distance_to_entry(box, point, direction) * direction;
                EXPECT_LT(box.exteriorDistance(start), 4)
                    << slope << ", " << side << ", " << beyond;
            }
}

}  // namespace
}  // namespace caustics
