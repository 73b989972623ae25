#include "beamtree/slices/beam_square.h"

#include <gtest/gtest.h>

#include <cmath>

#include "beamtree/beam_tree.h"
#include "beamtree/light/find_in_beam.h"
#include "tests/beamtree/beam_scenes.h"

namespace caustics::beamtree {
namespace {

BeamTreeParams averaged(float footprint, Intensity intensity = Intensity::area) {
    BeamTreeParams params;
    params.bound = Bound::two_slice;
    params.leaf = BeamTreeParams::Leaf::fixed;
    params.hierarchy = BeamTreeParams::Tree::binned;
    params.max_bounces = 1;
    params.footprint = footprint;
    params.intensity = intensity;
    return params;
}

// Waves three times as high as elsewhere: the caustic on the floor is folded.
SceneDesc folded_pool() {
    SineHeightfield high = waves();
    for (SineWave& wave : high.waves) wave.amplitude *= 3;
    SceneDesc desc = pool_desc(1);
    desc.shapes[0] = support::mesh("water", tessellate_heightfield(high, 32), Transform::Identity(),
                                   support::glass(1.333F));
    return desc;
}

/// Irradiance round points of the floor, one a row.
std::vector<double> irradiance(const Scene& scene, const BeamTreeParams& params,
                               const std::vector<Vec2>& at) {
    std::vector<ReceiverPoint> points;
    for (const Vec2& p : at)
        points.push_back(
            support::probe(scene, 1, Vec3(p.x(), p.y(), -1).cast<double>(), Vec3d::UnitZ(), 0));
    std::vector<double> found;
    for (const Estimate& one : support::irradiance(*build(scene, params, {}), points))
        found.push_back(static_cast<double>(one.value.mean()));
    return found;
}

// Middles of the squares that make up one with this half side, `count` along each side.
std::vector<Vec2> middles(int count, float half, const Vec2& centre = Vec2::Zero()) {
    std::vector<Vec2> all;
    const float step = 2 * half / static_cast<float>(count);
    for (int j = 0; j < count; ++j)
        for (int i = 0; i < count; ++i)
            all.push_back(centre + Vec2((static_cast<float>(i) + 0.5F) * step - half,
                                        (static_cast<float>(j) + 0.5F) * step - half));
    return all;
}

double sum(const std::vector<double>& values) {
    double total = 0;
    for (const double value : values) total += value;
    return total;
}

// Squares that tile the floor get all of the light, folds and all: no sampling, no noise.
TEST(BeamSquare, GetsAllOfTheFlux) {
    for (const PolygonKind kind : {PolygonKind::triangle, PolygonKind::quad}) {
        const Scene scene(folded_pool());
        BeamTreeParams params = averaged(0.1F);
        params.polygons = kind;
        double sent = 0;
        for (const BeamSet& set :
             trace_all_beams(scene, caster_meshes(scene, 2, kind), sample_lights(scene, 1, 1), {}))
            for (const Beam& beam : set.beams)
                sent += set.refracted ? static_cast<double>(beam.flux.mean()) : 0.0;
        const double landed = 0.01 * sum(irradiance(scene, params, middles(40, 2)));
        EXPECT_NEAR(landed / sent, 1, 1e-5);
    }
}

// What `area` keeps to the last bit, `refined` keeps but for what its second order leaves: also at a
// focus, where polygons are unlike from corner to corner.
TEST(BeamSquare, GetsTheFluxOfAFocusWhereItIsRefined) {
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", -1, 2, true, support::diffuse(0.5F)),
                   support::sphere("ball", {0, 0, -0.4}, 0.5, support::glass(1.5F))};
    desc.lights = {support::directional_light(-Vec3d::UnitZ(), 1)};
    const Scene scene(std::move(desc));
    const auto landed = [&](Intensity intensity) {
        BeamTreeParams params = averaged(0.1F, intensity);
        params.max_bounces = 2;
        return sum(irradiance(scene, params, middles(20, 1)));
    };
    EXPECT_NEAR(landed(Intensity::refined) / landed(Intensity::area), 1, 0.01);
}

/// The ring 0.6 <= r <= 1 of the paraboloid with its focus at (0, 0, 1), which sends light that falls along its axis there.
TriangleMesh paraboloid(std::uint32_t rings, std::uint32_t sectors) {
    TriangleMesh mesh;
    for (std::uint32_t j = 0; j <= rings; ++j)
        for (std::uint32_t i = 0; i < sectors; ++i) {
            const double r = 0.6 + 0.4 * j / rings;
            const double angle = 2 * pi_d * i / sectors;
            const Vec3d p(r * std::cos(angle), r * std::sin(angle), r * r / 4);
            mesh.positions.push_back(p.cast<float>());
            mesh.normals.push_back(Vec3d(-p.x() / 2, -p.y() / 2, 1).normalized().cast<float>());
        }
    for (std::uint32_t j = 0; j < rings; ++j)
        for (std::uint32_t i = 0; i < sectors; ++i) {
            const std::uint32_t a = j * sectors + i;
            const std::uint32_t b = j * sectors + (i + 1) % sectors;
            mesh.triangles.push_back({a, a + sectors, b});
            mesh.triangles.push_back({b, a + sectors, b + sectors});
        }
    return mesh;
}

// Where caustic polygons are no larger than the rounding of their corners, a square has their light all the same.
TEST(BeamSquare, GetsTheFluxOfAPerfectFocus) {
    SceneDesc desc;
    desc.shapes = {
        support::mesh("mirror", paraboloid(16, 64), Transform::Identity(), support::mirror()),
        support::horizontal("screen", 1, 0.3, false, support::diffuse(0.5F))};
    desc.lights = {support::directional_light(-Vec3d::UnitZ(), 1)};
    const Scene scene(std::move(desc));
    double sent = 0;
    for (const BeamSet& set : trace_all_beams(scene, caster_meshes(scene, 2, PolygonKind::triangle),
                                              sample_lights(scene, 1, 1), {}))
        for (const Beam& beam : set.beams) sent += static_cast<double>(beam.flux.mean());
    EXPECT_NEAR(sent, pi_d * 0.64, 0.01);
    const std::vector<ReceiverPoint> middle = {
        support::probe(scene, 1, {0, 0, 1}, -Vec3d::UnitZ(), 0)};
    for (const Intensity intensity : {Intensity::area, Intensity::refined}) {
        const auto estimator = build(scene, averaged(0.1F, intensity), {});
        const auto found = support::irradiance(*estimator, middle);
        EXPECT_NEAR(static_cast<double>(found[0].value.mean()) * 0.01 / sent, 1, 1e-3);
    }
}

// Near folds the light runs steeply within a polygon: its value in the middle is below its mean.
TEST(BeamSquare, GetsTheFluxOfFoldsWhereItIsRefined) {
    const Scene scene(folded_pool());
    const auto landed = [&](Intensity intensity) {
        return sum(irradiance(scene, averaged(0.1F, intensity), middles(40, 2)));
    };
    EXPECT_NEAR(landed(Intensity::refined) / landed(Intensity::area), 1, 0.002);
}

// The mean over a square is that of its parts, to the rounding of floats.
TEST(BeamSquare, IsTheMeanOfItsParts) {
    const Scene scene(folded_pool());
    const std::vector<Vec2> large = middles(8, 0.8F);
    const auto whole = irradiance(scene, averaged(0.2F), large);
    int lit = 0;
    for (std::size_t i = 0; i < large.size(); ++i) {
        const auto parts = irradiance(scene, averaged(0.05F), middles(4, 0.1F, large[i]));
        EXPECT_NEAR(whole[i], sum(parts) / 16, 2e-5 * whole[i] + 1e-6);
        lit += whole[i] > 0 ? 1 : 0;
    }
    EXPECT_GT(lit, 50);
}

// Points of a square taken at random agree with it in the mean.
TEST(BeamSquare, IsTheMeanOfItsPoints) {
    const Scene scene(pool_desc(32));
    const Vec2 centre(0.1F, -0.2F);
    Rng rng(7, Stage::test, 0);
    std::vector<Vec2> random;
    for (int i = 0; i < 4000; ++i)
        random.push_back(centre + 0.3F * Vec2(rng.next() - 0.5F, rng.next() - 0.5F));
    for (const Intensity intensity : {Intensity::area, Intensity::refined}) {
        const auto points = irradiance(scene, averaged(0, intensity), random);
        const double mean = sum(points) / 4000;
        double variance = 0;
        for (const double value : points) variance += (value - mean) * (value - mean) / 3999 / 4000;
        const double square = irradiance(scene, averaged(0.3F, intensity), {centre})[0];
        EXPECT_NEAR(square, mean, 4 * std::sqrt(variance));
        EXPECT_LT(std::sqrt(variance), 0.01 * mean);
    }
}

// Where the light is even over it, a small square is a point. Points of `refined` are asked for their roots, which go by
// the mesh's normals; squares go by polygons.
TEST(BeamSquare, BecomesAPointAsItShrinks) {
    const Scene scene(pool_desc(32));
    const std::vector<Vec2> at = middles(10, 0.5F, Vec2(0.0031F, 0.0017F));
    const auto points = irradiance(scene, averaged(0, Intensity::area), at);
    const auto squares = irradiance(scene, averaged(1e-5F, Intensity::area), at);
    for (std::size_t i = 0; i < at.size(); ++i) EXPECT_NEAR(squares[i] / points[i], 1, 1e-2);
}

// Light that comes nearly along the floor: what is averaged over lies on the floor, not across the light, and ends with
// the light.
TEST(BeamSquare, LiesOnTheReceiver) {
    const double slope = std::tan(80 * pi_d / 180);
    SceneDesc desc;
    desc.shapes = {
        support::rectangle("mirror", {0, 0, 1}, {0, 2, 0}, {0, 0, -0.5}, support::mirror()),
        support::horizontal("floor", 0, 10, true, support::diffuse(0.5F))};
    desc.lights = {support::directional_light(Vec3d(slope, 0, -1), 1)};
    const Scene scene(std::move(desc));
    const double lit = std::cos(80 * pi_d / 180);
    const auto near = static_cast<float>(-0.5 * slope);
    for (const Intensity intensity : {Intensity::area, Intensity::refined}) {
        const BeamTreeParams params = averaged(2, intensity);
        for (const auto& [x, share] :
             {std::pair(2 * near, 1.0), {near, 0.5}, {near - 0.5F, 0.75}}) {
            std::vector<ReceiverPoint> point = {
                support::probe(scene, 1, Vec3(x, 0, 0).cast<double>(), Vec3d::UnitZ(), 0)};
            const auto found = support::irradiance(*build(scene, params, {}), point);
            EXPECT_NEAR(static_cast<double>(found[0].value.mean()) / lit, share, 1e-4) << x;
        }
    }
}

// Far from a ball caustic polygons are large, and light comes down to the floor unevenly: within one of them it differs by more than
// [CC95 (11)] tells, and not as it does across the light.
TEST(BeamSquare, IsAPointWithinALargePolygon) {
    SceneDesc desc;
    desc.shapes = {support::sphere("ball", {0, 0, 0.35}, 0.3, support::glass(1.5F)),
                   support::horizontal("floor", 0, 3, true, support::diffuse(0.5F))};
    desc.lights = {support::point_light({-1.2, 0.4, 1.6}, 6)};
    const Scene scene(std::move(desc));
    std::vector<ReceiverPoint> at;
    for (int i = 0; i < 20; ++i)
        for (int j = 0; j < 10; ++j)
            at.push_back(
                support::probe(scene, 1, {0.9 + 0.03 * i, -0.65 + 0.04 * j, 0}, Vec3d::UnitZ(), 0));
    const auto ask = [&](float footprint) {
        BeamTreeParams params = averaged(footprint, Intensity::refined);
        params.max_bounces = 2;
        return support::irradiance(*build(scene, params, {}), at);
    };
    const auto points = ask(0);
    for (const float side : {1e-3F, 1e-5F}) {
        const auto squares = ask(side);
        double apart = 0;
        int lit = 0, black = 0;
        for (std::size_t i = 0; i < at.size(); ++i) {
            if (!(points[i].value.mean() > 0)) continue;
            const double ratio =
                static_cast<double>(squares[i].value.mean() / points[i].value.mean());
            apart += std::abs(ratio - 1);
            black += ratio > 0 ? 0 : 1;
            ++lit;
        }
        EXPECT_GT(lit, 150);
        EXPECT_EQ(black, 0) << side;
        EXPECT_LT(apart / lit, 0.05) << side;  // single ones erred by 2.7 times
    }
}

// Light that leaves a block of glass to all sides: planes of sideways light cut the polygons of some of it. A quarter of the
// light was lost.
TEST(BeamSquare, HoldsTheLightThatBeginsBeyondItsMiddle) {
    SceneDesc desc;
    const Transform place(Eigen::Translation3d(0, 0, 1.2) *
                          Eigen::AngleAxisd(0.65, Vec3d(1, 2, 3).normalized()) *
                          Eigen::Scaling(0.5));
    desc.shapes = {support::mesh("block", tessellate_cube(1), place, support::glass(1.5F)),
                   support::horizontal("floor", 0, 4, true, support::diffuse(0.5F))};
    desc.lights = {support::directional_light({0.4, 0.2, -1}, 1)};
    const Scene scene(std::move(desc));
    const auto mean_of = [&](int count, const Vec2& centre, float half) {
        BeamTreeParams params = averaged(2 * half / static_cast<float>(count));
        params.max_bounces = 8;
        std::vector<ReceiverPoint> points;
        for (const Vec2& p : middles(count, half, centre))
            points.push_back(
                support::probe(scene, 1, Vec3(p.x(), p.y(), 0).cast<double>(), Vec3d::UnitZ(), 0));
        double total = 0;
        for (const Estimate& one : support::irradiance(*build(scene, params, {}), points))
            total += static_cast<double>(one.value.mean());
        return total / count / count;
    };
    for (const Vec2& centre : {Vec2(0.3F, 0.2F), Vec2(0.7F, 0.2F)})
        for (const float half : {1.0F, 2.0F})
            EXPECT_NEAR(mean_of(1, centre, half) / mean_of(20, centre, half), 1, 0.02)
                << centre.x() << " " << half;
}

// Light that runs towards the horizon is not even in its polygon: it is asked at the point, as in find_in_beam.
TEST(BeamSquare, IsAPointWhereLightComesDownUnevenly) {
    for (const std::size_t flat : {0U, 1U, 2U}) {
        BeamSet set;
        const std::array<Vec3, 3> corners = {Vec3(-1, -1, 1), Vec3(2, -1, 1), Vec3(-1, 2, 1)};
        for (std::size_t i = 0; i < 3; ++i)
            set.rays.push_back({corners[i], i == flat ? Vec3(0.96F, 0, -0.28F) : Vec3(0, 0, -1)});
        Beam beam;
        beam.corners = {0, 1, 2, Beam::none};
        set.beams = {beam};
        const std::array<const VertexRay*, 4> rays = {&set.rays[0], &set.rays[1], &set.rays[2],
                                                      nullptr};
        const PixelCell cell = PixelCell::square(Vec3d::UnitZ(), 0.1);
        std::vector<BeamHit> on_square, at_point;
        SearchCounts counts;
        Vec3 point = Vec3::Zero();
        for (const VertexRay& ray : set.rays)
            point += (ray.position - ray.direction / ray.direction.z()) / 3;
        const TestPlane plane(point, Vec3::UnitZ());
        find_on_square(set, rays, {0, 0}, plane, *BeamSquare::at(point, cell), on_square, counts);
        find_in_beam(set, rays, {0, 0}, plane, at_point, counts);
        ASSERT_EQ(at_point.size(), 1U);
        ASSERT_EQ(on_square.size(), 1U);
        EXPECT_FALSE(on_square[0].is_part_of_cell());
        EXPECT_EQ(on_square[0].area, at_point[0].area);
    }
}

// Each beam that brings light is one that was tested.
TEST(BeamSquare, CountsTheBeamsThatItMeets) {
    const Scene scene(folded_pool());
    const auto estimator = build(scene, averaged(0.02F), {});
    const auto context = estimator->make_context();
    std::uint64_t lit = 0;
    for (const Vec2& at : middles(10, 0.9F)) {
        const ReceiverPoint point =
            support::probe(scene, 1, Vec3(at.x(), at.y(), -1).cast<double>(), Vec3d::UnitZ(), 0);
        Estimate estimate;
        estimator->irradiance(std::span(&point, 1), std::span(&estimate, 1), *context);
        lit += is_black(estimate.value) ? 0 : 1;
    }
    Counters counters;
    context->add_to(counters);
    EXPECT_GT(lit, 0U);
    EXPECT_GE(counters.at("beam_point_hits"), lit);
    EXPECT_LE(counters.at("beam_point_hits"), counters.at("beam_point_tests"));
}

}  // namespace
}  // namespace caustics::beamtree
