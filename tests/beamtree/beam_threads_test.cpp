#include <gtest/gtest.h>

#include <bit>

#include "beamtree/beam_tree.h"
#include "tests/beamtree/beam_scenes.h"

namespace caustics::beamtree {
namespace {

constexpr int points = 400;

SceneDesc glass_ball_desc(int resolution) {
    SceneDesc desc = ball_desc(resolution);
    desc.shapes[0].bsdf = support::glass(1.5F);
    return desc;
}

std::vector<ReceiverPoint> floor_points(float height, float half) {
    std::vector<ReceiverPoint> receivers(points);
    Rng rng(3, Stage::test, 0);
    for (ReceiverPoint& point : receivers) {
        point.position = Vec3(half * (2 * rng.next() - 1), half * (2 * rng.next() - 1), height);
        point.geometric_normal = Vec3::UnitZ();
    }
    return receivers;
}

/// What a build tells and answers.
struct Answers {
    BuildReport report;
    std::vector<Estimate> light = std::vector<Estimate>(points);
    Counters counters;
};

Answers answers(const Scene& scene, const BeamTreeParams& params, int threads,
                const std::vector<ReceiverPoint>& receivers) {
    RunOptions options;
    options.threads = threads;
    const auto tree = build(scene, params, options);
    Answers found;
    found.report = tree->build_report();
    const auto context = tree->make_context();
    tree->irradiance(receivers, found.light, *context);
    context->add_to(found.counters);
    return found;
}

// To the bit, and with light to speak of.
void expect_same(const SceneDesc& desc, const BeamTreeParams& params,
                 const std::vector<ReceiverPoint>& receivers) {
    const Scene scene(desc);
    const Answers one = answers(scene, params, 1, receivers);
    for (const int threads : {2, 5}) {
        const Answers many = answers(scene, params, threads, receivers);
        EXPECT_EQ(many.report.counters, one.report.counters);
        EXPECT_EQ(many.report.resolved, one.report.resolved);
        EXPECT_EQ(many.counters, one.counters);
        float sum = 0;
        for (std::size_t i = 0; i < points; ++i) {
            const Spectrum& a = one.light[i].value;
            const Spectrum& b = many.light[i].value;
            sum += a.mean();
            for (Eigen::Index channel = 0; channel < a.size(); ++channel)
                EXPECT_EQ(std::bit_cast<std::uint32_t>(a[channel]),
                          std::bit_cast<std::uint32_t>(b[channel]))
                    << i;
        }
        EXPECT_GT(sum, 0.1F);
    }
}

BeamTreeParams slices() {
    BeamTreeParams params;
    params.bound = Bound::two_slice;
    params.hierarchy = BeamTreeParams::Tree::binned;
    params.leaf = BeamTreeParams::Leaf::fixed;
    params.intensity = Intensity::refined;
    return params;
}

// More beams than one branch of a tree of slices holds.
TEST(BeamThreads, ChangeNothingOfAPool) {
    BeamTreeParams params = slices();
    params.max_bounces = 2;
    expect_same(pool_desc(80), params, floor_points(-1, 0.9F));
    params.polygons = PolygonKind::quad;
    params.max_bounces = 1;
    expect_same(pool_desc(40), params, floor_points(-1, 0.9F));
}

TEST(BeamThreads, ChangeNothingOfTreesOfCones) {
    BeamTreeParams params;
    params.max_bounces = 1;
    expect_same(pool_desc(24), params, floor_points(-1, 0.9F));
    params.merging = ConeTreeSettings::Merging::cones;
    expect_same(pool_desc(24), params, floor_points(-1, 0.9F));
    params.hierarchy = BeamTreeParams::Tree::binned;
    params.merging = ConeTreeSettings::Merging::rays;
    expect_same(ring_desc(32), params, floor_points(0, 0.5F));
}

// Through the ball's two sides and inside of it, with a budget for all beams and for a few.
TEST(BeamThreads, ChangeNothingOfSeveralEvents) {
    BeamTreeParams params = slices();
    params.max_bounces = 4;
    expect_same(glass_ball_desc(16), params, floor_points(0, 1.5F));
    params.max_beams = 300;
    expect_same(glass_ball_desc(16), params, floor_points(0, 1.5F));
}

}  // namespace
}  // namespace caustics::beamtree
