#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <regex>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/geometry/tessellate.h"
#include "core/mesh/mesh_io.h"
#include "experiments/export/exported_scene.h"
#include "experiments/export/mesh_bytes.h"
#include "experiments/export/xml_writer.h"
#include "tests/support/bitmap_file.h"
#include "tests/support/build_scene.h"
#include "tests/support/temporary_folder.h"

namespace caustics::experiments {
namespace {

using support::load_bitmap;

/// A glass ball and a mirror over a floor, under a lamp and the sun, seen askew.
SceneDesc small_scene() {
    SceneDesc desc;
    desc.shapes = {
        support::horizontal("floor", -0.1, 2, true, support::diffuse(0.3F)),
        support::sphere("ball", {0.1, 0.2, 0.7}, 0.3, support::glass(1.5F)),
        support::rectangle("mirror", {0, 1, 1}, {0.3, 0, 0}, {0, 0.1, 0.4}, support::mirror(0.9F))};
    desc.lights = {support::point_light({0.3, -0.4, 2.5}, 7)};
    desc.lights.emplace_back(support::directional_light({0.1, 0.2, -1}, 3));
    desc.camera = support::camera({0.3, -1.7, 1.3}, {0.1, 0.2, 0.1}, {0.1, 0, 1}, 43, 12, 9);
    return desc;
}

/// All numbers that follow `key` until the first character that belongs to none.
std::vector<double> numbers_after(const std::string& text, const std::string& key) {
    const std::size_t at = text.find(key);
    EXPECT_NE(at, std::string::npos) << key;
    if (at == std::string::npos) return {};
    const std::string rest = text.substr(at + key.size());
    std::vector<double> numbers;
    for (std::size_t i = 0; i < rest.size();) {
        if (std::string(" ,<\n").find(rest[i]) != std::string::npos) {
            ++i;
            continue;
        }
        char* end = nullptr;
        const double value = std::strtod(rest.c_str() + i, &end);
        if (end == rest.c_str() + i) break;
        numbers.push_back(value);
        i = static_cast<std::size_t>(end - rest.c_str());
    }
    return numbers;
}

Vec3d vector_after(const std::string& text, const std::string& key) {
    const std::vector<double> numbers = numbers_after(text, key);
    EXPECT_GE(numbers.size(), 3U) << key;
    return numbers.size() < 3 ? Vec3d::Zero().eval() : Vec3d(numbers[0], numbers[1], numbers[2]);
}

/// The text of the element that begins with `start`.
std::string element(const std::string& xml, const std::string& start) {
    const std::size_t at = xml.find(start);
    EXPECT_NE(at, std::string::npos) << start;
    return at == std::string::npos ? "" : xml.substr(at);
}

void expect_matrix(const std::string& xml, const Transform& expected) {
    const std::vector<double> m = numbers_after(xml, "<matrix value=\"");
    ASSERT_EQ(m.size(), 16U);
    for (Eigen::Index row = 0; row < 4; ++row)
        for (Eigen::Index column = 0; column < 4; ++column)
            EXPECT_EQ(m[static_cast<std::size_t>(4 * row + column)],
                      expected.matrix()(row, column));
}

const std::string& file(const ExportedScene& scene, const std::string& name) {
    for (const ExportedScene::File& each : scene.files)
        if (each.name == name) return each.bytes;
    throw std::runtime_error("no file " + name);
}

TEST(MitsubaScene, SaysEveryNumberOfTheSceneExactly) {
    SceneDesc desc = small_scene();
    const std::string xml = file(to_mitsuba(desc, {}), "scene.xml");
    const std::string sensor = element(xml, "<sensor");
    expect_matrix(sensor, desc.camera.to_world);
    EXPECT_NEAR(numbers_after(sensor, "name=\"fov\" value=\"").at(0), 43, 1e-12);
    EXPECT_EQ(numbers_after(sensor, "name=\"width\" value=\"").at(0), 12);
    for (std::size_t i = 0; i < desc.shapes.size(); ++i)
        expect_matrix(element(xml, "id=\"" + plain_name(desc.shapes[i].name, i)),
                      desc.shapes[i].to_world);
    EXPECT_EQ(vector_after(xml, "name=\"position\" value=\"").cast<float>(),
              std::get<PointLight>(desc.lights[0]).position);
    EXPECT_EQ(vector_after(xml, "name=\"intensity\" value=\"").cast<float>(),
              std::get<PointLight>(desc.lights[0]).intensity.matrix());
    EXPECT_EQ(vector_after(xml, "name=\"direction\" value=\"").cast<float>(),
              std::get<DirectionalLight>(desc.lights[1]).direction);
    EXPECT_EQ(vector_after(xml, "name=\"irradiance\" value=\"").cast<float>(),
              std::get<DirectionalLight>(desc.lights[1]).irradiance.matrix());
    EXPECT_EQ(numbers_after(xml, "name=\"int_ior\" value=\"").at(0), 1.5);
}

TEST(MitsubaScene, IsOneForEachWavelengthWhereGlassDisperses) {
    SceneDesc desc = small_scene();
    const Ior law = Ior::cauchy(1.5, 0.01);
    std::get<Dielectric>(desc.shapes[1].bsdf.model).int_ior = law;
    desc.shapes.push_back(
        support::mesh("box", tessellate_cube(1), Transform::Identity(), support::diffuse(0.5F)));
    constexpr int wavelengths = 5;
    const ExportedScene scenes = to_mitsuba_by_wavelength(desc, {}, wavelengths);
    Vec3d intensity = Vec3d::Zero();
    Vec3d irradiance = Vec3d::Zero();
    std::size_t scene_count = 0;
    std::size_t mesh_count = 0;
    for (const ExportedScene::File& each : scenes.files) {
        mesh_count += each.name.ends_with(".ply") ? 1 : 0;
        if (!each.name.ends_with("nm.xml")) continue;
        ++scene_count;
        const float nm = std::strtof(each.name.c_str() + std::string("scene_").size(), nullptr);
        EXPECT_NEAR(numbers_after(each.bytes, "name=\"int_ior\" value=\"").at(0), law.at(nm), 1e-5);
        intensity += vector_after(each.bytes, "name=\"intensity\" value=\"");
        irradiance += vector_after(each.bytes, "name=\"irradiance\" value=\"");
    }
    EXPECT_EQ(scene_count, wavelengths);
    EXPECT_EQ(mesh_count, 1U) << "all scenes share it";
    EXPECT_TRUE(intensity.isApprox(Vec3d::Constant(7), 1e-6)) << intensity;
    EXPECT_TRUE(irradiance.isApprox(Vec3d::Constant(3), 1e-6)) << irradiance;
    EXPECT_THROW(to_mitsuba_by_wavelength(small_scene(), {}, wavelengths), UnsupportedScene);
}

TEST(MitsubaScene, BringsTheFilesItNames) {
    SceneDesc desc = small_scene();
    Shape water = support::horizontal("wa/ter", 0.5, 1, true, support::glass(1.333F));
    water.primitive = Primitive::heightfield;
    water.field.waves = {{0.02, {4, 1}, 0.3}};
    desc.shapes.push_back(water);
    Bitmap bitmap;
    bitmap.width = 1;
    bitmap.height = 1;
    bitmap.texels = {Spectrum(0.1F, 0.2F, 0.3F)};
    desc.shapes[0].bsdf.model = Diffuse{bitmap};
    const ExportedScene exported = to_mitsuba(desc, {.mesh_resolution = 3});
    ASSERT_EQ(exported.files.size(), 3U);
    EXPECT_EQ(exported.files[0].name, "scene.xml");
    for (const char* name : {"shape0-floor.pfm", "shape3-wa-ter.ply"}) {
        EXPECT_FALSE(file(exported, name).empty());
        EXPECT_NE(exported.files[0].bytes.find("value=\"" + std::string(name) + "\""),
                  std::string::npos);
    }
    ASSERT_EQ(exported.notes.size(), 2U);  // baked; bent by vertex normals
    EXPECT_NE(exported.notes[0].find("resolution 3"), std::string::npos);
}

TEST(MitsubaScene, TakesPathsWhereNoLightIsAPoint) {
    SceneDesc desc = small_scene();
    const std::string chosen = "name=\"integrator\" value=\"";
    EXPECT_NE(to_mitsuba(desc, {}).files[0].bytes.find(chosen + "ptracer"), std::string::npos);
    desc.shapes[0].radiance = Spectrum(Spectrum::Ones());
    desc.lights.clear();
    desc.lights.clear();
    EXPECT_NE(to_mitsuba(desc, {}).files[0].bytes.find(chosen + "path"), std::string::npos);
}

TEST(MitsubaScene, TakesPathsAsLongAsTheyCanBe) {
    SceneDesc desc = small_scene();
    const auto depth = [&] {
        return numbers_after(to_mitsuba(desc, {}).files[0].bytes, "name=\"max_depth\" value=\"")[0];
    };
    EXPECT_EQ(depth(), 1000 + 2);
    desc.shapes.resize(1);
    EXPECT_EQ(depth(), 2) << "light between receivers is no part of the picture";
}

TEST(MitsubaScene, StartsRouletteWhereLongPathsDo) {
    const SceneDesc desc = small_scene();
    const auto roulette_of = [&](int max_bounces) {
        const std::string text = to_mitsuba(desc, {.max_bounces = max_bounces}).files[0].bytes;
        const std::size_t at = text.find("name=\"rr_depth\" value=\"") + 23;
        return text.substr(at, text.find('"', at) - at);
    };
    EXPECT_EQ(roulette_of(1000), "18");
    EXPECT_EQ(roulette_of(16), "$max_depth");
}

TEST(PovrayScene, FollowsAsLongChainsAsPovrayCan) {
    const auto text_of = [&](int max_bounces) {
        return file(to_povray(small_scene(), {.max_bounces = max_bounces}), "scene.pov");
    };
    EXPECT_NE(text_of(1000).find("max_trace_level 64\n  adc_bailout 0.0001\n"), std::string::npos);
    EXPECT_NE(text_of(16).find("max_trace_level 18\n  adc_bailout 0\n"), std::string::npos);
}

TEST(MitsubaScene, NeverAsksForStrataWithoutJitter) {
    SceneDesc desc = small_scene();
    desc.sampling.stratified = true;
    for (const bool jitter : {true, false}) {
        desc.sampling.jitter = jitter;
        const ExportedScene exported = to_mitsuba(desc, {});
        EXPECT_EQ(exported.files[0].bytes.find("\"jitter\""), std::string::npos)
            << "its strata's middles would be the numbers of the light paths too";
        const auto names_it = [](const std::string& note) {
            return note.find("jitter") != std::string::npos;
        };
        EXPECT_EQ(std::ranges::any_of(exported.notes, names_it), !jitter);
    }
}

TEST(MitsubaScene, SaysThatMitsubaDimsTheMirrorOfABlend) {
    SceneDesc desc = small_scene();
    const auto names_it = [](const std::string& note) {
        return note.find("/floor: a mirror") == 0;
    };
    for (const bool blended : {false, true}) {
        if (blended) desc.shapes[0].bsdf.mirror = MirrorPart{0.25F, Spectrum::Ones()};
        EXPECT_EQ(std::ranges::count_if(to_mitsuba(desc, {}).notes, names_it), blended);
    }
}

TEST(MitsubaScene, TakesAllPathsForLightBetweenReceivers) {
    const std::string text = to_mitsuba(small_scene(), {.indirect = true}).files[0].bytes;
    EXPECT_EQ(numbers_after(text, "name=\"max_depth\" value=\"")[0], -1);
    EXPECT_EQ(numbers_after(text, "name=\"rr_depth\" value=\"")[0], 16 + 2);
}

TEST(PovrayScene, TakesRadiosityForLightBetweenReceivers) {
    const auto exported = [](bool indirect) {
        return file(to_povray(small_scene(), {.indirect = indirect}), "scene.pov");
    };
    EXPECT_EQ(exported(false).find("radiosity"), std::string::npos);
    const std::string text = exported(true);
    const std::size_t settings = text.find("global_settings");
    EXPECT_LT(settings, text.find("radiosity {"));
    EXPECT_LT(text.find("radiosity {"), text.find("camera {"));
}

TEST(MeshBytes, AreReadBackAsTheyWere) {
    const support::TemporaryFolder folder;
    TriangleMesh mesh = tessellate_sphere(4);
    for (const bool smooth : {true, false}) {
        if (!smooth) mesh.normals.clear();
        const auto ply = folder / "mesh.ply";
        write_atomic_file(ply, ply_bytes(mesh));
        const TriangleMesh read = load_mesh(ply, {.face_normals = !smooth});
        EXPECT_EQ(read.positions, mesh.positions);
        EXPECT_EQ(read.uvs, mesh.uvs);
        EXPECT_EQ(read.triangles, mesh.triangles);
        ASSERT_EQ(read.normals.size(), mesh.normals.size());
        for (std::size_t i = 0; i < mesh.normals.size(); ++i)
            EXPECT_LT((read.normals[i] - mesh.normals[i]).norm(), 1e-6F);
    }
}

TEST(MeshBytes, OfAPictureStandRightSideUp) {
    const support::TemporaryFolder folder;
    Bitmap bitmap;
    bitmap.width = 2;
    bitmap.height = 3;
    for (int i = 0; i < 6; ++i)
        bitmap.texels.emplace_back(Spectrum(0.125F * static_cast<float>(i), 0.5F, 0.25F));
    const auto pfm = folder / "a.pfm";
    write_atomic_file(pfm, pfm_bytes(bitmap));
    const Bitmap read = load_bitmap(pfm, true);
    ASSERT_EQ(read.width, 2);
    ASSERT_EQ(read.height, 3);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_TRUE((read.texels[i] == bitmap.texels[i]).all());
}

TEST(XmlWriter, EscapesValues) {
    XmlWriter xml;
    xml.open("a");
    xml.leaf("b", {{"c", "<&\">"}});
    xml.close();
    EXPECT_NE(xml.text().find("<a>\n  <b c=\"&lt;&amp;&quot;&gt;\"/>\n</a>\n"), std::string::npos);
}

// A pixel's ray is direction + x right + y up, x and y in [-1/2, 1/2].
TEST(PovrayScene, HasTheCamerasRays) {
    const SceneDesc desc = small_scene();
    const std::string pov = file(to_povray(desc, {}), "scene.pov");
    EXPECT_EQ(vector_after(pov, "location ").cast<float>(), desc.camera.position());
    for (const Vec2d& at : {Vec2d(0, 0), Vec2d(12, 9), Vec2d(3.5, 7.5)}) {
        const Vec3d ray = vector_after(pov, "direction ") +
                          (at.x() / 12 - 0.5) * vector_after(pov, "right ") +
                          (0.5 - at.y() / 9) * vector_after(pov, "up ");
        EXPECT_LT((ray.normalized().cast<float>() - desc.camera.direction(at.x(), at.y())).norm(),
                  1e-6F);
    }
}

// POV-Ray's tolerances are lengths of its own: a gap of half a millimetre under glass is lost in metres.
TEST(PovrayScene, HasLengthsThatItCanTellApart) {
    SceneDesc desc = small_scene();  // 4 m wide
    const std::string pov = file(to_povray(desc, {}), "scene.pov");
    EXPECT_EQ(numbers_after(pov, "#declare Unit = ").at(0), 100);
    const auto count = [&pov](const std::string& words) {
        std::size_t found = 0;
        for (std::size_t at = pov.find(words); at != std::string::npos;
             at = pov.find(words, at + 1))
            ++found;
        return found;
    };
    EXPECT_EQ(count("\n  scale Unit\n"), desc.shapes.size());
    // The camera's place, two lights', a point's fading, the sun's target, the radius of photons.
    EXPECT_EQ(count(" * Unit"), 6U);
    EXPECT_TRUE(to_povray(desc, {}).notes.empty());
    desc.shapes[1] = support::sphere("bead", {0.1, 0.2, 0.7}, 1e-4, support::glass(1.5F));
    const std::vector<std::string> notes = to_povray(desc, {}).notes;
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_NE(notes[0].find("/bead: POV-Ray's tolerance"), std::string::npos) << notes[0];
}

// White paint is c 2 / (1 + (d / fade)^2) bright under the light, and in truth I / (pi d^2).
TEST(PovrayScene, MakesPixelsRadiances) {
    const SceneDesc desc = small_scene();
    const std::string pov = file(to_povray(desc, {}), "scene.pov");
    const std::vector<double> point = numbers_after(pov, "light_source {");
    ASSERT_EQ(point.size(), 3U);
    const std::string light = element(pov, "light_source {");
    const double fade = numbers_after(light, "fade_distance ").at(0);
    const double d = 0.2;
    const double bright = numbers_after(light, "rgb ").at(0) * 2 / (1 + std::pow(d / fade, 2));
    EXPECT_NEAR(bright / (7 / (pi_d * d * d)), 1, 1e-7);
    const std::string sun = pov.substr(pov.rfind("light_source {"));
    EXPECT_NE(sun.find("parallel"), std::string::npos);
    EXPECT_NEAR(numbers_after(sun, "rgb ").at(0), 3 / pi_d, 1e-6);
}

TEST(PovrayScene, PutsColoursIntoBrackets) {
    SceneDesc desc = small_scene();
    desc.shapes[0].bsdf = support::diffuse(0.5F);
    desc.shapes[1].bsdf = support::glass(1.5F, 1, Spectrum(0.5F, 0.2F, 0));
    const std::string pov = file(to_povray(desc, {}), "scene.pov");
    std::size_t colours = 0;
    for (std::size_t at = pov.find("rgb "); at != std::string::npos;
         at = pov.find("rgb ", at + 1)) {
        const std::size_t numbers = numbers_after(pov.substr(at), "rgb ").size();
        EXPECT_EQ(numbers, pov[at + 4] == '<' ? 3U : 1U) << pov.substr(at, 40);
        colours += numbers == 3 ? 1 : 0;
    }
    EXPECT_GE(colours, 4U) << "two lights, a wall, a glass";
}

TEST(PovrayScene, AbsorbsByBeersLaw) {
    SceneDesc desc = small_scene();
    const Spectrum absorption(0.5F, 0.2F, 0);
    desc.shapes[1].bsdf = support::glass(1.5F, 1, absorption);
    const std::string pov = file(to_povray(desc, {}), "scene.pov");
    const double fade = numbers_after(element(pov, "interior"), "fade_distance ").at(0);
    const Vec3d colour = vector_after(pov, "fade_color rgb ");
    EXPECT_LT(((1 - colour.array()) / fade - absorption.cast<double>()).abs().maxCoeff(), 1e-6);
}

TEST(PovrayScene, BendsByTheRatioOfBothMedia) {
    SceneDesc desc = small_scene();
    desc.shapes[1].bsdf = support::glass(1.8F, 1.2F);
    const std::string interior = element(file(to_povray(desc, {}), "scene.pov"), "interior");
    EXPECT_NEAR(numbers_after(interior, " ior ").at(0), 1.5, 1e-6);
}

TEST(PovrayScene, DispersesFromVioletToRed) {
    SceneDesc desc = small_scene();
    std::get<Dielectric>(desc.shapes[1].bsdf.model).int_ior = Ior::cauchy(1.5, 0.01);
    const std::string interior = element(file(to_povray(desc, {}), "scene.pov"), "interior");
    EXPECT_NEAR(numbers_after(interior, " ior ").at(0), 1.5 + 0.01 / (0.58756 * 0.58756), 1e-6);
    EXPECT_NEAR(numbers_after(interior, "dispersion ").at(0),
                (1.5 + 0.01 / (0.4 * 0.4)) / (1.5 + 0.01 / (0.7 * 0.7)), 1e-6);
}

/// A change that no renderer of that name can follow.
struct Refused {
    const char* name;
    ExportedScene (*to)(const SceneDesc&, const ExportSettings&);
    std::function<void(SceneDesc&)> change;
    std::vector<std::string> words;

