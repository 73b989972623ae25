#include <gtest/gtest.h>

#include <cmath>

#include "beamtree/beam_tree.h"
#include "beamtree/caustic_polygons.h"
#include "core/base/error.h"
#include "tests/beamtree/beam_scenes.h"

// Meshes and scenes as they come: through build(), irradiance() and the report alone.
namespace caustics::beamtree {
namespace {

/// What build() makes of a scene at points all over its floor.
std::vector<Estimate> on_floor(const Scene& scene, std::size_t floor,
                               const BeamTreeParams& params = {}) {
    const auto method = build(scene, params, RunOptions{});
    std::vector<ReceiverPoint> points;
    for (int i = 0; i < 400; ++i)
        points.push_back(support::probe(
            scene, floor, {-0.95 + 0.1 * (i % 20), -0.95 + 0.1 * (i / 20), 0}, Vec3d::UnitZ(), 0));
    for (ReceiverPoint& point : points)
        point.position.z() = bounds(scene.shapes()[floor]).max().z();
    return support::irradiance(*method, points);
}

double mean(const std::vector<Estimate>& estimates) {
    double sum = 0;
    for (const Estimate& e : estimates) {
        EXPECT_TRUE(is_finite(e.value));
        sum += static_cast<double>(e.value.mean());
    }
    return sum / static_cast<double>(estimates.size());
}

TEST(BeamTree, BadTrianglesChangeNothing) {
    SceneDesc desc = pool_desc(16);
    TriangleMesh& water = desc.shapes[0].mesh;
    water.patches.clear();
    const double good = mean(on_floor(Scene(desc), 1));
    ASSERT_GT(good, 0);
    const std::size_t count = water.triangles.size();
    for (std::size_t i = 0; i < count; i += 7) {
        auto [a, b, c] = water.triangles[i];
        water.triangles.push_back({b, c, a});  // there already
        water.triangles.push_back({b, a, c});  // there already, turned round
        water.triangles.push_back({a, a, b});  // no area
    }
    const Scene scene(desc);
    EXPECT_NEAR(mean(on_floor(scene, 1)) / good, 1, 1e-6);
    const BuildReport report = build(scene, BeamTreeParams{}, RunOptions{})->build_report();
    EXPECT_EQ(report.counters.at("polygons_degenerate"), (count + 6) / 7);
    EXPECT_EQ(report.counters.at("polygons_duplicated"), 2 * ((count + 6) / 7));
    EXPECT_EQ(report.resolved.at("trees_binned"), 1);  // what goes up meets no receiver
    EXPECT_EQ(report.resolved.at("trees_quadtree"), 0);
}

TEST(BeamTree, HolesLetNothingThroughTheWater) {
    const double whole = mean(on_floor(Scene(pool_desc(16)), 1));
    SceneDesc desc = pool_desc(16);
    std::erase_if(desc.shapes[0].mesh.triangles, [](const auto& t) { return t[0] % 5 == 0; });
    desc.shapes[0].mesh.patches.clear();
    const double holed = mean(on_floor(Scene(desc), 1));
    EXPECT_LT(holed, 0.9 * whole);
    EXPECT_GT(holed, 0.5 * whole);
}

// Without normals every triangle bends light by its own plane, as all methods see such a mesh.
TEST(BeamTree, AMeshWithoutNormalsIsFlat) {
    SceneDesc desc = pool_desc(16);
    desc.shapes[0].mesh.normals.clear();
    const Scene scene(desc);
    const BuildReport report = build(scene, BeamTreeParams{}, RunOptions{})->build_report();
    EXPECT_EQ(report.resolved.at("casters_with_face_normals"), 1);
    EXPECT_NEAR(mean(on_floor(scene, 1)) / mean(on_floor(Scene(pool_desc(16)), 1)), 1, 0.15);
}

// Normals against the winding: core's rule for every method is that such light is lost.
TEST(BeamTree, InvertedWindingIsDarkAndInvertedBothIsTheInside) {
    SceneDesc desc = pool_desc(16);
    for (auto& triangle : desc.shapes[0].mesh.triangles) std::swap(triangle[1], triangle[2]);
    EXPECT_EQ(mean(on_floor(Scene(desc), 1)), 0);
    for (Vec3& normal : desc.shapes[0].mesh.normals) normal = -normal;
    EXPECT_GT(mean(on_floor(Scene(desc), 1)), 0);
}

TEST(BeamTree, TotalReflectionEverywhereIsDarkBelow) {
    SceneDesc desc = pool_desc(8);
    desc.shapes[0].bsdf = support::glass(1.0F, 3.0F);
    desc.lights = {support::point_light({3, 0, 0.2}, 10)};
    EXPECT_EQ(mean(on_floor(Scene(desc), 1)), 0);
}

TEST(BeamTree, NothingLitIsBlack) {
    SceneDesc desc = pool_desc(8);
    desc.lights.clear();
    EXPECT_EQ(mean(on_floor(Scene(desc), 1)), 0);
    desc = pool_desc(8);
    desc.shapes.erase(desc.shapes.begin());
    EXPECT_EQ(mean(on_floor(Scene(desc), 0)), 0);
}

// A glass ball sends nearly all of its light through a second surface.
TEST(BeamTree, FollowsLightThroughASecondSurface) {
    SceneDesc desc = ball_desc(16);
    desc.shapes[0].bsdf = support::glass(1.5F);
    const Scene glass(desc);
    BeamTreeParams one;
    one.max_bounces = 1;
    EXPECT_GT(mean(on_floor(glass, 1, one)), 0);
    EXPECT_GT(mean(on_floor(glass, 1)), 5 * mean(on_floor(glass, 1, one)));
    BuildReport report = build(glass, one, RunOptions{})->build_report();
    EXPECT_EQ(report.resolved.at("most_bounces"), 1);
    EXPECT_EQ(report.resolved.at("flux_share_captured"), 1);
    BeamTreeParams all;
    all.rest = BeamTreeParams::Rest::max_beams;
    report = build(glass, all, RunOptions{})->build_report();
    EXPECT_GE(report.resolved.at("most_bounces"), 4);
    EXPECT_GT(report.resolved.at("flux_share_captured"), 0.99);
    EXPECT_LT(report.resolved.at("flux_share_pruned"), 2e-3);
    // The same ball under water: its polygons are in the shadow of the water.
    SceneDesc inside = pool_desc(16);
    inside.shapes.push_back(support::mesh(
        "ball", tessellate_sphere(8),
        Transform(Eigen::Translation3d(0, 0, -0.5) * Eigen::Scaling(0.1)), support::glass(1.5F)));
    EXPECT_LT(mean(on_floor(Scene(inside), 1, one)), mean(on_floor(Scene(pool_desc(16)), 1)));
}

TEST(BeamTree, EveryBoundAndHierarchyGivesTheSameBits) {
    using Merging = ConeTreeSettings::Merging;
    const Scene scene(pool_desc(12));
    for (const auto leaf : {BeamTreeParams::Leaf::receiver, BeamTreeParams::Leaf::fixed}) {
        BeamTreeParams params;
        params.leaf = leaf;
        const std::vector<Estimate> first = on_floor(scene, 1, params);
        EXPECT_GT(mean(first), 0);
        for (const Bound bound :
             {Bound::single, Bound::double_cone, Bound::hybrid, Bound::sphere_swept})
            for (const auto tree : {BeamTreeParams::Tree::quadtree, BeamTreeParams::Tree::binned})
                for (const Merging merging : {Merging::rays, Merging::cones}) {
                    params.bound = bound;
                    params.hierarchy = tree;
                    params.merging = merging;
                    const std::vector<Estimate> other = on_floor(scene, 1, params);
                    for (std::size_t i = 0; i < first.size(); ++i)
                        EXPECT_TRUE((first[i].value == other[i].value).all());
                }
    }
}

// A quad needs the two triangles of a cell: without them its triangles go by themselves.
TEST(BeamTree, QuadsOfAMeshWithBadTriangles) {
    BeamTreeParams quads;
    quads.polygons = PolygonKind::quad;
    SceneDesc desc = pool_desc(16);
    const double good = mean(on_floor(Scene(desc), 1, quads));
    EXPECT_NEAR(good / mean(on_floor(Scene(desc), 1)), 1, 0.02);
    // One half of a cell is turned so that the two do not make a quad, one is there twice.
    TriangleMesh& water = desc.shapes[0].mesh;
    std::swap(water.triangles[7][0], water.triangles[7][1]);
    water.triangles[12] = water.triangles[10];
    const Scene scene(desc);
    const auto report = build(scene, quads, RunOptions{})->build_report();
    EXPECT_EQ(report.counters.at("polygons"), 512U - 254U);
    EXPECT_EQ(report.resolved.at("quads"), 254);
    EXPECT_NEAR(mean(on_floor(scene, 1, quads)) / good, 1, 0.05);
    // No cells at all.
    desc = pool_desc(16);
    desc.shapes[0].mesh.patches.clear();
    EXPECT_EQ(build(Scene(desc), quads, RunOptions{})->build_report().resolved.at("quads"), 0);
}

// The same mirror twice: a ray meets one of the two.
TEST(BeamTree, TwoCastersAtOnePlaceAreOne) {
    SceneDesc desc = ring_desc(8);
    const std::vector<Estimate> once = on_floor(Scene(desc), 1);
    ASSERT_GT(mean(once), 0);
    desc.shapes.push_back(desc.shapes[0]);
    const Scene scene(desc);
    const std::vector<Estimate> twice = on_floor(scene, 1);
    for (std::size_t i = 0; i < once.size(); ++i)
        EXPECT_TRUE((once[i].value == twice[i].value).all());
    EXPECT_EQ(build(scene, BeamTreeParams{}, RunOptions{})
                  ->build_report()
                  .counters.at("polygons_duplicated"),
              desc.shapes[0].mesh.triangles.size());
}

// A vertex without a direction to bend light by sends none on; its triangles are cut there.
TEST(BeamTree, ANormalOfZeroBendsNothing) {
    SceneDesc desc = pool_desc(16);
    const double good = mean(on_floor(Scene(desc), 1));
    for (std::size_t i = 0; i < desc.shapes[0].mesh.normals.size(); i += 41)
        desc.shapes[0].mesh.normals[i].setZero();
    const double some = mean(on_floor(Scene(desc), 1));
    EXPECT_GT(some, 0.8 * good);
    EXPECT_LE(some, 1.05 * good);
    for (Vec3& normal : desc.shapes[0].mesh.normals) normal.setZero();
    EXPECT_EQ(mean(on_floor(Scene(desc), 1)), 0);
}

std::uint64_t beam_count(const Scene& scene) {
    BeamTreeParams one;
    one.max_bounces = 1;
    const BuildReport report = build(scene, one, RunOptions{})->build_report();
    return report.counters.at("beams") + report.counters.at("beams_unreceived");
}

// The far side of a closed mesh is in the dark, though its mirror has two sides: it sends no beams.
// With a hole in it the mesh encloses nothing, and light may come in.
TEST(BeamTree, BacksOfAClosedMeshSendNothing) {
    SceneDesc desc = ball_desc(16);
    desc.shapes[0].bsdf.twosided = false;
    const Scene one_sided(desc);
    const std::vector<Estimate> truth = on_floor(one_sided, 1);
    ASSERT_GT(mean(truth), 0);
    desc.shapes[0].bsdf.twosided = true;
    const Scene closed(desc);
    EXPECT_EQ(beam_count(closed), beam_count(one_sided));
    EXPECT_EQ(
        build(closed, BeamTreeParams{}, RunOptions{})->build_report().resolved.at("closed_parts"),
        1);
    SceneDesc holed = desc;
    holed.shapes[0].mesh.triangles.pop_back();  // at the north pole, lit
    EXPECT_GT(beam_count(Scene(holed)), beam_count(closed));
    // Turned inside out the same sides are lit.
    SceneDesc turned = desc;
    flip(turned.shapes[0].mesh);
    EXPECT_EQ(beam_count(Scene(turned)), beam_count(closed));
    for (const SceneDesc& other : {desc, turned}) {
        const std::vector<Estimate> found = on_floor(Scene(other), 1);
        for (std::size_t i = 0; i < truth.size(); ++i)
            EXPECT_TRUE(found[i].value.isApprox(truth[i].value, 1e-5F));
    }
    // A lamp inside lights the inside alone.
    desc.lights = {support::point_light({0.1, 0, 0.7}, 1)};
    EXPECT_EQ(beam_count(Scene(desc)), desc.shapes[0].mesh.triangles.size());
    BeamTreeParams one;
    one.max_bounces = 1;
    EXPECT_EQ(mean(on_floor(Scene(desc), 1, one)), 0);
}

// Glass under water: where neither its shadow nor its own light falls the floor is as bright as without it.
TEST(BeamTree, ACasterInsideAnotherCastsAShadow) {
    SceneDesc desc = pool_desc(16);
    const std::vector<Estimate> empty = on_floor(Scene(desc), 1);
    desc.shapes.push_back(support::mesh(
        "ball", tessellate_sphere(16),
        Transform(Eigen::Translation3d(0, 0, -0.7) * Eigen::Scaling(0.2)), support::glass(1.5F)));
    const Scene scene(desc);
    BeamTreeParams one;
    one.max_bounces = 1;
    const std::vector<Estimate> full = on_floor(scene, 1, one);
    int shadowed = 0;
    for (std::size_t i = 0; i < empty.size(); ++i) {
        shadowed += (full[i].value < 0.5F * empty[i].value).all();
        EXPECT_TRUE((full[i].value <= 1.0001F * empty[i].value).all());
        const Vec2d p(-0.95 + 0.1 * static_cast<double>(i % 20),
                      -0.95 + 0.1 * static_cast<double>(i / 20));
        if (p.norm() > 0.6) {
            EXPECT_TRUE((full[i].value == empty[i].value).all()) << p.transpose();
        }
    }
    EXPECT_GT(shadowed, 5);
    EXPECT_LT(shadowed, 60);
    // Followed on, the light that the ball took comes to the floor after all.
    EXPECT_GT(mean(on_floor(scene, 1)), 1.02 * mean(full));
}

// On a triangle, at a vertex, and in the mirror's plane beside it.
TEST(BeamTree, LightsOnACasterAreRefusedAndThoseInItsPlaneGiveNumbers) {
    for (const Vec3d& place : {Vec3d(0.1, 0.1, 0.5), Vec3d(0, 0, 0.5), Vec3d(1.5, 0, 0.5)}) {
        SceneDesc desc;
        desc.shapes = {support::mesh("mirror", tessellate_rectangle(8),
                                     Transform(Eigen::Translation3d(0, 0, 0.5)), support::mirror()),
                       support::horizontal("floor", 0, 2, true, support::diffuse(0.5F))};
        desc.lights = {support::point_light(place, 1)};
        const Scene scene(std::move(desc));
        if (place.x() < 1)
            EXPECT_THROW(on_floor(scene, 1), UnsupportedScene) << place.transpose();
        else
            EXPECT_GE(mean(on_floor(scene, 1)), 0);
    }
}

// Millimetres and kilometres.
TEST(BeamTree, DoesNotKnowTheSizeOfTheScene) {
    const auto scaled = [](float size) {
        SceneDesc desc = pool_desc(16);
        for (Vec3& p : desc.shapes[0].mesh.positions) p *= size;
        desc.shapes[1].to_world =
            Eigen::Scaling(static_cast<double>(size)) * desc.shapes[1].to_world;
        auto& lamp = std::get<PointLight>(desc.lights[0]);
        lamp.position *= size;
        lamp.intensity *= size * size;
        return desc;
    };
    const auto at = [&](float size, const auto& params) {
        const Scene scene(scaled(size));
        const auto method = build(scene, params, RunOptions{});
        double sum = 0;
        for (int i = 0; i < 400; ++i) {
            const Vec3d p(-0.95 + 0.1 * (i % 20), -0.95 + 0.1 * (i / 20), -1);
            const auto found = support::irradiance(
                *method,
                {support::probe(scene, 1, static_cast<double>(size) * p, Vec3d::UnitZ(), 0)});
            EXPECT_TRUE(is_finite(found[0].value));
            sum += static_cast<double>(found[0].value.mean());
        }
        return sum;
    };
    const double refined = at(1, BeamTreeParams{});
    BeamTreeParams area;  // as Watt's polygons
    area.intensity = Intensity::area;
    const double one = at(1, area);
    for (const float size : {1e-3F, 1e3F}) {
        EXPECT_NEAR(at(size, BeamTreeParams{}) / refined, 1, 1e-3);
        EXPECT_NEAR(at(size, area) / one, 1, 1e-3);
        EXPECT_NEAR(at(size, CausticPolygonsParams{}) / one, 1, 1e-3);
    }
}

// Where float positions are far apart: every beam that holds a point of a diffuse polygon is in the
// polygon's list.
// Corners of tilted polygons are not where they should be, so that single points may differ a little.
void expect_nothing_lost(const Vec3& place, double tilt) {
    SceneDesc desc = pool_desc(12);
    for (Vec3& p : desc.shapes[0].mesh.positions) p += place;
    Transform& floor = desc.shapes[1].to_world;
    floor.prerotate(Eigen::AngleAxisd(tilt, Vec3d(1, 0.3, 0).normalized()));
    floor.pretranslate(place.cast<double>());
    std::get<PointLight>(desc.lights[0]).position += place;
    const Vec3d normal = floor.linear().col(2).normalized();
    std::vector<ReceiverPoint> points;
    Rng rng(3, Stage::test, 0);
    const Scene scene(desc);
    for (int i = 0; i < 600; ++i) {
        const Vec3 share(0.6F * rng.next() - 0.3F, 0.6F * rng.next() - 0.3F, 0);
        points.push_back(
            support::probe(scene, 1, scene.shapes()[1].to_world * share.cast<double>(), normal, 0));
    }
    CausticPolygonsParams params;
    params.receiver_resolution = 48;
    BeamTreeParams area;
    area.intensity = Intensity::area;
    const auto tree = support::irradiance(*build(scene, area, {}), points);
    const auto polygons = support::irradiance(*build(scene, params, {}), points);
    int different = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
        different += ((tree[i].value - polygons[i].value).abs() > 0.1F * tree[i].value).any();
    EXPECT_LE(different, 5) << place.transpose() << ", " << tilt;
    // One of the points alone, held here and not there, is 1/600.
    EXPECT_NEAR(mean(polygons) / mean(tree), 1, 2e-3) << place.transpose() << ", " << tilt;
}

TEST(CausticPolygons, LoseNothingFarFromTheOrigin) {
    for (const double tilt : {0.0, 0.2}) {
        expect_nothing_lost({0, 0, 0}, tilt);
        expect_nothing_lost({30'000, 20'000, -5'000}, tilt);
        expect_nothing_lost({0, 0, 1e5F}, tilt);
    }
}

}  // namespace
}  // namespace caustics::beamtree
