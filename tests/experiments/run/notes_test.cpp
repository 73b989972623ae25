#include "experiments/run/notes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "core/exact_shapes/rectangle.h"
#include "core/geometry/tessellate.h"
#include "core/math/rng.h"
#include "core/mesh/vertex_normals.h"
#include "experiments/run/method.h"
#include "experiments/run/wide_triangles.h"
#include "tests/support/build_scene.h"

namespace caustics::experiments {
namespace {

SceneDesc ring() {
    SceneDesc desc;
    desc.shapes = {support::mesh("ring", tessellate_cylinder(8),
                                 Transform(Eigen::Scaling(0.5, 0.5, 0.25)), support::mirror()),
                   support::horizontal("floor", 0, 1.2, true, support::diffuse(0.5F))};
    desc.lights = {support::point_light({0, 0.49, 0.4}, 1)};
    return desc;
}

SceneDesc flat_mirror() {
    SceneDesc desc;
    desc.shapes = {support::horizontal("mirror", 1, 1, false, support::mirror()),
                   support::horizontal("floor", 0, 3, true, support::diffuse(0.5F))};
    desc.lights = {support::point_light({0, 0, 0.5}, 1)};
    return desc;
}

std::vector<std::string> notes_of(const SceneDesc& desc, const std::string& name,
                                  const std::vector<std::string>& parameters) {
    const Scene scene(desc);
    const Method method = parse_method(name, parameters_node(parameters));
    const BuildReport report = build(scene, method, RunOptions{})->build_report();
    return notes(scene, method, report, caustic_ledger(scene, method, report));
}

/// Of a method that chose these values by itself.
std::vector<std::string> notes_of_report(const SceneDesc& desc, const std::string& name,
                                         const std::vector<std::string>& parameters,
                                         const std::map<std::string, double>& resolved) {
    BuildReport report;
    report.resolved = resolved;
    const Scene scene(desc);
    const Method method = parse_method(name, parameters_node(parameters));
    return notes(scene, method, report, caustic_ledger(scene, method, report));
}

/// Without those on light that a limit of events cuts.
std::vector<std::string> notes_but_on_cuts(const SceneDesc& desc, const std::string& name,
                                           const std::vector<std::string>& parameters) {
    std::vector<std::string> all = notes_of(desc, name, parameters);
    std::erase_if(all, [](const std::string& note) {
        return note.starts_with("max_bounces=") && note.find(" cuts ") != std::string::npos;
    });
    return all;
}

bool any_holds(const std::vector<std::string>& notes, const std::vector<std::string>& words) {
    return std::ranges::any_of(notes, [&](const std::string& note) {
        return std::ranges::all_of(
            words, [&](const std::string& word) { return note.find(word) != std::string::npos; });
    });
}

TEST(Notes, NameALightThatLiesOnACaster) {
    SceneDesc desc = flat_mirror();
    EXPECT_EQ(notes_on(Scene(desc)), std::vector<std::string>{});
    desc.lights = {support::point_light({0.1, 0.2, 1}, 1)};
    const auto all = notes_on(Scene(desc));
    ASSERT_EQ(all.size(), 1U);
    EXPECT_TRUE(all[0].starts_with("the light at (0.1, 0.2, 1) lies on mirror: on which of its "))
        << all[0];
}

TEST(Notes, TellThatFlatPolygonsStandForACurvedReceiver) {
    SceneDesc desc = flat_mirror();
    const std::vector<std::string> words = {"5 x 5 flat polygons", "receiver ball"};
    EXPECT_FALSE(any_holds(notes_of(desc, "causticpolygons", {"receiver_resolution=5"}), words));
    desc.shapes.push_back(support::sphere("ball", {0, 0, 0.2}, 0.1, support::diffuse(0.5F)));
    EXPECT_TRUE(any_holds(notes_of(desc, "causticpolygons", {"receiver_resolution=5"}), words));
    EXPECT_FALSE(any_holds(notes_of(desc, "beamtree", {}), {"flat polygons"}));
    desc.shapes.back().primitive = Primitive::cylinder;
    EXPECT_TRUE(any_holds(notes_of(desc, "causticpolygons", {"receiver_resolution=5"}), words));
}

TEST(Notes, TellThatPhotonsKeepNoWavelengthsForGlassBeforeTheEye) {
    const std::vector<std::string> words = {"seen through mirror, which disperses"};
    SceneDesc desc = flat_mirror();
    Dielectric dielectric;
    dielectric.int_ior = Ior::abbe(1.6, 30);
    desc.shapes[0].bsdf = {dielectric, false};
    desc.camera.to_world = Transform(Eigen::Translation3d(0, 0, -2));
    EXPECT_FALSE(any_holds(notes_of(desc, "photonmap", {"photons=100"}), words))
        << "the floor hides it";
    desc.camera.to_world = Transform(Eigen::Translation3d(0, 0, 2));
    EXPECT_FALSE(any_holds(notes_of(desc, "photonmap", {"photons=100"}), words))
        << "the camera sees nothing at all";
    desc.camera.to_world = Transform(Eigen::Translation3d(0, 0, 0.1));
    EXPECT_TRUE(any_holds(notes_of(desc, "photonmap", {"photons=100"}), words));
    EXPECT_TRUE(any_holds(notes_of(desc, "illuminationmap", {"emitted=100"}), words));
    EXPECT_FALSE(any_holds(notes_of(desc, "beamtree", {}), words));
    desc.shapes[0].bsdf = support::glass(1.6F);
    EXPECT_FALSE(any_holds(notes_of(desc, "photonmap", {"photons=100"}), words));
}

TEST(Notes, TellThatPartsOfTheWavelengthsDrawSteps) {
    const auto notes_of_glass = [](bool disperses, const std::string& method,
                                   const std::vector<std::string>& parameters) {
        SceneDesc desc = flat_mirror();
        Dielectric dielectric;
        dielectric.int_ior = disperses ? Ior::abbe(1.6, 30) : Ior(1.6F);
        dielectric.ext_ior = 1;
        desc.shapes[0].bsdf = {dielectric, false};
        return notes_of(desc, method, parameters);
    };
    for (const std::string method : {"beamtree", "causticpolygons"}) {
        EXPECT_TRUE(any_holds(notes_of_glass(true, method, {"wavelengths=5"}),
                              {"5 parts of the wavelengths", "a larger wavelengths"}));
        EXPECT_FALSE(any_holds(notes_of_glass(false, method, {}), {"parts of the wavelengths"}));
        EXPECT_TRUE(any_holds(notes_of_glass(false, method, {"wavelengths=5"}),
                              {"wavelengths=5 makes no difference", "no caster is dispersive"}));
    }
    EXPECT_TRUE(any_holds(notes_of_glass(true, "beamtree", {}), {"dispersion=intervals"}));
    EXPECT_FALSE(any_holds(notes_of_glass(true, "beamtree", {"dispersion=intervals"}),
                           {"parts of the wavelengths"}));
    EXPECT_TRUE(any_holds(notes_of_glass(false, "beamtree", {"dispersion=intervals"}),
                          {"dispersion=intervals makes no difference"}));
    SceneDesc prism = flat_mirror();
    Dielectric flint;
    flint.int_ior = Ior::abbe(1.6, 30);
    prism.shapes[0].bsdf = {flint, false};
    EXPECT_EQ(notes_of_report(prism, "pathtrace", {}, {{"flux_share_captured", 1}}),
              std::vector<std::string>{})
        << "a method without that parameter";
}

TEST(Notes, NameLobesThatPhotonsBlur) {
    const auto notes_of_lobe = [](float exponent, const std::string& method) {
        SceneDesc desc = flat_mirror();
        Phong phong;
        phong.exponent = exponent;
        desc.shapes[1].bsdf.model = phong;
        return notes_of(desc, method, {});
    };
    EXPECT_TRUE(any_holds(notes_of_lobe(1000, "photonmap"), {"1.4 degrees", "within 2.1"}));
    EXPECT_TRUE(notes_of_lobe(30, "photonmap").empty());
    EXPECT_TRUE(notes_of_lobe(1000, "beamtree").empty());
}

TEST(Notes, NameAColourThatFewParticlesCarry) {
    const auto notes_of_green = [](float green, const std::string& method,
                                   const std::vector<std::string>& parameters = {}) {
        SceneDesc desc = flat_mirror();
        PointLight red = support::point_light({0, 0, 0.5}, 0);
        red.intensity[0] = 1;
        PointLight weak = red;
        weak.intensity = {0, green, 0};
        desc.lights = {red, weak};
        return notes_of(desc, method, parameters);
    };
    EXPECT_TRUE(any_holds(notes_of_green(1e-4F, "photonmap"), {"one colour", "0.01 %"}));
    EXPECT_TRUE(any_holds(notes_of_green(1e-4F, "lighttrace"), {"one colour", "0.01 %"}));
    EXPECT_TRUE(any_holds(notes_of_green(1e-4F, "illuminationmap", {"emitted=100"}),
                          {"one colour", "0.01 %"}));
    EXPECT_TRUE(notes_of_green(0.1F, "photonmap").empty());
    EXPECT_TRUE(notes_of_green(1e-4F, "beamtree").empty());
}

TEST(Notes, NameAPhotonMapOfAnOldFile) {
    EXPECT_TRUE(any_holds(
        notes_of_report(flat_mirror(), "photonmap", {"photons=100"}, {{"photon_map_version", 2}}),
        {"file has version 2", "trace and save it again"}));
}

TEST(Notes, NameACasterThatIsTooFarAway) {
    SceneDesc desc = flat_mirror();
    desc.shapes.push_back(support::sphere("bead", {500, 0, 0}, 0.0035, support::glass(1.5F)));
    const auto all = notes_of(desc, "photonmap", {"photons=100"});
    ASSERT_EQ(all.size(), 1U);
    EXPECT_TRUE(all[0].starts_with("bead lies 4.1e+04 times its size from the other casters"))
        << all[0];
    EXPECT_TRUE(notes_of(flat_mirror(), "photonmap", {"photons=100"}).empty());
}

// Panes of glass thrown about: what one polygon's corners meet is seldom one pane.
SceneDesc panes() {
    SceneDesc desc = flat_mirror();
    desc.shapes.erase(desc.shapes.begin());
    Rng rng(5, Stage::test, 0);
    const auto random = [&rng] {
        return Vec3d(2 * Vec3(rng.next(), rng.next(), rng.next()).cast<double>() - Vec3d::Ones());
    };
    for (int i = 0; i < 24; ++i) {
        const Vec3d u = random().normalized();
        const Vec3d v = u.cross(random()).normalized();
        const Vec3d middle = Vec3d(0, 0, 0.9) + 0.4 * random();
        desc.shapes.push_back(support::rectangle("pane" + std::to_string(i), middle, 0.15 * u,
                                                 0.15 * v, support::glass(2.4F)));
    }
    desc.lights = {support::point_light({0, 0, 3}, 1)};
    return desc;
}

TEST(Notes, NameTheShapeWhoseSmoothNormalsLoseLight) {
    TriangleMesh cube = tessellate_cube(2);
    cube.normals.clear();
    SceneDesc desc = flat_mirror();
    desc.lights = {support::point_light({0, 0.3, 4}, 1)};
    desc.shapes[0] = support::mesh("crystal", cube, Transform(Eigen::Translation3d(0, 0, 2)),
                                   support::glass(1.5F));
    const std::vector<std::string> photons = {"photons=2000"};
    EXPECT_EQ(notes_of(desc, "photonmap", photons), std::vector<std::string>{});
    EXPECT_EQ(notes_on(Scene(desc)), std::vector<std::string>{});
    complete_normals(cube);
    desc.shapes[0] = support::mesh("crystal", cube, Transform(Eigen::Translation3d(0, 0, 2)),
                                   support::glass(1.5F));
    EXPECT_TRUE(
        any_holds(notes_of(desc, "photonmap", photons),
                  {"% of the light on casters", "crystal, by up to 55 degrees", "face_normals"}));
    EXPECT_TRUE(any_holds(notes_on(Scene(desc)), {"crystal, by up to 55", "face_normals: true"}));
}

TEST(Notes, NameAChannelThatIsTooWeakToBeStoredWhole) {
    SceneDesc desc = flat_mirror();
    desc.shapes[0].bsdf = support::mirror();
    auto& mirror = std::get<Conductor>(desc.shapes[0].bsdf.model);
    const std::vector<std::string> photons = {"photons=2000"};
    mirror.specular_reflectance = Spectrum(1, 0.1F, 0);
    EXPECT_EQ(notes_of(desc, "photonmap", photons), std::vector<std::string>{});
    mirror.specular_reflectance = Spectrum(1, 0.1F, 0.002F);
    EXPECT_TRUE(any_holds(notes_of(desc, "photonmap", photons), {"100 %", "weakest channel"}));
}

TEST(Notes, SayWhereTheEyesMediumCannotBeTold) {
    SceneDesc desc = flat_mirror();
    const Spectrum ink = Spectrum::Constant(0.5F);
    desc.shapes[0] = support::horizontal("water", 1, 1, true, support::glass(1.33F, 1, ink));
    desc.camera = support::camera({0, 0, 0.5}, {0, 0.1, 0}, {0, 0, 1}, 60, 4, 4);
    EXPECT_EQ(notes_on(Scene(desc)), std::vector<std::string>{});
    desc.shapes.push_back(support::sphere("ball", {0.5, 0, 0.3}, 0.2, support::glass(1.5F)));
    EXPECT_TRUE(any_holds(notes_on(Scene(desc)), {"eye", "ext_absorption"}));
}

TEST(Notes, SayThatLightFromAfarStartsAtTheBounds) {
    SceneDesc desc = flat_mirror();
    const Spectrum ink = Spectrum::Constant(0.5F);
    desc.camera = support::camera({0, 0, 0.5}, {0, 0.1, 0}, {0, 0, 1}, 60, 4, 4);
    desc.shapes[0] = support::horizontal("water", 1, 1, true, support::glass(1.33F, 1, ink));
    const auto lit_by = [&](const Light& light) {
        desc.lights = {light};
        return any_holds(notes_on(Scene(desc)), {"infinitely far", "bounds"});
    };
    const Light sun = support::directional_light({0.1, 0, -1}, 1);
    EXPECT_FALSE(lit_by(sun)) << "the water lies below";
    desc.shapes[0] =
        support::horizontal("water", 1, 1, true, support::glass(1.33F, 1, black(), ink));
    EXPECT_TRUE(lit_by(sun));
    EXPECT_TRUE(lit_by(ConstantLight{Spectrum::Ones()}));
    EXPECT_FALSE(lit_by(support::point_light({0, 0, 3}, 1)));
}

/// A pane of two meshes under a lamp, over a floor; `smooth`: bent by its normals.
SceneDesc pane_of_triangles(int cells, double lamp, bool smooth) {
    SceneDesc desc;
    TriangleMesh top = tessellate_rectangle(cells), bottom = tessellate_rectangle(cells);
    flip(bottom);
    if (smooth)
        for (std::size_t i = 0; i < top.positions.size(); ++i)
            top.normals[i] = (Vec3(0, 0, 9) + top.positions[i]).normalized();
    desc.shapes = {support::mesh("top", std::move(top), Transform(Eigen::Translation3d(0, 0, 1.2)),
                                 support::glass(1.5F)),
                   support::mesh("bottom", std::move(bottom),
                                 Transform(Eigen::Translation3d(0, 0, 1)), support::glass(1.5F)),
                   support::horizontal("floor", 0, 3, true, support::diffuse(0.5F))};
    desc.lights = {support::point_light({0, 0, lamp}, 1)};
    return desc;
}

TEST(Notes, NameGlassOfTrianglesThatALightSeesWide) {
    const auto pane = [](int cells, double lamp, bool smooth, const std::string& intensity) {
        return notes_of(pane_of_triangles(cells, lamp, smooth), "beamtree",
                        {"light_samples=1", "intensity=" + intensity});
    };
    const std::vector<std::string> words = {"a light sees top in triangles", "degrees wide"};
    const std::vector<std::string> remedy = {words[0], "intensity=refined"};
    EXPECT_TRUE(any_holds(pane(1, 2.2, false, "area"), remedy));
    EXPECT_FALSE(any_holds(pane(1, 2.2, false, "refined"), words));
    EXPECT_TRUE(any_holds(pane(1, 2.2, true, "refined"), words));
    EXPECT_FALSE(any_holds(pane(64, 2.2, true, "area"), words));
    EXPECT_FALSE(any_holds(pane(1, 100, true, "area"), words));
    const auto polygons =
        notes_of(pane_of_triangles(1, 2.2, false), "causticpolygons", {"max_bounces=2"});
    EXPECT_TRUE(any_holds(polygons, words));
    EXPECT_FALSE(any_holds(polygons, remedy)) << "it has no such parameter";
}

TEST(WideTriangles, AreThoseThatALightSeesFromItsPlace) {
    SceneDesc desc = pane_of_triangles(1, 2.2, true);
    EXPECT_EQ(wide_triangles(Scene(desc), Triangles::of_changing_normals, 0.1)->shape, "top");
    for (Shape& shape : desc.shapes) shape.mesh.normals.clear();
    EXPECT_EQ(wide_triangles(Scene(desc), Triangles::all, 0.1)->shape, "top");
    EXPECT_FALSE(wide_triangles(Scene(desc), Triangles::of_changing_normals, 0.1))
        << "without normals each triangle is flat";
    desc.lights = {ConstantLight(), support::directional_light({0, 0, -1}, 1)};
    EXPECT_FALSE(wide_triangles(Scene(desc), Triangles::all, 0)) << "lights without a place";
}

TEST(Notes, NameAWallBetweenWhichLightMayGrow) {
    SceneDesc desc = flat_mirror();
    EXPECT_TRUE(notes_on_indirect(Scene(desc)).empty());
    desc.shapes[1].bsdf = support::phong(0.1F, 1, 3);
    EXPECT_TRUE(notes_on_indirect(Scene(desc)).empty()) << "normalised";
    desc.shapes[1].bsdf = support::phong(0.1F, 1, 3, Phong::Model::classic);
    EXPECT_TRUE(any_holds(notes_on_indirect(Scene(desc)), {"floor", "1975", "without end"}));
}

TEST(Notes, NameDielectricsThatCross) {
    SceneDesc desc = flat_mirror();
    desc.shapes.push_back(support::sphere("left", {0, 0, 3}, 0.2, support::glass(1.5F)));
    desc.shapes.push_back(support::sphere("right", {0.5, 0, 3}, 0.2, support::glass(1.5F)));
    EXPECT_EQ(notes_on(Scene(desc)), std::vector<std::string>{});
    desc.shapes.push_back(support::sphere("middle", {0.25, 0, 3}, 0.2, support::glass(1.5F)));
    EXPECT_TRUE(any_holds(notes_on(Scene(desc)), {"left and middle", "1 pair more", "cross"}));
    desc.shapes.push_back(support::sphere("last", {0.5, 0.35, 3}, 0.2, support::glass(1.5F)));
    EXPECT_TRUE(any_holds(notes_on(Scene(desc)), {"left and middle (and 2 pairs more) cross"}));
}

TEST(Notes, CountCrossingDielectricsUpToALimit) {
    SceneDesc desc = flat_mirror();
    for (int i = 0; i < 11; ++i) {
        const double at = 0.1 * i;
        desc.shapes.push_back(support::rectangle("along", {0.5, at, 3}, {0.6, 0, 0}, {0, 0, 0.5},
                                                 support::glass(1.5F)));
        desc.shapes.push_back(support::rectangle("across", {at, 0.5, 3}, {0, 0.6, 0}, {0, 0, 0.5},
                                                 support::glass(1.5F)));
    }
    const std::vector<std::string> all = notes_on(Scene(desc));
    EXPECT_TRUE(any_holds(all, {"(and 99 pairs more, at least) cross"})) << all.at(0);
}

TEST(Notes, NameACasterThatLiesOnAnotherShape) {
    SceneDesc desc = flat_mirror();
    const auto block = [&](double z) {
        const Transform at(Eigen::Translation3d(0, 0, z + 0.25) * Eigen::Scaling(0.25));
        desc.shapes.back() = support::mesh("block", tessellate_cube(1), at, support::glass(1.5F));
        return notes_on(Scene(desc));
    };
    desc.shapes.emplace_back();
    EXPECT_FALSE(any_holds(block(1e-3), {"lies with a face"}));
    EXPECT_TRUE(any_holds(block(0), {"block lies with a face on floor: light", "leave a gap"}));
}

TEST(Notes, NameDielectricsThatDisagree) {
    SceneDesc desc = flat_mirror();
    desc.shapes.push_back(support::sphere("glass", {0, 0, 3}, 0.3, support::glass(1.5F)));
    desc.shapes.push_back(support::sphere("water", {0, 0, 3}, 0.2, support::glass(1.333F)));
    EXPECT_TRUE(any_holds(notes_on(Scene(desc)),
                          {"glass and water", "disagree", "n = 1.5 and 1", "ext_ior"}));
    std::get<Dielectric>(desc.shapes.back().bsdf.model).ext_ior = 1.5F;
    EXPECT_EQ(notes_on(Scene(desc)), std::vector<std::string>{});
    std::get<Dielectric>(desc.shapes.back().bsdf.model).ext_absorption = Spectrum::Constant(5);
    EXPECT_TRUE(any_holds(notes_on(Scene(desc)),
                          {"glass and water disagree", "between them, what it absorbs: light"}));
    // Of those that cross another note tells.
    desc.shapes.back() = support::sphere("water", {0.2, 0, 3}, 0.2, support::glass(1.333F));
    EXPECT_EQ(notes_on(Scene(desc)).size(), 1U);
}

TEST(Notes, NameWallsThinnerThanPolygonsAreFlat) {
    const auto bulb = [](double wall) {
        SceneDesc desc = flat_mirror();
        desc.shapes.push_back(support::sphere("bulb", {0, 0, 3}, 0.5, support::glass(1.5F)));
        desc.shapes.push_back(support::sphere("air", {0, 0, 3}, 0.5 - wall, support::glass(1)));
        std::get<Dielectric>(desc.shapes.back().bsdf.model).ext_ior = 1.5F;
        return desc;
    };
    const std::vector<std::string> given = {"mesh_resolution=16", "max_bounces=2"};
    EXPECT_TRUE(any_holds(notes_of(bulb(1e-3), "beamtree", given),
                          {"100 %", "walls", "mesh_resolution", "photonmap"}));
    for (const std::string& note : notes_of(bulb(0), "beamtree", given))
        EXPECT_EQ(note.find("times as fine"), std::string::npos) << note;
    for (const std::string& note : notes_of(bulb(0.05), "beamtree", given))
        EXPECT_EQ(note.find("walls"), std::string::npos) << note;
}

TEST(Notes, NameTheLightThatBeamsLose) {
    for (const std::string method : {"beamtree", "causticpolygons"}) {
        const std::vector<std::string> coarse = {"mesh_resolution=2", "max_bounces=4", "prune=0.1"};
        const std::vector<std::string> all = notes_but_on_cuts(panes(), method, coarse);
        ASSERT_EQ(all.size(), 1U);
        for (const std::string part :
             {method.c_str(), " % of the light", "photonmap", "max_bounces=1"})
            EXPECT_NE(all[0].find(part), std::string::npos) << all[0];
        EXPECT_EQ(all[0].find("rest=photons") != std::string::npos, method == "beamtree");
        // One event alone loses nothing, and smooth casters little.
        EXPECT_TRUE(
            notes_but_on_cuts(panes(), method, {"mesh_resolution=2", "max_bounces=1"}).empty());
        EXPECT_TRUE(notes_of(ring(), method, {}).empty());
    }
}

TEST(Notes, SayWhereTheLightThatBeamsLoseIs) {
    const auto lost = [](double over_budget) {
        return notes_of_report(ring(), "beamtree", {},
                               {{"flux_share_captured", 0.75},
                                {"flux_share_pruned", 0.125},
                                {"flux_share_over_budget", over_budget}});
    };
    EXPECT_TRUE(any_holds(lost(0.1), {"loses 25.0 %", "12.5 % in paths too weak to be followed, ",
                                      "10.0 % in beams that max_beams has no room for"}));
    EXPECT_TRUE(any_holds(lost(0), {"loses 25.0 %", "12.5 % in paths"}));
    EXPECT_FALSE(any_holds(lost(0), {"max_beams"}));
}

TEST(Notes, SayThatPhotonsCarryWhatMaxBeamsLeavesOut) {
    const std::vector<std::string> few = {"mesh_resolution=16", "max_beams=200", "max_bounces=2"};
    SceneDesc ball = flat_mirror();
    ball.shapes[0] = support::sphere("ball", {0, 0, 0.25}, 0.15, support::glass(1.5F));
    const std::vector<std::string> words = {"max_beams has no room", "photons carry"};
    EXPECT_TRUE(any_holds(notes_of(ball, "beamtree", few), words));
    EXPECT_FALSE(
        any_holds(notes_of(ball, "beamtree", {"mesh_resolution=16", "max_bounces=2"}), words));
    std::vector<std::string> asked = few;
    asked.emplace_back("rest=photons");
    EXPECT_FALSE(any_holds(notes_of(ball, "beamtree", asked), words));
    std::vector<std::string> none = few;
    none.emplace_back("rest=none");
    const std::vector<std::string> lost = notes_of(ball, "beamtree", none);
    EXPECT_FALSE(any_holds(lost, words));
    EXPECT_TRUE(any_holds(lost, {"loses", "max_beams has no room"}));
}

TEST(Notes, NameParametersThatMakeNoDifference) {
    const std::vector<std::string> given = {"polygons=quads", "light_samples=3",
                                            "mesh_resolution=9"};
    // The ring is a grid, and a mesh.
    std::vector<std::string> with_one_event = given;
    with_one_event.emplace_back("max_bounces=1");
    const std::vector<std::string> of_ring = notes_but_on_cuts(ring(), "beamtree", with_one_event);
    ASSERT_EQ(of_ring.size(), 2U);
    EXPECT_EQ(of_ring[0].rfind("light_samples=3 makes no difference", 0), 0U) << of_ring[0];
    EXPECT_EQ(of_ring[1].rfind("mesh_resolution=9 makes no difference", 0), 0U) << of_ring[1];

    SceneDesc soup = ring();
    soup.shapes[0].mesh.patches.clear();
    EXPECT_EQ(notes_but_on_cuts(soup, "beamtree", {"polygons=quads", "max_bounces=1"}).size(), 1U);

    SceneDesc all_used = flat_mirror();
    all_used.shapes.push_back(support::sphere("lamp", {0, 0, 0.5}, 0.1, support::diffuse(0)));
    all_used.shapes.back().radiance = Spectrum::Ones();
    EXPECT_TRUE(notes_of(all_used, "beamtree", given).empty());
    EXPECT_TRUE(notes_of(all_used, "causticpolygons", {"receiver_resolution=3"}).empty());
    EXPECT_TRUE(notes_of(all_used, "photonmap", {"photons=1"}).empty());
}

TEST(Notes, SayWherePhotonsHaveNothingToCarry) {
    const std::vector<std::string> words = {"rest=photons makes no difference", "nothing is left"};
    const std::vector<std::string> given = {"mesh_resolution=2", "rest=photons",
                                            "rest_photons=1000"};
    std::vector<std::string> pruned = given;
    pruned.insert(pruned.end(), {"max_bounces=4", "prune=0.1"});
    EXPECT_TRUE(any_holds(notes_of(ring(), "beamtree", {"rest=photons", "max_bounces=1"}), words));
    EXPECT_FALSE(any_holds(notes_of(panes(), "beamtree", pruned), words));
    EXPECT_FALSE(any_holds(notes_of(ring(), "beamtree", {"max_bounces=1"}), words));
    // What beams leave out may be so little that no photon was of it.
    const auto left_out = [](double too_weak, double over_budget) {
        return notes_of_report(ring(), "beamtree", {"rest=photons"},
                               {{"flux_share_captured", 1},
                                {"flux_share_rest", 0},
                                {"flux_share_pruned", too_weak},
                                {"flux_share_over_budget", over_budget}});
    };
    EXPECT_TRUE(any_holds(left_out(0, 0), words));
    EXPECT_FALSE(any_holds(left_out(1e-9, 0), words));
    EXPECT_FALSE(any_holds(left_out(0, 1e-9), words));
}

std::vector<std::string> notes_of_picture(const std::string& method, const std::string& indirect,
                                          const std::string& parameter, int samples) {
    RunOptions options;
    options.samples_per_pixel = samples;
    const bool is_indirect = !indirect.empty();
    const JsonNode given = parameters_node({parameter});
    const JsonNode none = parameters_node({});
    return notes_on_picture(parse_method(method, is_indirect ? none : given),
                            is_indirect ? parse_indirect(indirect, given) : std::nullopt, options);
}

TEST(NotesOnPicture, TellThatOnlyProbeGathersOverDiscs) {
    for (const auto& [indirect, layer] :
         {std::pair("", ""), std::pair("lighttrace", " of the indirect layer")}) {
        const auto all = notes_of_picture("lighttrace", indirect, "radius=0.25", 1);
        ASSERT_EQ(all.size(), 1U);
        EXPECT_EQ(all[0], std::string("radius=0.25") + layer +
                              " makes no difference in a picture: lighttrace gathers over discs in "
                              "probe alone");
        EXPECT_TRUE(notes_of_picture("lighttrace", indirect, "paths=9", 4).empty());
    }
    // Of points it is no news.
    EXPECT_TRUE(notes_of(ring(), "lighttrace", {"radius=0.25", "paths=9"}).empty());
}

TEST(NotesOnPicture, TellHowManyPathsSamplesShare) {
    for (const auto& [method, indirect] :
         {std::pair("pathtrace", ""), std::pair("none", "pathtrace")}) {
        const auto all = notes_of_picture(method, indirect, "spp=13", 4);
        ASSERT_EQ(all.size(), 1U);
        EXPECT_EQ(all[0], std::string("13 paths a pixel") +
                              (*indirect != 0 ? " of the indirect layer" : "") +
                              " are shared by 4 samples: 16 are traced");
        EXPECT_EQ(notes_of_picture(method, indirect, "spp=2", 4).size(), 1U);
        for (const char* even : {"spp=16", "spp=4"})
            EXPECT_TRUE(notes_of_picture(method, indirect, even, 4).empty()) << even;
        EXPECT_TRUE(notes_of_picture(method, indirect, "spp=13", 1).empty());
    }
}

}  // namespace
}  // namespace caustics::experiments