    friend std::ostream& operator<<(std::ostream& out, const Refused& refused) {
        return out << refused.name;
    }
};

class Refuses : public testing::TestWithParam<Refused> {};

TEST_P(Refuses, NamingPlaceAndReason) {
    SceneDesc desc = small_scene();
    EXPECT_NO_THROW(GetParam().to(desc, {}));
    GetParam().change(desc);
    try {
        GetParam().to(desc, {.scene_file = "a.json"});
        FAIL() << "exported";
    } catch (const UnsupportedScene& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.rfind("a.json: /", 0), 0U) << message;
        for (const std::string& word : GetParam().words)
            EXPECT_NE(message.find(word), std::string::npos) << message;
    }
}

const auto schlick_floor = [](SceneDesc& d) { d.shapes[0].bsdf = support::schlick(0.5F, 0.1F); };
const auto shining = [](SceneDesc& d) { d.shapes[0].radiance = Spectrum(Spectrum::Ones()); };

INSTANTIATE_TEST_SUITE_P(
    Export, Refuses,
    testing::Values(
        Refused{"MitsubaPhong",
                to_mitsuba,
                [](SceneDesc& d) { d.shapes[0].bsdf = support::phong(0.5F, 0.2F, 30); },
                {"/floor", "no phong bsdf", "--set"}},
        Refused{"PovrayPhong",
                to_povray,
                [](SceneDesc& d) { d.shapes[0].bsdf = support::phong(0.5F, 0.2F, 30); },
                {"/floor", "classic"}},
        Refused{"MitsubaDispersion",
                to_mitsuba,
                [](SceneDesc& d) {
                    std::get<Dielectric>(d.shapes[1].bsdf.model).int_ior = Ior::cauchy(1.5, 0.01);
                },
                {"/ball", "no dispersion", "--wavelengths", "/bsdf/int_ior=1.52897"}},
        Refused{"MitsubaSchlick", to_mitsuba, schlick_floor, {"/floor", "schlick", "--set"}},
        Refused{"MitsubaAbsorption",
                to_mitsuba,
                [](SceneDesc& d) {
                    d.shapes[1].bsdf = support::glass(1.5F, 1, Spectrum(Spectrum::Constant(0.1F)));
                },
                {"/ball", "absorb"}},
        Refused{"MitsubaMirroredBall",
                to_mitsuba,
                [](SceneDesc& d) { d.shapes[1].to_world.linear().col(0) *= -1; },
                {"/ball", "inside out", "resolution"}},
        Refused{"PovraySchlick", to_povray, schlick_floor, {"/floor", "schlick"}},
        Refused{"PovrayAreaLight", to_povray, shining, {"/floor", "area light"}},
        Refused{"PovrayBitmap",
                to_povray,
                [](SceneDesc& d) { d.shapes[0].bsdf.model = Diffuse{Bitmap{}}; },
                {"/floor", "bitmap"}},
        Refused{"PovrayColouredGlass",
                to_povray,
                [](SceneDesc& d) {
                    std::get<Dielectric>(d.shapes[1].bsdf.model).specular_transmittance[1] = 0.5F;
                },
                {"/ball", "specular_transmittance"}},
        Refused{"PovrayAbsorbingWater",
                to_povray,
                [](SceneDesc& d) {
                    d.shapes[2].bsdf = support::glass(1.3F, 1, Spectrum(Spectrum::Ones()));
                },
                {"/mirror", "absorption"}},
        Refused{"PovrayAbsorbingSurroundings",
                to_povray,
                [](SceneDesc& d) {
                    std::get<Dielectric>(d.shapes[1].bsdf.model).ext_absorption.setOnes();
                },
                {"/ball", "ext_absorption"}},
        Refused{"PovrayTwoOutsides",
                to_povray,
                [](SceneDesc& d) { d.shapes[0].bsdf = support::glass(1.3F, 1.1F); },
                {"/ball", "ext_ior"}},
        Refused{"PovrayFromInside",
                to_povray,
                [](SceneDesc& d) {
                    d.shapes[0].bsdf = support::glass(1.3F);
                    d.shapes[0].flip_normals = true;
                },
                {"/floor", "from inside", "the camera"}}),
    [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace caustics::experiments
