#include "core/scene/crossing_dielectrics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/geometry/tessellate.h"
#include "core/math/rng.h"
#include "tests/support/build_scene.h"

namespace caustics {
namespace {

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

Pairs crossing(std::vector<Shape> shapes) {
    SceneDesc desc;
    desc.shapes = std::move(shapes);
    return crossing_dielectrics(Scene(std::move(desc)));
}

Shape ball(const Vec3d& centre, double radius, const Bsdf& bsdf = support::glass(1.5F)) {
    return support::sphere("ball", centre, radius, bsdf);
}

TEST(CrossingDielectrics, NamesBallsThatIntersect) {
    const Shape floor = support::horizontal("floor", -0.5, 3, true, support::diffuse(0.5F));
    for (const double apart : {0.05, 0.5, 1.0, 1.9})
        EXPECT_EQ(crossing({floor, ball({0, 0, 0}, 1), ball({apart, 0, 0.1}, 1)}), (Pairs{{1, 2}}))
            << apart;
    // A ball half in water.
    EXPECT_EQ(crossing({ball({0, 0, 0}, 0.5),
                        support::horizontal("water", 0, 3, true, support::glass(1.33F))}),
              (Pairs{{0, 1}}));
    const Shape as_mesh =
        support::mesh("mesh", tessellate_sphere(32), Transform(Eigen::Translation3d(0.7, 0.2, 0)),
                      support::glass(1.5F));
    EXPECT_EQ(crossing({as_mesh, ball({0, 0, 0}, 1)}), (Pairs{{0, 1}}));
}

TEST(CrossingDielectrics, LeavesShapesThatDoNotAlone) {
    EXPECT_EQ(crossing({ball({0, 0, 0}, 1), ball({2.01, 0, 0}, 1)}), Pairs{});
    // A bubble in glass; off its middle; two balls that touch.
    EXPECT_EQ(crossing({ball({0, 0, 0}, 1), ball({0, 0, 0}, 0.7, support::glass(1, 1.5F))}),
              Pairs{});
    EXPECT_EQ(crossing({ball({0, 0, 0}, 1), ball({0.2, 0, 0}, 0.7, support::glass(1, 1.5F))}),
              Pairs{});
    EXPECT_EQ(crossing({ball({0, 0, 0}, 1), ball({2, 0, 0}, 1)}), Pairs{});
    // A mirror or a floor may stand in glass.
    EXPECT_EQ(crossing({ball({0, 0, 0}, 1), ball({1, 0, 0}, 1, support::mirror()),
                        support::horizontal("floor", 0, 3, true, support::diffuse(0.5F))}),
              Pairs{});
}

// Water in a glass: its side stands on the glass's inner wall, and its top meets it there.
TEST(CrossingDielectrics, WaterMayTouchItsGlass) {
    const auto wall = [](const char* name, double radius, double height, const Bsdf& bsdf) {
        return support::mesh(name, tessellate_cylinder(16),
                             Transform(Eigen::Scaling(radius, radius, height)), bsdf);
    };
    Shape top;
    top.name = "top";
    top.primitive = Primitive::disk;
    top.to_world = Eigen::Translation3d(0, 0, 0.6) * Eigen::Scaling(0.9, 0.9, 1.0);
    top.bsdf = support::glass(1.33F);
    EXPECT_EQ(crossing({wall("outside", 1, 1, support::glass(1.5F)),
                        wall("inside", 0.9, 1, support::glass(1, 1.5F)),
                        wall("water", 0.9, 0.6, support::glass(1.33F, 1.5F)), top}),
              Pairs{});
}

struct Sphere {
    Vec3d centre;
    double radius = 0;

    // By how much two cross or keep apart, of the smaller radius: above 0 they cross.
    double overlap(const Sphere& other) const {
        const double distance = (centre - other.centre).norm();
        const double smaller = std::min(radius, other.radius);
        return std::min(radius + other.radius - distance,
                        distance - std::abs(radius - other.radius)) /
               smaller;
    }
};

// Balls thrown about, no two of which cross so little that a mesh of 16 might not show it.
std::vector<Sphere> random_spheres(std::uint64_t path, std::size_t count) {
    constexpr double clear = 0.4;
    Rng rng(3, Stage::test, path);
    std::vector<Sphere> spheres;
    while (spheres.size() < count) {
        const Vec3 centre(rng.next(), rng.next(), rng.next());
        const Sphere sphere{centre.cast<double>(), 0.05 + 0.1 * rng.next_fine()};
        const bool is_clear = std::ranges::all_of(spheres, [&](const Sphere& other) {
            const double overlap = sphere.overlap(other);
            return overlap < -0.01 || overlap > clear;
        });
        if (is_clear) spheres.push_back(sphere);
    }
    return spheres;
}

TEST(CrossingDielectrics, AreThoseOfAllPairsInTheirOrder) {
    for (const std::uint64_t path : {0U, 1U, 2U}) {
        const std::vector<Sphere> spheres = random_spheres(path, 60);
        std::vector<Shape> shapes;
        Pairs expected;
        for (std::uint32_t i = 0; i < spheres.size(); ++i) {
            shapes.push_back(ball(spheres[i].centre, spheres[i].radius));
            for (std::uint32_t k = i + 1; k < spheres.size(); ++k)
                if (spheres[i].overlap(spheres[k]) > 0) expected.emplace_back(i, k);
        }
        EXPECT_GT(expected.size(), 20U);
        EXPECT_EQ(crossing(std::move(shapes)), expected) << path;
    }
}

// Each edge with each ball would be a quarter of an hour.
TEST(CrossingDielectrics, OfThousandsAreFoundInNoTime) {
    constexpr int side = 128;
    std::vector<Shape> shapes;
    for (int i = 0; i < side * side; ++i)
        shapes.push_back(ball(Vec3d(i % side, i / side, 0), i == side + 1 ? 0.6 : 0.45));
    const auto middle = static_cast<std::uint32_t>(side + 1);
    EXPECT_EQ(crossing(std::move(shapes)), (Pairs{{middle - side, middle},
                                                  {middle - 1, middle},
                                                  {middle, middle + 1},
                                                  {middle, middle + side}}));
}

TEST(CrossingDielectrics, OfWhichThousandsCrossEachOtherAreToldInPart) {
    std::vector<Shape> shapes;
    for (int i = 0; i < 2000; ++i)
        shapes.push_back(ball(0.05 * Vec3d(i % 13, i / 13 % 13, i / 169), 0.4));
    const Pairs pairs = crossing(std::move(shapes));
    EXPECT_GE(pairs.size(), most_crossing_pairs);
    EXPECT_LT(pairs.size(), most_crossing_pairs + 2000);
}

}  // namespace
}  // namespace caustics
