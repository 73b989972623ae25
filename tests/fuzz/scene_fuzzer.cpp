#include <cmath>
#include <optional>

#include "core/base/parallel.h"
#include "core/render/renderer.h"
#include "core/scene/scene_keys.h"
#include "core/scene/scene_reader.h"
#include "photonmap/photon_map.h"
#include "tests/fuzz/json_hooks.h"
#include "tests/fuzz/reading.h"

namespace {

using namespace caustics;

void put_heights(const char* name, int width, const std::vector<float>& values) {
    Film film(width, static_cast<int>(values.size()) / width);
    film.plane("Y") = values;
    write_exr(film, fuzz::named(name));
}

std::string from_hex(std::string_view digits) {
    std::string bytes;
    for (std::size_t i = 0; i < digits.size(); i += 2)
        bytes += static_cast<char>(std::stoi(std::string(digits.substr(i, 2)), nullptr, 16));
    return bytes;
}

/// What scenes may name.
void put_neighbours() {
    fuzz::put("mesh.ply",
              "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
              "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
              "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    fuzz::put("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
    fuzz::put("part.json", R"({"type": "diffuse", "reflectance": 0.5})");
    fuzz::put("loop.json", R"({"a": {"$include": "loop.json"}})");
    fuzz::put("odd.json", R"({"type": "rgb", "value": [0.1, "x", 0.3]})");
    fuzz::put("bad.json", R"({"type": )");
    fuzz::put("bad.ply", "ply\n");
    // More levels than may be.
    for (int i = 0; i < 70; ++i)
        fuzz::put("deep" + std::to_string(i) + ".json",
                  R"({"$include": "deep)" + std::to_string(i + 1) + R"(.json"})");
    write_png(2, 2, {0, 10, 100, 200, 255, 1, 2, 3, 4, 90, 91, 92}, fuzz::named("texture.png"));
    put_heights("heights.exr", 3, {0, 0.5F, 1, 0.25F, -1, 0});
    put_heights("bright.exr", 2, {0, 3, 1, 1e9F});
    put_heights("row.exr", 2, {0, 1});
    fuzz::put("grey8.png", from_hex("89504e470d0a1a0a0000000d4948445200000002000000020800000000"
                                    "57dd52f80000000e4944415478da6360646260660100001d000b10dd1c70"
                                    "0000000049454e44ae426082"));
    fuzz::put("grey16.png",
              from_hex("89504e470d0a1a0a0000000d4948445200000002000000021000000000"
                       "074d8ebb000000124944415478da636064626661606563e70000008c0025d2205019"
                       "0000000049454e44ae426082"));
}

/// Valid, but much work: tests of these limits are elsewhere.
const std::map<std::string, double> limits = {
    {"resolution", 16}, {"segments", 16}, {"count", 16}, {"levels", 4}, {"split_depth", 1}};

void require_finite(const Film& film) {
    for (const Plane& plane : film.planes())
        for (const float value : plane.values)
            if (!std::isfinite(value)) fuzz::fail("a value that is not finite in " + plane.channel);
}

/// A tiny picture by the photon map.
void render_picture(SceneDesc desc) {
    desc.camera.width = 4;
    desc.camera.height = 4;
    const Scene scene(std::move(desc));
    photonmap::PhotonMapParams params;
    params.photons = 0;
    params.emitted = 32;
    params.nearest = 4;
    RunOptions options;
    options.adaptive = false;
    const auto map = photonmap::build(scene, params, options);
    require_finite(render(scene, *map, options).film);
}

void read_scene(std::string_view text) {
    const auto file = fuzz::put("scene.json", text);
    std::optional<SceneFile> scene;
    if (!fuzz::taken(fuzz::Naming::file, [&] { scene = load_scene(file); })) return;
    // A picture takes as long as reading a hundred files.
    if (!fuzz::one_in(32, text)) return;
    fuzz::require(load_scene(file).hash == scene->hash, "another hash the second time");
    fuzz::taken(fuzz::Naming::nothing, [&] { render_picture(std::move(scene->desc)); });
}

}  // namespace

const std::vector<std::string>& caustics::fuzz::words() {
    static const std::vector<std::string> all = [] {
        std::vector<std::string> known = fuzz::words_of(scene_file::scene_keys());
        for (const char* file :
             {"mesh.ply", "mesh.obj", "texture.png", "heights.exr", "bright.exr", "row.exr",
              "grey8.png", "grey16.png", "part.json", "loop.json", "odd.json", "bad.json",
              "bad.ply", "deep0.json", "scene.json", "none.ply", "../scene.json", "."})
            known.emplace_back(file);
        return known;
    }();
    return all;
}

extern "C" int LLVMFuzzerInitialize(int*, char***) {
    caustics::fuzz::words();  // by the tables of all readers
    put_neighbours();
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = fuzz::view(data, size);
    if (!fuzz::asks_for_much(text, limits)) run_single_threaded([&] { read_scene(text); });
    return 0;
}
