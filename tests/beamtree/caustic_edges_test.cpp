#include "beamtree/caustic_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/geometry/tessellate.h"
#include "tests/support/build_scene.h"

namespace caustics::beamtree {
namespace {

using Kind = CausticEdge::Kind;

constexpr double amplitude = 0.03;
constexpr double wave_number = 8;
constexpr double ior = 1.333;
constexpr double depth = 4;

std::vector<CausticEdge> edges_of(SceneDesc desc) {
    const Scene scene(std::move(desc));
    return caustic_edges(scene, trace_scene(scene, "beams", {}, {}));
}

std::map<Kind, std::size_t> counts(const std::vector<CausticEdge>& edges) {
    std::map<Kind, std::size_t> found;
    for (const CausticEdge& edge : edges) ++found[edge.kind];
    return found;
}

// Waves along x under light straight down, deep enough to fold.
SceneDesc wavy_pool(int cells) {
    SineHeightfield field;
    field.waves = {{amplitude, {wave_number, 0}, 0.3}};
    SceneDesc desc;
    desc.shapes = {support::mesh("water", tessellate_heightfield(field, cells),
                                 Transform::Identity(), support::glass(static_cast<float>(ior))),
                   support::horizontal("floor", -depth, 4, true, support::diffuse(0.5F))};
    desc.lights = {support::directional_light({0, 0, -1}, 1)};
    return desc;
}

// Where the light that enters at x meets the floor.
double arrival(double x) {
    const double angle = std::atan(amplitude * wave_number * std::cos(wave_number * x + 0.3));
    const double turn = angle - std::asin(std::sin(angle) / ior);
    return x + (depth + amplitude * std::sin(wave_number * x + 0.3)) * std::tan(turn);
}

// The caustics are lines along y: where the arrival turns back.
std::vector<double> caustic_lines() {
    const auto slope = [](double x) { return arrival(x + 1e-6) - arrival(x - 1e-6); };
    std::vector<double> lines;
    constexpr int steps = 10000;
    for (int i = 0; i < steps; ++i) {
        double low = -1 + 2.0 * i / steps;
        double high = -1 + 2.0 * (i + 1) / steps;
        if (slope(low) * slope(high) > 0) continue;
        for (int halved = 0; halved < 30; ++halved) {
            const double middle = (low + high) / 2;
            (slope(low) * slope(middle) > 0 ? low : high) = middle;
        }
        lines.push_back(arrival(low));
    }
    return lines;
}

double farthest_fold(const std::vector<CausticEdge>& edges, const std::vector<double>& lines) {
    double farthest = 0;
    for (const CausticEdge& edge : edges) {
        if (edge.kind != Kind::fold) continue;
        double nearest = 1;
        for (const double line : lines)
            nearest = std::min(nearest, std::abs(static_cast<double>(edge.from.x()) - line));
        farthest = std::max(farthest, nearest);
        EXPECT_NEAR(edge.from.x(), edge.to.x(), 1e-5);
    }
    return farthest;
}

TEST(CausticEdges, FoldWhereTheLightTurnsBack) {
    const std::vector<double> lines = caustic_lines();
    ASSERT_GE(lines.size(), 4U);
    const auto coarse = edges_of(wavy_pool(40));
    const auto fine = edges_of(wavy_pool(80));
    // Every cell's side along each line, and every edge of the mesh once.
    EXPECT_EQ(counts(coarse)[Kind::fold], 40 * lines.size());
    EXPECT_EQ(counts(fine)[Kind::fold], 80 * lines.size());
    EXPECT_EQ(fine.size(), 3U * 80 * 80 + 2 * 80);
    EXPECT_GT(counts(fine)[Kind::folded], fine.size() / 10);
    // Light near the caustic lands at a second order of the way from it.
    EXPECT_LT(farthest_fold(coarse, lines), 0.02);
    EXPECT_LT(farthest_fold(fine, lines), 0.005);
}

TEST(CausticEdges, KnowWhatMirrorsTurnOver) {
    SceneDesc desc;
    constexpr int n = 12;  // so fine that no triangle is divided for the lamp's sake
    desc.shapes = {
        support::mesh("mirror", tessellate_rectangle(n), Transform::Identity(), support::mirror()),
        support::horizontal("ceiling", 2, 9, false, support::diffuse(0.5F))};
    desc.lights = {support::point_light({0.1, 0.2, 1}, 1)};
    const auto edges = edges_of(std::move(desc));
    EXPECT_EQ(edges.size(), 3U * n * n + 2 * n);
    EXPECT_EQ(counts(edges)[Kind::direct], edges.size());
}

TEST(CausticEdges, FollowLightThroughSeveralEvents) {
    SceneDesc desc;
    for (const double z : {0.5, 0.3})
        desc.shapes.push_back(support::mesh("glass", tessellate_rectangle(2),
                                            Transform(Eigen::Translation3d(0, 0, z)),
                                            support::glass(1.5F)));
    desc.shapes.push_back(support::horizontal("floor", 0, 4, true, support::diffuse(0.5F)));
    desc.lights = {support::directional_light({0, 0, -1}, 1)};
    const auto edges = edges_of(std::move(desc));
    EXPECT_EQ(counts(edges)[Kind::fold], 0U);
    EXPECT_EQ(counts(edges)[Kind::folded], 0U);
    // Straight through, and to and fro between the two: the same edges once for each way.
    EXPECT_GE(edges.size(), 2 * (3U * 2 * 2 + 2 * 2));
    for (const CausticEdge& edge : edges) EXPECT_NEAR(edge.from.z(), 0, 1e-5);
}

}  // namespace
}  // namespace caustics::beamtree
