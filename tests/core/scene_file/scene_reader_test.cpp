#include "core/scene/scene_reader.h"

#include <gtest/gtest.h>

#include <numbers>

#include <algorithm>
#include <fstream>

#include "core/base/error.h"
#include "core/render/film.h"
#include "tests/support/temporary_folder.h"

namespace caustics {
namespace {

namespace fs = std::filesystem;

fs::path write(const std::string& name, const std::string& text) {
    static const support::TemporaryFolder folder("scene_io_test");
    const fs::path file = folder.path() / name;
    fs::create_directories(file.parent_path());
    std::ofstream(file) << text;
    return file;
}

/// A scene of a sensor, a floor and what else is given (", \"key\": ...").
std::string scene_with(const std::string& more) {
    return R"({"sensor": {"type": "perspective"}, "floor": {"type": "rectangle"})" + more + "}";
}

SceneDesc load(const std::string& text) { return load_scene(write("scene.json", text)).desc; }

const Shape& shape(const SceneDesc& desc, const char* name) {
    return *std::ranges::find(desc.shapes, name, &Shape::name);
}

Shape load_shape(const std::string& text) {
    const SceneDesc desc = load(scene_with(", \"it\": " + text));
    return shape(desc, "it");
}

template <class Model>
Model load_bsdf(const std::string& text) {
    return std::get<Model>(load_shape(R"({"type": "disk", "b": )" + text + "}").bsdf.model);
}

Transform load_to_world(const std::string& text) {
    return load_shape(R"({"type": "disk", "to_world": )" + text + "}").to_world;
}

bool equal(const Spectrum& a, const Spectrum& b) { return (a == b).all(); }

Spectrum constant(const Texture& texture) { return std::get<Spectrum>(texture); }

void expect_near(const Vec3d& a, const Vec3d& b) {
    EXPECT_LT((a - b).norm(), 1e-12) << a.transpose() << " / " << b.transpose();
}

TEST(Scene, DefaultsAreMitsubas) {
    const SceneDesc desc = load(scene_with(""));
    EXPECT_EQ(desc.camera.width, 768);
    EXPECT_EQ(desc.camera.height, 576);
    EXPECT_EQ(desc.camera.fov_axis, Camera::FovAxis::x);
    EXPECT_EQ(desc.sampling.sample_count, 4);
    EXPECT_FALSE(desc.sampling.stratified);
    EXPECT_TRUE(desc.sampling.jitter);
    const Shape& floor = shape(desc, "floor");
    EXPECT_EQ(floor.primitive, Primitive::rectangle);
    EXPECT_TRUE(
        equal(constant(std::get<Diffuse>(floor.bsdf.model).reflectance), Spectrum::Constant(0.5F)));
    EXPECT_FALSE(floor.bsdf.twosided);
    EXPECT_FALSE(floor.flip_normals);
    EXPECT_FALSE(floor.radiance.has_value());
}

TEST(Scene, SensorFilmAndSamplerUnderAnyKey) {
    const SceneDesc desc = load(R"({"version": 1, "type": "scene", "floor": {"type": "disk"},
        "eye": {"type": "perspective", "fov": 30, "fov_axis": "smaller",
                "to_world": [{"scale": 2}, {"translate": [1, 2, 3]}],
                "plate": {"type": "hdrfilm", "width": 32, "height": 16, "f": {"type": "box"}},
                "dots": {"type": "stratified", "sample_count": 9, "jitter": false}}})");
    EXPECT_EQ(desc.camera.fov_degrees, 30);
    EXPECT_EQ(desc.camera.fov_axis, Camera::FovAxis::smaller);
    EXPECT_EQ(desc.camera.width, 32);
    EXPECT_EQ(desc.camera.height, 16);
    EXPECT_TRUE(desc.camera.to_world.linear().isIdentity(1e-15)) << "a scale changes no view";
    expect_near(desc.camera.to_world.translation(), {1, 2, 3});
    EXPECT_TRUE(desc.sampling.stratified);
    EXPECT_FALSE(desc.sampling.jitter);
    EXPECT_EQ(desc.sampling.sample_count, 9);
}

TEST(Scene, AdaptiveSampler) {
    const auto sampler = [](const std::string& keys) {
        return load(R"({"version": 1, "type": "scene", "floor": {"type": "disk"},
            "eye": {"type": "perspective", "s": {"type": "adaptive")" +
                    keys + "}}}")
            .sampling;
    };
    EXPECT_EQ(sampler("").sample_count, 4);
    EXPECT_EQ(sampler("").max_sample_count, 128);
    EXPECT_EQ(sampler("").max_error, 0.05F);
    const PixelSampling given =
        sampler(R"(, "sample_count": 2, "max_sample_count": 64, "max_error": 0.1)");
    EXPECT_EQ(given.sample_count, 2);
    EXPECT_EQ(given.max_sample_count, 64);
    EXPECT_EQ(given.max_error, 0.1F);
    for (const char* keys : {R"(, "sample_count": 1)", R"(, "max_sample_count": 3)",
                             R"(, "max_error": 0)", R"(, "jitter": true)"})
        EXPECT_THROW(sampler(keys), InputError) << keys;
}

TEST(Scene, Lights) {
    const SceneDesc desc = load(scene_with(R"(,
        "a": {"type": "point", "position": [1, 2, 3], "intensity": 5},
        "b": {"type": "point", "to_world": [{"translate": [4, 5, 6]}], "intensity": [1, 2, 3]},
        "c": {"type": "directional", "direction": [0, 0, -2],
              "irradiance": {"type": "rgb", "value": [3, 2, 1]}},
        "d": {"type": "directional", "to_world": [{"rotate": {"axis": [1, 0, 0], "angle": 90}}]},
        "s": {"type": "spot", "to_world": [{"look_at":
              {"origin": [1, 1, 2], "target": [1, 1, 0], "up": [0, 1, 0]}}], "cutoff_angle": 40},
        "lamp": {"type": "disk", "e": {"type": "area", "radiance": 7}})"));
    ASSERT_EQ(desc.lights.size(), 5U);
    const auto [near, placed] =
        std::pair(std::get<PointLight>(desc.lights[0]), std::get<PointLight>(desc.lights[1]));
    EXPECT_EQ(near.position, Vec3(1, 2, 3));
    EXPECT_TRUE(equal(near.intensity, Spectrum::Constant(5)));
    EXPECT_EQ(placed.position, Vec3(4, 5, 6));
    EXPECT_TRUE(equal(placed.intensity, {1, 2, 3}));
    const auto [given, turned] = std::pair(std::get<DirectionalLight>(desc.lights[2]),
                                           std::get<DirectionalLight>(desc.lights[3]));
    EXPECT_EQ(given.direction, Vec3(0, 0, -1));
    EXPECT_TRUE(equal(given.irradiance, {3, 2, 1}));
    expect_near(turned.direction.cast<double>(), {0, -1, 0});
    const auto& spot = std::get<SpotLight>(desc.lights[4]);
    EXPECT_EQ(spot.position, Vec3(1, 1, 2));
    expect_near(spot.cone.axis.cast<double>(), {0, 0, -1});
    EXPECT_FLOAT_EQ(spot.cone.cutoff, 40 * std::numbers::pi_v<float> / 180);
    EXPECT_FLOAT_EQ(spot.cone.beam_width, 30 * std::numbers::pi_v<float> / 180);
    EXPECT_TRUE(equal(*shape(desc, "lamp").radiance, Spectrum::Constant(7)));
}

TEST(Scene, CoordinatesAreRelativeToCastersFarAway) {
    const std::string glass = R"("bsdf": {"type": "dielectric"}})";
    const auto scene = [&](const std::string& casters) {
        return load(R"({"sensor": {"type": "perspective", "to_world": [{"translate": [1e5, 0, 3]}]},
            "lamp": {"type": "point", "position": [1e5, 0.25, 1]},
            "floor": {"type": "rectangle", "to_world": [{"translate": [1e5, 0, -1]}]},
            "cube": {"type": "cube", "to_world": [{"scale": 0.5}, {"translate": [1e5, 1, 0]}]},)" +
                    casters + "}");
    };
    const SceneDesc far =
        scene(R"("ball": {"type": "sphere", "center": [1e5, 0, 0], "radius": 0.1,)" + glass);
    EXPECT_EQ(far.origin, Vec3d(1e5, 0, 0));
    expect_near(shape(far, "ball").to_world * Vec3d(0, 0, 1), {0, 0, 0.1});
    expect_near(shape(far, "floor").to_world.translation(), {0, 0, -1});
    EXPECT_EQ(bounds(shape(far, "cube")).min(), Vec3(-0.5F, 0.5F, -0.5F));
    EXPECT_EQ(std::get<PointLight>(far.lights[0]).position, Vec3(0, 0.25F, 1));
    expect_near(far.camera.to_world.translation(), {0, 0, 3});
    // What is near the world's origin stays where it is, and the smaller of two casters counts more.
    EXPECT_EQ(
        scene(R"("ball": {"type": "sphere", "center": [1, 0, 0], "radius": 0.1,)" + glass).origin,
        Vec3d::Zero());
    const SceneDesc two = scene(R"("a": {"type": "sphere", "center": [1e4, 0, 0], "radius": 0.1,)" +
                                glass + R"(, "b": {"type": "sphere", "radius": 10,)" + glass);
    EXPECT_NEAR(two.origin.x(), 1e4, 2);
}

TEST(Scene, SphereAndCylinderFoldTheirPlacement) {
    const Shape sphere = load_shape(
        R"({"type": "sphere", "center": [1, 2, 3], "radius": 2, "to_world": [{"scale": 10}]})");
    expect_near(sphere.to_world * Vec3d(1, 0, 0), {30, 20, 30});
    const Shape cylinder =
        load_shape(R"({"type": "cylinder", "p0": [1, 0, 0], "p1": [1, 0, -3], "radius": 0.5})");
    expect_near(cylinder.to_world * Vec3d(0, 0, 0), {1, 0, 0});
    expect_near(cylinder.to_world * Vec3d(0, 0, 1), {1, 0, -3});
    // Mitsuba's frame along -z: s = (1, 0, 0), t = (0, -1, 0).
    expect_near(cylinder.to_world * Vec3d(1, 0, 0), {1.5, 0, 0});
    expect_near(cylinder.to_world * Vec3d(0, 1, 0), {1, -0.5, 0});
    EXPECT_GT(cylinder.to_world.linear().determinant(), 0);
}

TEST(Scene, ResolutionMakesAMeshInTheWorldFrame) {
    const Shape mesh = load_shape(R"({"type": "rectangle", "resolution": 3, "flip_normals": true,
                                      "to_world": [{"translate": [0, 0, 5]}]})");
    EXPECT_EQ(mesh.primitive, Primitive::mesh);
    EXPECT_EQ(mesh.mesh.triangles.size(), 18U);
    for (const Vec3& p : mesh.mesh.positions) EXPECT_EQ(p.z(), 5);
    for (const Vec3& n : mesh.mesh.normals) EXPECT_EQ(n, Vec3(0, 0, -1));
    EXPECT_EQ(load_shape(R"({"type": "cube"})").mesh.triangles.size(), 12U);
    EXPECT_EQ(load_shape(R"({"type": "cube", "resolution": 2})").mesh.triangles.size(), 48U);
    const Shape faceted =
        load_shape(R"({"type": "sphere", "resolution": 4, "face_normals": true})");
    EXPECT_TRUE(faceted.mesh.normals.empty());
    const Shape sheared =
        load_shape(R"({"type": "sphere", "resolution": 4, "to_world": [{"scale": [1, 1, 3]}]})");
    EXPECT_EQ(bounds(sheared).max().z(), 3);
}

TEST(Scene, HeightfieldOfSines) {
    const Shape water = load_shape(R"({"type": "heightfield", "half_size": [2, 3],
        "waves": [{"amplitude": 0.1, "wave_vector": [4, 5], "phase": 6},
                  {"amplitude": 0.2, "wave_vector": [7, 8]}]})");
    ASSERT_EQ(water.field.waves.size(), 2U);
    EXPECT_EQ(water.field.half_size, Vec2d(2, 3));
    EXPECT_EQ(water.field.waves[0].amplitude, 0.1);
    EXPECT_EQ(water.field.waves[0].wave_vector, Vec2d(4, 5));
    EXPECT_EQ(water.field.waves[0].phase, 6);
    EXPECT_EQ(water.field.waves[1].phase, 0);
}

