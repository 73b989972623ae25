#include "core/lights/aimed_source.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/lights/light.h"
#include "tests/support/build_scene.h"

namespace caustics {
namespace {

/// Mirror balls in the unit cube about the origin.
struct Balls {
    std::vector<Shape> shapes;
    std::vector<std::uint32_t> casters;
    Surroundings surroundings() const {
        return {shapes, casters, Box(-Vec3::Ones(), Vec3::Ones())};
    }
};

Balls random_balls(std::uint32_t count, float most_radius) {
    Rng rng(3, Stage::test, count);
    Balls balls;
    for (std::uint32_t i = 0; i < count; ++i) {
        const Vec3d at(static_cast<double>(rng.next()) - 0.5, static_cast<double>(rng.next()) - 0.5,
                       static_cast<double>(rng.next()) - 0.5);
        const double radius = static_cast<double>(most_radius * (0.1F + 0.9F * rng.next()));
        balls.shapes.push_back(support::sphere("ball", at, radius, support::mirror()));
        balls.casters.push_back(i);
    }
    return balls;
}

/// A square grid of small balls that do not touch, as many along x as along y.
Balls grid_of_balls(std::uint32_t side) {
    Balls balls;
    for (std::uint32_t i = 0; i < side * side; ++i) {
        const Vec3d at((i % side + 0.5) / side - 0.5, (i / side + 0.5) / side - 0.5, 0);
        balls.shapes.push_back(support::sphere("ball", at, 0.3 / side, support::mirror()));
        balls.casters.push_back(i);
    }
    return balls;
}

std::vector<Light> lights_of_each_way() {
    return {support::point_light({0.2, 0.1, 2}, 1), support::directional_light({0.3, 0.2, -1}, 1),
            ConstantLight{Spectrum::Ones()}};
}

/// A random sample of a source that aim() made, as a path draws it.
class AimedDraw {
public:
    AimedDraw(const AimedSource& source, Rng& rng) : source_(source) {
        double u = rng.next_fine();
        sample_.region = static_cast<std::uint32_t>(pick_and_stretch(source.cumulative, u));
        if (!source.cones.empty()) {
            const DirectionCone& cone = source.cones[sample_.region].cone;
            const float v = rng.next();
            sample_.direction = cone.sample(v, rng.next());
            return;
        }
        const float v = rng.next();
        along_ = uniform_cap(2, v, rng.next());
        const Frame across(along_);
        const AimedDisc& disc = source.discs[sample_.region];
        const float w = rng.next();
        const Vec2 on = concentric_disc(w, rng.next());
        point_ = disc.centre + disc.radius * (across.s * on.x() + across.t * on.y());
    }

    Overlap by_tree() const {
        return source_.cones.empty() ? discs_that_hold(source_, sample_, point_, along_)
                                     : cones_that_hold(source_, sample_);
    }

    int by_linear_scan() const {
        int holding = 1;
        for (std::uint32_t i = 0; i < source_.cumulative.size(); ++i)
            if (i != sample_.region && holds(i)) ++holding;
        return holding;
    }

private:
    bool holds(std::uint32_t i) const {
        if (!source_.cones.empty()) return source_.cones[i].cone.contains(sample_.direction);
        const Vec3 offset = point_ - source_.discs[i].centre;
        return Vec3(offset - offset.dot(along_) * along_).norm() <= source_.discs[i].radius;
    }

    const AimedSource& source_;
    AimedSample sample_;
    Vec3 point_ = Vec3::Zero();
    Vec3 along_ = Vec3::UnitZ();
};

constexpr int aimed_draws = 2000;

TEST(AimedSource, CountsTheOverlapsThatALinearScanCounts) {
    for (const float radius : {0.02F, 0.3F}) {
        const Balls balls = random_balls(500, radius);
        for (const Light& light : lights_of_each_way()) {
            const AimedSource source = aim(light, balls.surroundings()).at(0);
            Rng rng(4, Stage::test, 0);
            int overlaps = 0;
            for (int i = 0; i < aimed_draws; ++i) {
                const AimedDraw draw(source, rng);
                ASSERT_EQ(draw.by_tree().holding, draw.by_linear_scan()) << type_of(light);
                overlaps += draw.by_tree().holding - 1;
            }
            EXPECT_GT(overlaps, aimed_draws / 10) << type_of(light);
        }
    }
}

double boxes_tested_a_path(const Light& light, std::uint32_t side) {
    const Balls balls = grid_of_balls(side);
    const AimedSource source = aim(light, balls.surroundings()).at(0);
    Rng rng(5, Stage::test, 0);
    double tested = 0;
    for (int i = 0; i < aimed_draws; ++i) tested += AimedDraw(source, rng).by_tree().boxes_tested;
    return tested / aimed_draws;
}

// 64 times as many casters: the square root would be 8 times as many tests.
TEST(AimedSource, TestsFewerBoxesAPathThanTheSquareRootOfTheCasters) {
    for (const Light& light : lights_of_each_way()) {
        const double few = boxes_tested_a_path(light, 25);
        const double many = boxes_tested_a_path(light, 200);
        EXPECT_GT(few, 1) << type_of(light);
        EXPECT_LT(many, 4 * few) << type_of(light);
        EXPECT_LT(many, 200) << type_of(light);
    }
}

TEST(AimedSource, TestsNoBoxForOneRegion) {
    for (const Light& light : lights_of_each_way()) {
        const AimedSource source = aim(light, grid_of_balls(1).surroundings()).at(0);
        Rng rng(6, Stage::test, 0);
        const Overlap overlap = AimedDraw(source, rng).by_tree();
        EXPECT_EQ(overlap.holding, 1);
        EXPECT_EQ(overlap.boxes_tested, 0);
    }
}

}  // namespace
}  // namespace caustics
