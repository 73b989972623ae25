#include <gtest/gtest.h>

#include <fstream>

#include "core/base/error.h"
#include "core/render/film.h"
#include "core/scene/scene_reader.h"
#include "tests/support/temporary_folder.h"

namespace caustics {
namespace {

namespace fs = std::filesystem;

const fs::path& folder() {
    static const support::TemporaryFolder temporary("broken_scenes_test");
    return temporary.path();
}

void write_scene(const std::string& name, const std::string& text) {
    std::ofstream(folder() / name) << text;
}

struct Broken {
    const char* name;
    std::string text;
    std::vector<std::string> expected;  ///< the pointer first, then reasons and alternatives
};

void PrintTo(const Broken& broken, std::ostream* out) { *out << broken.name; }

/// A good scene with one more child, "it".
std::string with(const std::string& child) {
    return R"({"sensor": {"type": "perspective"}, "floor": {"type": "rectangle"}, "it": )" + child +
           "}";
}
std::string with_bsdf(const std::string& bsdf) {
    return with(R"({"type": "disk", "b": )" + bsdf + "}");
}
std::string with_sensor(const std::string& keys) {
    return R"({"sensor": {"type": "perspective", )" + keys + R"(}, "floor": {"type": "disk"}})";
}
std::string with_to_world(const std::string& to_world) {
    return with(R"({"type": "disk", "to_world": )" + to_world + "}");
}

std::vector<Broken> broken_scenes() {
    return {
        // The scene.
        {"no_sensor", R"({"floor": {"type": "disk"}})", {"/: ", "no sensor", "perspective"}},
        {"two_sensors", with(R"({"type": "perspective"})"), {"/sensor", "one sensor"}},
        {"no_shape", R"({"sensor": {"type": "perspective"}})", {"/: ", "no shape"}},
        {"version_2", R"({"version": 2})", {"/version", "from 1 to 1"}},
        {"other_root", R"({"type": "bsdf"})", {"/type", "scene"}},
        {"word_for_an_object",
         with(R"({"type": "sphere", "bsdf": "diffuse"})"),
         {"/it: ", "unknown key \"bsdf\"", "an object with a type, not \"diffuse\""}},
        {"number_for_an_object",
         with(R"({"type": "sphere", "bsdf": 0.5})"),
         {"/it: ", "unknown key \"bsdf\"", "an object with a type, not 0.5"}},
        {"truth_for_an_object",
         with(R"({"type": "sphere", "bsdf": true})"),
         {"/it: ", "unknown key \"bsdf\"", "an object with a type, not true"}},
        {"word_for_a_texture",
         with(R"({"type": "disk", "b": {"type": "diffuse", "reflectance": "wood.png"}})"),
         {"/it/b/reflectance", "[r, g, b]", "rgb, bitmap or checkerboard"}},
        {"two_channels_for_a_texture",
         with(R"({"type": "disk", "b": {"type": "diffuse", "reflectance": [1, 0]}})"),
         {"/it/b/reflectance", "[r, g, b]", "rgb, bitmap or checkerboard"}},
        {"stray_value", with("3"), {"/: ", "unknown key \"it\"", "type, version"}},
        {"array_root", "[]", {"/: ", "expected an object"}},
        {"truncated", R"({"sensor": )", {"line 1, column"}},
        {"twice", R"({"a": {}, "a": {}})", {"/a", "twice"}},
        {"no_type", with(R"({"radius": 1})"), {"/it", "\"type\" is missing", "radius"}},
        {"unknown_type", with(R"({"type": "shpere"})"), {"/it", "shpere", "sphere, cylinder"}},
        {"integrator", with(R"({"type": "path"})"), {"/it", "integrators are not supported"}},
        {"root_bsdf", with(R"({"type": "diffuse"})"), {"/it", "nested in the shape"}},
        {"root_area", with(R"({"type": "area"})"), {"/it", "nested in the shape"}},
        // What later versions or other programs have.
        {"envmap", with(R"({"type": "envmap"})"), {"/it", "not supported (yet)", "point"}},
        {"two_skies",
         with(R"({"type": "constant"}, "sky": {"type": "constant"})"),
         {"takes one constant light"}},
        {"instance", with(R"({"type": "instance"})"), {"/it", "not supported (yet)"}},
        {"shapegroup", with(R"({"type": "shapegroup"})"), {"/it", "not supported (yet)"}},
        {"ref", with(R"({"type": "ref", "id": "x"})"), {"/it", "not supported (yet)"}},
        {"medium", with(R"({"type": "homogeneous"})"), {"/it", "not supported (yet)"}},
        {"phong_gains",
         with_bsdf(R"({"type": "phong", "diffuse_reflectance": 0.7, "specular_reflectance": 0.4})"),
         {"/it/b", "together are above 1", "classic"}},
        {"phong_gains_on_some_squares",
         with_bsdf(R"({"type": "phong", "specular_reflectance": 0.4, "diffuse_reflectance":
                       {"type": "checkerboard", "color0": 0.1, "color1": 0.7}})"),
         {"/it/b", "together are above 1", "classic"}},
        {"phong_model",
         with_bsdf(R"({"type": "phong", "model": "blinn"})"),
         {"/it/b/model", "blinn", "normalised, classic"}},
        {"blend_of_none", with_bsdf(R"({"type": "blendbsdf"})"), {"/it/b", "exactly two nested"}},
        {"blend_of_mirrors",
         with_bsdf(
             R"({"type": "blendbsdf", "a": {"type": "dielectric"}, "b": {"type": "conductor"}})"),
         {"/it/b", "one of diffuse, schlick, phong with a conductor"}},
        {"blend_of_receivers",
         with_bsdf(R"({"type": "blendbsdf", "a": {"type": "diffuse"}, "b": {"type": "phong"}})"),
         {"/it/b", "one of diffuse, schlick, phong with a conductor"}},
        {"blend_of_a_twosided_receiver",
         with_bsdf(R"({"type": "blendbsdf", "b": {"type": "conductor"},
                       "a": {"type": "twosided", "d": {"type": "diffuse"}}})"),
         {"/it/b", "twosided goes around the blend"}},
        {"blend_of_a_twosided_mirror",
         with_bsdf(R"({"type": "blendbsdf", "a": {"type": "diffuse"},
                       "b": {"type": "twosided", "d": {"type": "conductor"}}})"),
         {"/it/b", "twosided goes around the blend"}},
        {"blend_weight",
         with_bsdf(R"({"type": "blendbsdf", "weight": 1.5, "a": {"type": "diffuse"},
                       "b": {"type": "conductor"}})"),
         {"/it/b/weight", "out of range (from 0 to 1)"}},
        {"blend_texture",
         with_bsdf(R"({"type": "blendbsdf", "weight": {"type": "checkerboard"},
                       "a": {"type": "diffuse"}, "b": {"type": "conductor"}})"),
         {"/it/b/weight", "not supported (yet)"}},
        {"law_without_numbers",
         with_bsdf(R"({"type": "dielectric", "int_ior": {"type": "cauchy"}})"),
         {"/it/b/int_ior", "\"A\""}},
        {"unknown_law",
         with_bsdf(R"({"type": "dielectric", "int_ior": {"type": "hartmann"}})"),
         {"/it/b/int_ior", "hartmann", "cauchy, sellmeier, abbe"}},
        {"unknown_glass",
         with_bsdf(
             R"({"type": "dielectric", "int_ior": {"type": "sellmeier", "material": "BK8"}})"),
         {"/it/b/int_ior/material", "unknown glass \"BK8\"", "bk7, f2, sf5"}},
        {"glass_and_terms",
         with_bsdf(R"({"type": "dielectric",
                       "int_ior": {"type": "sellmeier", "material": "bk7", "B": [1], "C": [0]}})"),
         {"/it/b/int_ior/material", "either a material or B and C"}},
        {"terms_of_two_lengths",
         with_bsdf(
             R"({"type": "dielectric", "int_ior": {"type": "sellmeier", "B": [1, 2], "C": [0]}})"),
         {"/it/b/int_ior", "equal length"}},
        {"glass_and_one_list",
         with_bsdf(R"({"type": "dielectric",
                       "int_ior": {"type": "sellmeier", "material": "bk7", "C": [0]}})"),
         {"/it/b/int_ior/material", "either a material or B and C"}},
        {"no_terms",
         with_bsdf(R"({"type": "dielectric", "int_ior": {"type": "sellmeier", "B": [], "C": []}})"),
         {"/it/b/int_ior", "at least 1"}},
        {"pole_in_the_light",
         with_bsdf(
             R"({"type": "dielectric", "int_ior": {"type": "sellmeier", "B": [1], "C": [0.25]}})"),
         {"/it/b/int_ior", "infinite at 500 nm"}},
        {"index_below_one",
         with_bsdf(
             R"({"type": "dielectric", "int_ior": {"type": "cauchy", "A": 1.01, "B": -0.01}})"),
         {"/it/b/int_ior", "at 380 nm, below 1"}},
        {"root_of_a_negative",
         with_bsdf(
             R"({"type": "dielectric", "int_ior": {"type": "sellmeier", "B": [-2], "C": [0]}})"),
         {"/it/b/int_ior", "not finite at 380 nm"}},
        {"abbe_0",
         with_bsdf(R"({"type": "dielectric", "int_ior": {"type": "abbe", "n_d": 1.5, "V_d": 0}})"),
         {"/it/b/int_ior/V_d", "above 0"}},
        {"gaussian",
         with_sensor(R"("f": {"type": "hdrfilm", "r": {"type": "gaussian"}})"),
         {"/sensor/f/r", "gaussian", "not supported (yet)", "box"}},
        // Sensors.
        {"fov_0", with_sensor(R"("fov": 0)"), {"/sensor/fov", "between 1e-6 and 179.9999"}},
        {"fov_axis", with_sensor(R"("fov_axis": "z")"), {"/sensor/fov_axis", "x, y, diagonal"}},
        {"focal",
         with_sensor(R"("focal_length": "50mm")"),
         {"/sensor: ", "unknown key \"focal_length\"", "fov, fov_axis, to_world"}},
        {"sheared",
         with_sensor(R"("to_world": [{"scale": [1, 2, 1]}])"),
         {"/sensor/to_world", "one positive scale"}},
        {"mirrored",
         with_sensor(R"("to_world": [{"scale": [-1, 1, 1]}])"),
         {"/sensor/to_world", "one positive scale"}},
        {"width_0",
         with_sensor(R"("f": {"type": "hdrfilm", "width": 0})"),
         {"/sensor/f/width", "from 1 to 65536"}},
        {"half_pixel",
         with_sensor(R"("f": {"type": "hdrfilm", "width": 1.5})"),
         {"/sensor/f/width", "whole number"}},
        {"too_large",
         with_sensor(R"("f": {"type": "hdrfilm", "width": 60000, "height": 60000})"),
         {"/sensor/f", "pixels"}},
        {"half_float",
         with_sensor(R"("f": {"type": "hdrfilm", "component_format": "float16"})"),
         {"/sensor/f", "component_format", "width, height"}},
        {"two_films",
         with_sensor(R"("f": {"type": "hdrfilm"}, "g": {"type": "hdrfilm"})"),
         {"/sensor/g", "one film"}},
        {"not_square",
         with_sensor(R"("s": {"type": "stratified", "sample_count": 10})"),
         {"/sensor/s/sample_count", "9 or 16"}},
        {"jitter",
         with_sensor(R"("s": {"type": "independent", "jitter": true})"),
         {"/sensor/s", "unknown key \"jitter\"", "sample_count"}},
        {"sampler",
         with_sensor(R"("s": {"type": "multijitter"})"),
         {"/sensor/s", "not supported (yet)", "stratified"}},
        // Lights.
        {"two_positions",
         with(R"({"type": "point", "position": [0, 0, 0], "to_world": []})"),
         {"/it/to_world", "either position or to_world"}},
        {"position_2",
         with(R"({"type": "point", "position": [0, 0]})"),
         {"/it/position", "3 numbers"}},
        {"no_direction",
         with(R"({"type": "directional", "direction": [0, 0, 0]})"),
         {"/it/direction", "zero"}},
        {"negative",
         with(R"({"type": "point", "intensity": [1, -1, 1]})"),
         {"/it/intensity/1", "from 0"}},
        {"faint_point",
         with(R"({"type": "point", "intensity": 1e-44})"),
         {"/it/intensity: ", "0, or from 1e-30 to 1e+30"}},
        {"fainter_than_floats",
         with(R"({"type": "point", "intensity": [1, 0, 1e-60]})"),
         {"/it/intensity/2: ", "0, or from 1e-30 to 1e+30"}},
        {"faint_spot",
         with(R"({"type": "spot", "intensity": {"type": "rgb", "value": 1e-40}})"),
         {"/it/intensity/value: ", "0, or from"}},
        {"faint_sun", with(R"({"type": "directional", "irradiance": 1e-40})"), {"/it/irradiance"}},
        {"faint_sky", with(R"({"type": "constant", "radiance": 1e-40})"), {"/it/radiance"}},
        {"faint_room", with(R"({"type": "ambient", "radiance": 1e-40})"), {"/it/radiance"}},
        {"faint_area", with_bsdf(R"({"type": "area", "radiance": 1e-40})"), {"/it/b/radiance"}},
        {"strong_area", with_bsdf(R"({"type": "area", "radiance": 3e38})"), {"/it/b/radiance"}},
        {"spectrum",
         with(R"({"type": "point", "intensity": {"type": "spectrum"}})"),
         {"/it/intensity", "not supported (yet)", "rgb"}},
        {"colour_4",
         with(R"({"type": "point", "intensity": [1, 1, 1, 1]})"),
         {"/it/intensity", "[r, g, b]"}},
        // Shapes.
        {"typo",
         with(R"({"type": "sphere", "raduis": 2})"),
         {"/it: ", "unknown key \"raduis\"", "radius"}},
        {"radius_0", with(R"({"type": "sphere", "radius": 0})"), {"/it/radius", "above 0"}},
        {"tiny_radius",
         with(R"({"type": "sphere", "radius": 1e-45})"),
         {"/it: ", "2e-45 m wide", "less than 1e-10 m", "an exact shape"}},
        {"tiny_scale",
         with_to_world(R"([{"scale": 1e-30}])"),
         {"/it: ", "2e-30 m wide", "1e-10 m"}},
        {"thin_rectangle",
         with(R"({"type": "rectangle", "to_world": [{"scale": [1e-11, 1, 1]},
                  {"rotate": {"axis": [1, 2, 3], "angle": 40}}]})"),
         {"/it: ", "2e-11 m wide"}},
        {"thin_tube", with(R"({"type": "cylinder", "radius": 1e-30})"), {"/it: ", "2e-30 m wide"}},
        {"short_tube",
         with(R"({"type": "cylinder", "p0": [0, 0, 1e-30], "p1": [0, 0, 0]})"),
         {"/it: ", "p0 and p1", "1e-10 m"}},
        {"thin_water",
         with(R"({"type": "heightfield", "waves": [], "half_size": [1e-30, 1]})"),
         {"/it: ", "2e-30 m wide"}},
        {"tiny_mesh",
         with(R"({"type": "lathe", "profile": [[0, 0], [1e-30, 1e-30], [0, 2e-30]]})"),
         {"/it"}},
        {"tiny_cube",
         with(R"({"type": "cube", "to_world": [{"scale": 1e-8}]})"),
         {"/it: ", "2e-08 m wide", "less than 1e-07 m", "a mesh"}},
        {"vast_cube",
         with(R"({"type": "cube", "to_world": [{"scale": 1e13}]})"),
         {"/it: ", "a mesh", "1e+13 m", "beyond 1e+12 m"}},
        {"lonely_floor",
         with(R"({"type": "sphere", "center": [0, 1e10, 0], "bsdf": {"type": "dielectric"}})"),
         {"/floor: ", "2.83 m wide", "1e+10 m", "casters"}},
        {"no_axis", with(R"({"type": "cylinder", "p0": [0, 0, 1]})"), {"/it", "p0 and p1"}},
        {"stretched",
         with(R"({"type": "sphere", "to_world": [{"scale": [1, 1, 2]}]})"),
         {"/it/to_world", "resolution"}},
        {"resolution_0",
         with(R"({"type": "disk", "resolution": 0})"),
         {"/it/resolution", "from 1"}},
        {"sphere_1", with(R"({"type": "sphere", "resolution": 1})"), {"/it/resolution", "from 2"}},
        {"faces",
         with(R"({"type": "disk", "face_normals": true})"),
         {"/it/face_normals", "resolution"}},
        {"no_heights",
         with(R"({"type": "heightfield"})"),
         {"/it: ", "one of waves, fractal and filename"}},
        {"wave_typo",
         with(R"({"type": "heightfield",
                  "waves": [{"amplitude": 1, "wave_vector": [1, 0], "phaes": 0}]})"),
         {"/it/waves/0", "phaes", "phase"}},
        {"endless_crests",
         with(R"({"type": "heightfield", "half_size": [2, 3],
                  "waves": [{"amplitude": 1, "wave_vector": [1e4, 1e4]}]})"),
         {"/it/waves/0/wave_vector", "1.59e+04 crests", "more than 10000"}},
        {"shining_field",
         with(R"({"type": "heightfield", "waves": [], "e": {"type": "area"}})"),
         {"/it/e", "resolution"}},
        {"two_bsdfs",
         with(R"({"type": "disk", "a": {"type": "diffuse"}, "b": {"type": "diffuse"}})"),
         {"/it/b", "one bsdf", "\"a\" and \"b\""}},
        {"two_bsdfs_one_without_a_name",
         with(R"({"type": "disk", "": {"type": "diffuse"}, "b": {"type": "diffuse"}})"),
         {"/it/b", "one bsdf", "\"\" and \"b\""}},
        {"two_emitters",
         with(R"({"type": "disk", "a": {"type": "area"}, "b": {"type": "area"}})"),
         {"/it/b", "one emitter", "\"a\" and \"b\""}},
        {"spot_cutoff",
         with(R"({"type": "spot", "cutoff_angle": 180})"),
         {"/it/cutoff_angle", "179"}},
        {"spot_beam",
         with(R"({"type": "spot", "cutoff_angle": 10, "beam_width": 11})"),
         {"/it/beam_width", "from 0 to 10"}},
        {"spot_texture",
         with(R"({"type": "spot", "texture": {"type": "bitmap"}})"),
         {"texture", "beam_width"}},
        {"spot_position",
         with(R"({"type": "spot", "position": [0, 0, 1]})"),
         {"position", "to_world"}},
        {"nested_point", with(R"({"type": "disk", "a": {"type": "point"}})"), {"/it/a", "area"}},
        {"no_mesh",
         with(R"({"type": "ply", "filename": "absent.ply"})"),
         {"/it/filename", "no such file", "absent.ply"}},
        {"broken_mesh",
         with(R"({"type": "ply", "filename": "broken.ply"})"),
         {"/it/filename", "broken.ply"}},
        {"wrong_mesh",
         with(R"({"type": "obj", "filename": "broken.ply"})"),
         {"/it/filename", "takes a .obj file", "ply"}},
        {"mesh_resolution",
         with(R"({"type": "ply", "filename": "broken.ply", "resolution": 3})"),
         {"/it/resolution", "analytic"}},
        // Scattering.
        {"metal",
         with_bsdf(R"({"type": "conductor", "material": "Au"})"),
         {"/it/b/material", "Au", "none"}},
        {"liquid",
         with_bsdf(R"({"type": "dielectric", "int_ior": "wather"})"),
         {"/it/b/int_ior", "wather", "water, "}},
        {"ior_0",
         with_bsdf(R"({"type": "dielectric", "int_ior": 0})"),
         {"/it/b/int_ior", "out of range"}},
        {"iro",
         with_bsdf(R"({"type": "dielectric", "int_iro": 1.5})"),
         {"/it/b: ", "int_iro", "int_ior"}},
        {"too_white",
         with_bsdf(R"({"type": "diffuse", "reflectance": 1.1})"),
         {"/it/b/reflectance", "from 0 to 1"}},
        {"alpha_0", with_bsdf(R"({"type": "schlick", "alpha": 0})"), {"/it/b/alpha", "above 0"}},
        {"alpha_2",
         with_bsdf(R"({"type": "schlick", "alpha": 2})"),
         {"/it/b/alpha", "from 0 to 1"}},
        {"glass_twice",
         with_bsdf(R"({"type": "twosided", "g": {"type": "dielectric"}})"),
         {"/it/b/g", "diffuse, schlick, phong, conductor"}},
        {"empty_sides", with_bsdf(R"({"type": "twosided"})"), {"/it/b", "one nested bsdf"}},
        {"no_picture",
         with_bsdf(
             R"({"type": "diffuse", "reflectance": {"type": "bitmap", "filename": "no.png"}})"),
         {"/it/b/reflectance/filename", "no.png"}},
        {"bad_picture",
         with_bsdf(
             R"({"type": "diffuse", "reflectance": {"type": "bitmap", "filename": "broken.ply"}})"),
         {"/it/b/reflectance/filename", "broken.ply"}},
        {"bright_picture",
         with_bsdf(
             R"({"type": "diffuse", "reflectance": {"type": "bitmap", "filename": "bright.exr"}})"),
         {"/it/b/reflectance/filename", "above 1"}},
        {"wrap",
         with_bsdf(R"({"type": "diffuse", "reflectance":
                       {"type": "bitmap", "filename": "grey.exr", "wrap_mode": "tile"}})"),
         {"/it/b/reflectance/wrap_mode", "repeat, mirror, clamp"}},
        // Transforms.
        {"singular", with_to_world(R"([{"scale": [1, 1, 0]}])"), {"/it/to_world", "singular"}},
        {"short_matrix",
         with_to_world("[1, 0, 0, 0]"),
         {"/it/to_world", "16 numbers", "operations"}},
        {"projective",
         with_to_world("[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,1,1]"),
         {"/it/to_world", "last row"}},
        {"operation",
         with_to_world(R"([{"rotate_x": 3}])"),
         {"/it/to_world/0", "rotate_x", "translate, rotate, scale, look_at"}},
        {"two_operations",
         with_to_world(R"([{"scale": 2, "translate": [0, 0, 1]}])"),
         {"/it/to_world/0", "one operation"}},
        {"turned_too_often",
         with_to_world(R"([{"rotate": {"axis": [0, 0, 1], "angle": 1e30}}])"),
         {"/it/to_world/0/rotate/angle", "1e+30", "1000000"}},
        {"phase_of_no_digits",
         with(R"({"type": "heightfield",
                  "waves": [{"amplitude": 1, "wave_vector": [1, 0], "phase": 1e20}]})"),
         {"/it/waves/0/phase", "1000000"}},
        {"no_rotation_axis",
         with_to_world(R"([{"rotate": {"axis": [0, 0, 0], "angle": 1}}])"),
         {"/it/to_world/0/rotate/axis", "zero"}},
        {"up_along_view",
         with_to_world(
             R"([{"look_at": {"origin": [0, 0, 0], "target": [0, 0, 1], "up": [0, 0, 1]}}])"),
         {"/it/to_world/0/look_at", "up"}},
        {"beyond_float",
         with_to_world(R"([{"translate": [1e40, 0, 0]}])"),
         {"/it/to_world/0/translate/0", "out of range"}},
        {"beyond_float_together",
         with_to_world(R"([{"scale": 1e20}, {"scale": 1e20}])"),
         {"/it/to_world", "beyond 1e30"}},
        {"beyond_float_shape",
         with(R"({"type": "sphere", "radius": 1e20, "to_world": [{"scale": 1e20}]})"),
         {"/it: ", "beyond 5e+17 m"}},
        {"far_mesh",
         with(R"({"type": "cube", "to_world": [{"translate": [0, 2e18, 0]}]})"),
         {"/it: ", "beyond 5e+17 m"}},
        {"far_wave",
         with(R"({"type": "heightfield", "waves": [{"amplitude": 2e18, "wave_vector": [1, 0]}]})"),
         {"/it: ", "beyond 5e+17 m"}},
        {"far_lamp",
         with(R"({"type": "point", "position": [0, 0, -2e18]})"),
         {"/it: ", "beyond 5e+17 m"}},
        {"far_camera",
         with_sensor(R"("to_world": [{"translate": [2e18, 0, 0]}])"),
         {"/sensor/to_world: ", "beyond 5e+17 m"}},
        {"nul_in_a_name",
         with(R"({"type": "ply", "filename": "broken.ply\u0000"})"),
         {"/it/filename: ", "control character", "broken.ply\\u0000"}},
        {"escape_in_a_key", with(R"({"type": "disk", "\u001b[2J": 1})"), {"/it", "control"}},
        {"device_as_mesh",
         with(R"({"type": "ply", "filename": "/dev/zero"})"),
         {"/it/filename: ", "/dev/zero", "not a regular file"}},
        {"huge_picture",
         with_bsdf(
             R"({"type": "diffuse", "reflectance": {"type": "bitmap", "filename": "huge.tga"}})"),
         {"/it/b/reflectance/filename: ", "huge.tga", "12000 x 12000 pixels, more than"}},
        {"too_fine",
         with(R"({"type": "disk", "resolution": 5000})"),
         {"/it/resolution", "from 1 to 4096"}},
        {"null_colour",
         with(R"({"type": "point", "intensity": null})"),
         {"/it/intensity", "number, [r, g, b]"}},
        {"text_number",
         with_to_world(R"([{"translate": ["1", 0, 0]}])"),
         {"/it/to_world/0/translate/0", "expected a number"}},
    };
}

