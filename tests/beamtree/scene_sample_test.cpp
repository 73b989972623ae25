#include "beamtree/scene_sample.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "beamtree/beam_tree_method.h"
#include "beamtree/caustic_polygons.h"
#include "beamtree/tracing/traced_scene.h"
#include "core/base/error.h"
#include "tests/beamtree/beam_scenes.h"

namespace caustics::beamtree {
namespace {

SceneDesc meshed_glass_ball(int resolution) {
    SceneDesc desc = ball_desc(resolution);
    desc.shapes[0].bsdf = support::glass(1.5F);
    return desc;
}

// Some hundred polygons: their scatter is a few percent of what all have.
TEST(SceneSample, TellsOfAllBeams) {
    const Scene scene(meshed_glass_ball(24));
    const TracedScene all = trace_scene(scene, "beams", {}, {});
    const SceneSample sample = sample_scene(scene, "beams", {}, {});
    EXPECT_EQ(sample.polygons, all.report().counters.at("polygons"));
    EXPECT_GT(sample.polygons_sampled, 100U);
    EXPECT_NEAR(sample.balance.captured(), all.balance.captured(), 0.02);
}

TEST(SceneSample, DoesNotGrowWithTheScene) {
    const SceneSample few = sample_scene(Scene(meshed_glass_ball(16)), "beams", {}, {});
    const SceneSample many = sample_scene(Scene(meshed_glass_ball(200)), "beams", {}, {});
    EXPECT_GT(many.polygons, 100 * few.polygons);
    EXPECT_LT(many.polygons_sampled, 2 * few.polygons_sampled);
}

TEST(SceneSample, CountsThePolygonsOfExactShapes) {
    SceneDesc desc = meshed_glass_ball(8);
    const auto place = [&](Primitive primitive, double x) {
        Shape shape = support::sphere("shape", {x, 0, 2}, 0.1, support::glass(1.5F));
        shape.primitive = primitive;
        desc.shapes.push_back(shape);
    };
    place(Primitive::sphere, 1);
    place(Primitive::sphere, 2);
    place(Primitive::disk, 3);
    std::uint64_t polygons = 0;
    const BeamParams params;
    for (const Shape& shape : desc.shapes)
        if (std::holds_alternative<Dielectric>(shape.bsdf.model))
            polygons += tessellate_shape(shape, params.mesh_resolution).triangles.size();
    EXPECT_EQ(sample_scene(Scene(desc), "beams", params, {}).polygons, polygons);
}

TEST(SceneSample, OfNothingIsNothing) {
    SceneDesc dark = meshed_glass_ball(8);
    dark.lights.clear();
    EXPECT_EQ(sample_scene(Scene(dark), "beams", {}, {}).polygons_sampled, 0U);
    SceneDesc bare = meshed_glass_ball(8);
    bare.shapes.erase(bare.shapes.begin());
    EXPECT_EQ(sample_scene(Scene(bare), "beams", {}, {}).polygons, 0U);
}

// Where only is asked what a method can serve, both take it, and bring no light.
template <typename Params>
void expect_sample(const DescribedMethod<Params>& method, const std::string& parameters) {
    const Scene scene(meshed_glass_ball(24));
    const auto least =
        method.configure(JsonNode::parse_text(parameters, "test"))->with_least_work();
    const auto built = least->build(scene, {}, 0);
    EXPECT_GT(built->build_report().counters.at("polygons_sampled"), 0U);
    const auto context = built->make_context();
    EXPECT_THROW(built->irradiance({}, {}, *context), std::logic_error);
    EXPECT_THROW(built->radiance({}, {}, *context), std::logic_error);
}

TEST(SceneSample, IsTheLeastWorkOfBothMethods) {
    expect_sample(beamtree_method(), R"({"rest": "max_beams"})");
    expect_sample(causticpolygons_method(), "{}");
}

TEST(FluxBalance, RefusesToLoseMostLight) {
    require_most_light({.lit = 2, .lost = 0.99}, "beams", "");
    try {
        require_most_light({.lit = 2, .lost = 1.2}, "beams", " in a sample of 8 polygons");
        FAIL() << "not refused";
    } catch (const UnsupportedScene& error) {
        EXPECT_EQ(
            std::string(error.what())
                .find("beams: beams lose 60 % of the light between specular surfaces in a sample "
                      "of 8 polygons, "),
            0U);
    }
}

std::vector<bool> left_out_but(const Scene& scene, double share) {
    return caster_meshes(scene, 64, PolygonKind::triangle, 1, share).front().left_out;
}

TEST(SceneSample, LeavesOutAllButAShareSpreadEvenly) {
    const Scene scene(meshed_glass_ball(64));
    const std::vector<bool> quarter = left_out_but(scene, 0.25);
    const auto kept = [&](std::size_t first, std::size_t end) {
        return std::count(quarter.begin() + static_cast<std::ptrdiff_t>(first),
                          quarter.begin() + static_cast<std::ptrdiff_t>(end), false);
    };
    const std::size_t all = quarter.size();
    constexpr std::size_t parts = 16;
    for (std::size_t i = 0; i < parts; ++i)
        EXPECT_NEAR(static_cast<double>(kept(i * all / parts, (i + 1) * all / parts)),
                    0.25 * static_cast<double>(all) / parts, 6);
    for (std::size_t i = 0; i + 1 < all; i += 2) EXPECT_EQ(quarter[i], quarter[i + 1]);
}

TEST(SceneSample, KeepsWhatASmallerShareKeeps) {
    const Scene scene(meshed_glass_ball(32));
    const std::vector<bool> some = left_out_but(scene, 0.05);
    const std::vector<bool> more = left_out_but(scene, 0.3);
    for (std::size_t i = 0; i < some.size(); ++i) EXPECT_TRUE(some[i] || !more[i]);
}

}  // namespace
}  // namespace caustics::beamtree