TEST(Scene, MeshFilesBesideTheSceneAreTransformedAndHashed) {
    const std::string text = scene_with(R"(, "it": {"type": "obj", "filename": "tri.obj",
                                           "to_world": [{"translate": [0, 0, 2]}]})");
    write("tri.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const SceneFile first = load_scene(write("scene.json", text));
    const Shape& mesh = shape(first.desc, "it");
    ASSERT_EQ(mesh.mesh.triangles.size(), 1U);
    for (const Vec3& p : mesh.mesh.positions) EXPECT_EQ(p.z(), 2);
    ASSERT_EQ(first.assets.size(), 1U);
    EXPECT_EQ(first.assets[0].first, "tri.obj");
    write("tri.obj", "v 0 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\n");
    const SceneFile second = load_scene(write("scene.json", text));
    EXPECT_NE(first.hash, second.hash);
    EXPECT_EQ(first.canonical, second.canonical);
}

TEST(Scene, LawsOfDispersion) {
    const auto ior = [](const std::string& law) {
        return load_bsdf<Dielectric>(R"({"type": "dielectric", "int_ior": )" + law + "}").int_ior;
    };
    EXPECT_NEAR(ior(R"({"type": "cauchy", "A": 1.5, "B": 0.004})").at(500), 1.516, 1e-12);
    EXPECT_NEAR(ior(R"({"type": "sellmeier", "material": "BK7"})").at(587.5618F), 1.51680, 1e-5);
    EXPECT_NEAR(ior(R"({"type": "sellmeier", "B": [1.25], "C": [0.01]})").at(500),
                std::sqrt(1 + 1.25 * 0.25 / 0.24), 1e-9);
    EXPECT_NEAR(ior(R"({"type": "abbe", "n_d": 1.7, "V_d": 30})").at(400), 1.741, 1e-3);
    EXPECT_FALSE(ior("1.5").is_dispersive());
    EXPECT_FALSE(ior(R"("water")").is_dispersive());
}