std::string with_lathe(const std::string& keys) {
    return with(R"({"type": "lathe", )" + keys + "}");
}
std::string with_cut(const std::string& keys) { return with(R"({"type": "cut", )" + keys + "}"); }
std::string with_heights(const std::string& keys) {
    return with(R"({"type": "heightfield", )" + keys + "}");
}

std::vector<Broken> broken_meshes() {
    const std::string box =
        R"("planes": [[1, 0, 0, 1], [-1, 0, 0, 1], [0, 1, 0, 1], [0, -1, 0, 1], [0, 0, -1, 1]])";
    return {
        // Rectangles and heightfields.
        {"three_resolutions",
         with(R"({"type": "rectangle", "resolution": [2, 3, 4]})"),
         {"/it/resolution", "a whole number or [nx, ny]"}},
        {"no_cells",
         with(R"({"type": "rectangle", "resolution": [2, 0]})"),
         {"/it/resolution/1", "from 1 to 4096"}},
        {"two_sectors_of_a_disk",
         with(R"({"type": "disk", "resolution": [2, 2]})"),
         {"/it/resolution", "whole number"}},
        {"two_kinds_of_heights",
         with_heights(R"("waves": [], "filename": "grey.exr")"),
         {"/it: ", "one of waves, fractal and filename"}},
        {"fine_fractal",
         with_heights(R"("fractal": {"levels": 16, "rms": 1})"),
         {"/it/fractal/levels", "from 2 to 12"}},
        {"fractal_typo",
         with_heights(R"("fractal": {"levels": 3, "rms": 1, "hursd": 1})"),
         {"/it/fractal: ", "hursd", "hurst"}},
        {"fractal_resolution",
         with_heights(R"("fractal": {"levels": 3, "rms": 1}, "resolution": 8)"),
         {"/it/resolution", "of their own"}},
        {"lowest_of_none",
         with_heights(R"("fractal": {"levels": 3, "rms": 1, "lowest": 5})"),
         {"/it/fractal/lowest", "from 1 to 4"}},
        {"high_waves",
         with_heights(R"("waves": [], "height": 2)"),
         {"/it/height", "only heights of a file"}},
        {"no_heights_file", with_heights(R"("filename": "no.exr")"), {"/it/filename", "no.exr"}},
        {"colours_as_heights",
         with_heights(R"("filename": "grey.exr")"),
         {"/it/filename", "one channel, and not 3"}},
        {"one_pixel_of_heights",
         with_heights(R"("filename": "one.pgm")"),
         {"/it/filename", "2 to 4097 pixels", "1 x 2"}},
        {"stairs", with_heights(R"("filename": "stairs.pgm")"), {"/it/filename", "8 bits"}},
        // Lathes.
        {"no_profile", with_lathe(R"("open": true)"), {"/it", "\"profile\" is missing"}},
        {"one_point", with_lathe(R"("profile": [[0, 0]])"), {"/it/profile", "at least 2"}},
        {"point_of_three",
         with_lathe(R"("profile": [[0, 0], [1, 0, 0], [0, 1]])"),
         {"/it/profile/1", "2 numbers"}},
        {"crease_typo",
         with_lathe(R"("profile": [[0, 0], {"at": [1, 1], "creese": true}, [0, 2]])"),
         {"/it/profile/1: ", "creese", "crease"}},
        {"holed",
         with_lathe(R"("profile": [[0, 0], [1, 1]])"),
         {"/it/profile", "last end [1, 1]", "\"open\": true"}},
        {"across_the_axis",
         with_lathe(R"("profile": [[0, 0], [-1, 1], [0, 2]])"),
         {"/it/profile", "point 1", "axis"}},
        {"crossing_profile",
         with_lathe(R"("profile": [[0, 0], [2, 2], [2, 0], [0, 2]])"),
         {"/it/profile", "meets itself"}},
        {"other_curve",
         with_lathe(R"("profile": [[0, 0], [1, 1], [0, 2]], "interpolation": "bezier")"),
         {"/it/interpolation", "linear, catmullrom"}},
        {"two_sectors",
         with_lathe(R"("profile": [[0, 0], [1, 1], [0, 2]], "resolution": 2)"),
         {"/it/resolution", "from 3 to 4096"}},
        {"many_segments",
         with_lathe(R"("profile": [[0, 0], [1, 1], [0, 2]], "segments": 3000)"),
         {"/it/profile", "more than 4096 segments"}},
        // Cuts.
        {"no_planes", with_cut(R"("rings": [])"), {"/it: ", "leave the solid open"}},
        {"no_normal",
         with_cut(R"("planes": [[0, 0, 0, 1]])"),
         {"/it/planes/0", "must not be zero"}},
        {"open_box", with_cut(box), {"/it: ", "open towards [", "1]"}},
        {"empty_box", with_cut(box + R"(, "height": -2)"), {"/it: ", "enclose nothing"}},
        {"many_planes",
         with_cut(box + R"(, "height": 1, "rings": [{"count": 200, "angle": 0, "distance": 1}])"),
         {"/it: ", "206 planes are more than 200"}},
        {"steep_ring",
         with_cut(R"("rings": [{"count": 3, "angle": 91, "distance": 1}])"),
         {"/it/rings/0/angle", "from -90 to 90"}},
        {"solid_with_sectors",
         with_cut(box + R"(, "height": 1, "resolution": 16)"),
         {"/it/resolution", "inner"}},
        {"wide_inside",
         with_cut(box + R"(, "height": 1, "inner": {"profile": [[1.1, 1], [0, 0]]})"),
         {"/it: ", "reaches the outside at r = 1.1"}},
        {"inner_typo",
         with_cut(box + R"(, "height": 1, "inner": {"profile": [[0.5, 1], [0, 0]], "open": true})"),
         {"/it/inner: ", "unknown key \"open\"", "profile, interpolation, segments"}},
    };
}

