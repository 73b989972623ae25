#include "experiments/notes.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/tessellate.h"
#include "experiments/methods.h"
#include "tests/support/build_scene.h"

namespace caustics {
namespace {

SceneDesc ring() {
    SceneDesc desc;
    desc.shapes = {support::mesh("ring", tessellate_cylinder(8),
                                 Transform(Eigen::Scaling(0.5, 0.5, 0.25)), support::mirror()),
                   support::horizontal("floor", 0, 1.2, true, support::diffuse(0.5F))};
    desc.point_lights = {support::point_light({0, 0.49, 0.4}, 1)};
    return desc;
}

SceneDesc flat_mirror() {
    SceneDesc desc;
    desc.shapes = {support::horizontal("mirror", 1, 1, false, support::mirror()),
                   support::horizontal("floor", 0, 3, true, support::diffuse(0.5F))};
    desc.point_lights = {support::point_light({0, 0, 0.5}, 1)};
    return desc;
}

std::vector<std::string> notes_of(const SceneDesc& desc, const std::string& name,
                                  const std::vector<std::string>& parameters) {
    const Scene scene(desc);
    const Method method = parse_method(name, parameters_node(parameters));
    return notes(scene, method, build(scene, method, RunOptions{})->build_report());
}

TEST(Notes, NameTheLightThatGoesOnToASecondEvent) {
    for (const std::string method : {"beamtree", "causticpolygons"}) {
        const std::vector<std::string> all = notes_of(ring(), method, {});
        ASSERT_EQ(all.size(), 1U);
        for (const std::string part :
             {method.c_str(), " % of the light", "photonmap", "max_bounces=1"})
            EXPECT_NE(all[0].find(part), std::string::npos) << all[0];
        // Asked for.
        EXPECT_TRUE(notes_of(ring(), method, {"max_bounces=1"}).empty());
        EXPECT_TRUE(notes_of(flat_mirror(), method, {}).empty());
    }
}

TEST(Notes, NameParametersThatMakeNoDifference) {
    const std::vector<std::string> given = {"polygons=quads", "light_samples=3",
                                            "mesh_resolution=9"};
    // The ring is a grid, and a mesh.
    std::vector<std::string> with_one_event = given;
    with_one_event.emplace_back("max_bounces=1");
    const std::vector<std::string> of_ring = notes_of(ring(), "beamtree", with_one_event);
    ASSERT_EQ(of_ring.size(), 2U);
    EXPECT_EQ(of_ring[0].rfind("light_samples=3 makes no difference", 0), 0U) << of_ring[0];
    EXPECT_EQ(of_ring[1].rfind("mesh_resolution=9 makes no difference", 0), 0U) << of_ring[1];

    SceneDesc soup = ring();
    soup.shapes[0].mesh.patches.clear();
    EXPECT_EQ(notes_of(soup, "beamtree", {"polygons=quads", "max_bounces=1"}).size(), 1U);

    SceneDesc all_used = flat_mirror();
    all_used.shapes.push_back(support::sphere("lamp", {0, 0, 0.5}, 0.1, support::diffuse(0)));
    all_used.shapes.back().radiance = Spectrum::Ones();
    EXPECT_TRUE(notes_of(all_used, "beamtree", given).empty());
    EXPECT_TRUE(notes_of(all_used, "causticpolygons", {"receiver_resolution=3"}).empty());
    EXPECT_TRUE(notes_of(all_used, "photonmap", {"photons=1"}).empty());
}

}  // namespace
}  // namespace caustics