// Mitsuba's order: the weight is that of the second of the two by the names of their keys.
TEST(Scene, BlendsOfAReceiverAndAMirror) {
    const auto blend = [](const std::string& weight, const std::string& a, const std::string& b) {
        return load_shape(R"({"type": "disk", "s": {"type": "blendbsdf", "weight": )" + weight +
                          R"(, "a": )" + a + R"(, "b": )" + b + "}}")
            .bsdf;
    };
    const std::string paint = R"({"type": "diffuse", "reflectance": 0.3})";
    const std::string mirror = R"({"type": "conductor", "specular_reflectance": 0.7})";
    const Bsdf paint_first = blend("0.2", paint, mirror);
    ASSERT_TRUE(paint_first.mirror);
    EXPECT_FLOAT_EQ(paint_first.mirror->weight, 0.2F);
    EXPECT_FLOAT_EQ(paint_first.mirror->reflectance[1], 0.7F);
    EXPECT_TRUE(std::holds_alternative<Diffuse>(paint_first.model));
    EXPECT_TRUE(is_caster(paint_first) && is_receiver(paint_first));
    EXPECT_FLOAT_EQ(blend("0.2", mirror, paint).mirror->weight, 0.8F);
    EXPECT_FALSE(is_caster(blend("0", paint, mirror)));
    EXPECT_FALSE(is_receiver(blend("1", paint, mirror)));
    EXPECT_FALSE(blend("1", paint, mirror).mirror);
}