class BrokenScene : public testing::TestWithParam<Broken> {
protected:
    static void SetUpTestSuite() {
        // The header of a TGA picture of 12,000 x 12,000 pixels.
        const unsigned char huge[100] = {0, 0, 10, 0,    0,    0,    0,    0,  0,
                                         0, 0, 0,  0xE0, 0x2E, 0xE0, 0x2E, 24, 0};
        write_scene("huge.tga", {reinterpret_cast<const char*>(huge), sizeof huge});
        write_scene("stairs.pgm", {"P5 2 2 255\n\0\0\0\0", 15});
        write_scene("one.pgm", {"P5 1 2 65535\n\0\0\0\0", 17});
        write_scene("broken.ply", "ply\nformat ascii 1.0\nelement vertex 3\n");
        Film bright(1, 1);
        bright.set_rgb("", 0, Spectrum::Constant(1.5F));
        write_exr(bright, folder() / "bright.exr");
        bright.set_rgb("", 0, Spectrum::Constant(0.5F));
        write_exr(bright, folder() / "grey.exr");
    }
};

TEST_P(BrokenScene, IsOneErrorLineWithFilePlaceAndAlternatives) {
    const Broken& broken = GetParam();
    const std::string name = std::string(broken.name) + ".json";
    write_scene(name, broken.text);
    try {
        static_cast<void>(load_scene(folder() / name));
        FAIL() << "was accepted";
    } catch (const InputError& e) {
        const std::string message = e.what();
        EXPECT_TRUE(message.starts_with((folder() / name).string() + ": ")) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        for (const std::string& part : broken.expected)
            EXPECT_NE(message.find(part), std::string::npos) << part << " in: " << message;
    }
}