TEST(Scene, BsdfDefaultsAndValues) {
    const auto glass = load_bsdf<Dielectric>(R"({"type": "dielectric"})");
    EXPECT_EQ(glass.int_ior, 1.5046F);
    EXPECT_EQ(glass.ext_ior, 1.000277F);
    EXPECT_TRUE(is_black(glass.absorption) && is_black(glass.ext_absorption));
    EXPECT_TRUE(equal(glass.specular_transmittance, Spectrum::Ones()));
    const auto gem = load_bsdf<Dielectric>(R"({"type": "dielectric", "int_ior": "diamond",
        "ext_ior": 1.333, "absorption": [1, 2, 3], "ext_absorption": 4})");
    EXPECT_EQ(gem.int_ior, 2.419F);
    EXPECT_EQ(gem.ext_ior, 1.333F);
    EXPECT_TRUE(equal(gem.absorption, {1, 2, 3}));
    EXPECT_TRUE(equal(gem.ext_absorption, Spectrum::Constant(4)));
    const auto mirror = load_bsdf<Conductor>(
        R"({"type": "conductor", "material": "none", "specular_reflectance": 0.9})");
    EXPECT_TRUE(equal(mirror.specular_reflectance, Spectrum::Constant(0.9F)));
    const auto schlick = load_bsdf<Schlick>(R"({"type": "schlick", "alpha": 0.1})");
    EXPECT_EQ(schlick.alpha, 0.1F);
    EXPECT_TRUE(equal(constant(schlick.reflectance), Spectrum::Constant(0.5F)));
    const auto phong = load_bsdf<Phong>(
        R"({"type": "phong", "exponent": 12, "diffuse_reflectance": 0.6, "model": "classic"})");
    EXPECT_EQ(phong.exponent, 12);
    EXPECT_EQ(phong.model, Phong::Model::classic);
    EXPECT_TRUE(equal(constant(phong.diffuse_reflectance), Spectrum::Constant(0.6F)));
    EXPECT_TRUE(equal(constant(phong.specular_reflectance), Spectrum::Constant(0.2F)));
    EXPECT_FLOAT_EQ(phong.lobe_share, 0.25F);
    const auto coloured = load_bsdf<Phong>(
        R"({"type": "phong", "diffuse_reflectance": [0.1, 0.6, 0.3],
            "specular_reflectance": [0.2, 0.1, 0.1]})");
    EXPECT_FLOAT_EQ(coloured.lobe_share, 0.25F) << "by the brightest channels";
    const Shape both = load_shape(R"({"type": "disk", "b": {"type": "twosided",
        "inner": {"type": "diffuse", "reflectance": [0.1, 0.2, 0.3]}}})");
    EXPECT_TRUE(both.bsdf.twosided);
    EXPECT_TRUE(
        equal(constant(std::get<Diffuse>(both.bsdf.model).reflectance), {0.1F, 0.2F, 0.3F}));
}

TEST(Scene, Textures) {
    const auto board = std::get<Checkerboard>(load_bsdf<Diffuse>(R"({"type": "diffuse",
        "reflectance": {"type": "checkerboard", "color0": 0.8,
                        "to_uv": [{"scale": [4, 2, 1]}]}})")
                                                  .reflectance);
    EXPECT_TRUE(equal(board.color0, Spectrum::Constant(0.8F)));
    EXPECT_TRUE(equal(board.color1, Spectrum::Constant(0.2F)));
    EXPECT_TRUE((board.to_uv * Vec3(1, 1, 0)).isApprox(Vec3(4, 2, 0)));
    write_png(2, 1, {255, 255, 255, 0, 0, 0}, write("two.png", ""));
    const auto bitmap = std::get<Bitmap>(load_bsdf<Schlick>(R"({"type": "schlick",
        "reflectance": {"type": "bitmap", "filename": "two.png", "filter_type": "nearest",
                        "wrap_mode": "clamp", "raw": true}})")
                                             .reflectance);
    EXPECT_EQ(bitmap.width, 2);
    EXPECT_EQ(bitmap.filter, Bitmap::Filter::nearest);
    EXPECT_EQ(bitmap.wrap, Bitmap::Wrap::clamp);
    EXPECT_TRUE(equal(bitmap.texels[0], Spectrum::Ones()));
}