std::string name_of(const testing::TestParamInfo<Broken>& scene) { return scene.param.name; }

INSTANTIATE_TEST_SUITE_P(All, BrokenScene, testing::ValuesIn(broken_scenes()), name_of);
INSTANTIATE_TEST_SUITE_P(Meshes, BrokenScene, testing::ValuesIn(broken_meshes()), name_of);

TEST(BrokenOverride, NamesThePlaceAndWhatIsThere) {
    write_scene("good.json", with(R"({"type": "disk"})"));
    const auto error = [](const Overrides& overrides) -> std::string {
        try {
            static_cast<void>(load_scene(folder() / "good.json", overrides));
        } catch (const InputError& e) {
            return e.what();
        }
        return "no error";
    };
    EXPECT_NE(error({{"/lamp/radius", "1"}}).find("keys: floor, it, sensor"), std::string::npos);
    EXPECT_NE(error({{"/it/resolutoin", "4"}}).find("/it: unknown key \"resolutoin\""),
              std::string::npos);
    EXPECT_NE(error({{"/it/resolution", "many"}}).find("/it/resolution: expected a whole number"),
              std::string::npos);
    EXPECT_EQ(error({{"/it/resolution", "4"}}), "no error");
}

TEST(BrokenInclude, NamesTheIncludedFileAndTheWholePointer) {
    write_scene("ball.json", R"({"type": "sphere", "raduis": 1})");
    write_scene("including.json", with(R"({"$include": "ball.json"})"));
    try {
        static_cast<void>(load_scene(folder() / "including.json"));
        FAIL();
    } catch (const InputError& e) {
        const std::string message = e.what();
        EXPECT_TRUE(message.starts_with((folder() / "ball.json").string() + ": / (included as /it"))
            << message;
        EXPECT_NE(message.find("raduis"), std::string::npos);
    }
}

}  // namespace
}  // namespace caustics