TEST(ToWorld, MatricesAndOperationsInTheirOrder) {
    const Transform rows =
        load_to_world("[[0, -1, 0, 5], [1, 0, 0, 6], [0, 0, 1, 7], [0, 0, 0, 1]]");
    expect_near(rows * Vec3d(1, 0, 0), {5, 7, 7});
    const Transform flat = load_to_world("[0, -1, 0, 5, 1, 0, 0, 6, 0, 0, 1, 7, 0, 0, 0, 1]");
    EXPECT_EQ(rows.matrix(), flat.matrix());
    const Transform moved_then_turned = load_to_world(
        R"([{"translate": [1, 0, 0]}, {"rotate": {"axis": [0, 0, 2], "angle": 90}}])");
    expect_near(moved_then_turned * Vec3d(0, 0, 0), {0, 1, 0});
    const Transform turned_then_moved = load_to_world(
        R"([{"rotate": {"axis": [0, 0, 1], "angle": 90}}, {"translate": [1, 0, 0]}])");
    expect_near(turned_then_moved * Vec3d(0, 0, 0), {1, 0, 0});
    expect_near(load_to_world(R"([{"scale": [1, 2, 3]}])") * Vec3d(1, 1, 1), {1, 2, 3});
    EXPECT_TRUE(load_to_world("[]").isApprox(Transform::Identity()));
}

TEST(ToWorld, LookAtHasZTowardsTheTargetAndXToTheLeft) {
    // Standing at (0, -5, 0), looking along +y with z up: left is -x.
    const Transform view = load_to_world(
        R"([{"look_at": {"origin": [0, -5, 0], "target": [0, 1, 0], "up": [0, 0, 1]}}])");
    expect_near(view.linear().col(2), {0, 1, 0});
    expect_near(view.linear().col(1), {0, 0, 1});
    expect_near(view.linear().col(0), {-1, 0, 0});
    expect_near(view.translation(), {0, -5, 0});
}

TEST(SceneHash, FollowsTheContentAndNotTheLayout) {
    const auto hash = [](const std::string& text, const Overrides& overrides = {}) {
        return load_scene(write("scene.json", text), overrides).hash;
    };
    const std::string plain = hash(scene_with(R"(, "x": {"type": "disk", "resolution": 2})"));
    EXPECT_EQ(plain.size(), 16U);
    EXPECT_EQ(plain, hash(scene_with("\n ,\"x\":{\"resolution\": 2.0, \"type\": \"disk\"}")));
    EXPECT_NE(plain, hash(scene_with(R"(, "x": {"type": "disk", "resolution": 3})")));
    EXPECT_EQ(plain, hash(scene_with(R"(, "x": {"type": "disk", "resolution": 3})"),
                          {{"/x/resolution", "2"}}));
    EXPECT_EQ(plain, hash(scene_with(R"(, "x": {"type": "disk", "resolution": 3})"),
                          {{"/x/resolution", "2."}}))
        << "a number without digits after its point";
}

TEST(Scene, IncludedPartsResolveTheirFilesBesideThemselves) {
    write("parts/tri.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write("parts/tri.json", R"({"type": "obj", "filename": "tri.obj"})");
    EXPECT_EQ(load_shape(R"({"$include": "parts/tri.json"})").mesh.triangles.size(), 1U);
}

}  // namespace
}  // namespace caustics
