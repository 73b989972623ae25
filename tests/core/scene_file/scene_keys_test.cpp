#include "core/scene/scene_keys.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <sstream>

#include "core/base/error.h"
#include "core/scene/scene_reader.h"
#include "tests/support/known_words.h"
#include "tests/support/temporary_folder.h"

namespace caustics {
namespace {

using Words = std::set<std::string>;

/// Where an object of a kind stands in the scene below, and what it is at least.
struct Place {
    std::string pointer;
    std::string object = {};  ///< JSON that is put there first; empty: what is there
};

const std::string texture = CAUSTICS_SOURCE_DIR "/experiments/scenes/textures/stone.png";
const std::string turned = R"([{"rotate": {"axis": [0, 0, 1], "angle": 9}}])";
const std::string view =
    R"([{"look_at": {"origin": [0, 0, 3], "target": [0, 0, 0], "up": [0, 1, 0]}}])";
const std::string waves =
    R"({"type": "heightfield", "waves": [{"amplitude": 0.1, "wave_vector": [1, 2]}]})";

const std::string vase = R"({"type": "lathe", "profile": [[0, 0], {"at": [1, 1]}, [0, 2]]})";
const std::string bowl =
    R"({"type": "cut", "rings": [{"count": 6, "angle": 0, "distance": 1}], "height": 1,
        "planes": [[0, 0, -1, 1]], "inner": {"profile": [[0.5, 1], [0, 0]]}})";
const std::string ground = R"({"type": "heightfield", "fractal": {"levels": 2, "rms": 0.1}})";

std::string plain(const std::string& type) { return R"({"type": ")" + type + R"("})"; }

Place place_of(const std::string& kind) {
    static const std::map<std::string, Place> places = {
        {"scene", {""}},
        {"perspective", {"/sensor"}},
        {"hdrfilm", {"/sensor/film"}},
        {"box", {"/sensor/film/filter"}},
        {"area", {"/floor/lamp", plain("area")}},
        {"obj", {"/thing", R"({"type": "obj", "filename": "one.obj"})"}},
        {"ply", {"/thing", R"({"type": "ply", "filename": "one.ply"})"}},
        {"heightfield", {"/thing", waves}},
        {"wave", {"/water/waves/0"}},
        {"fractal", {"/ground/fractal"}},
        {"lathe", {"/vase"}},
        {"profile point", {"/vase/profile/1"}},
        {"cut", {"/bowl"}},
        {"ring", {"/bowl/rings/0"}},
        {"inner", {"/bowl/inner"}},
        {"twosided", {"/floor/bsdf", R"({"type": "twosided", "inner": {"type": "diffuse"}})"}},
        {"blendbsdf",
         {"/floor/bsdf",
          R"({"type": "blendbsdf", "a": {"type": "diffuse"}, "b": {"type": "conductor"}})"}},
        {"rgb", {"/floor/bsdf/reflectance", R"({"type": "rgb", "value": 0.5})"}},
        {"bitmap",
         {"/floor/bsdf/reflectance", R"({"type": "bitmap", "filename": ")" + texture + R"("})"}},
        {"checkerboard", {"/floor/bsdf/reflectance", plain("checkerboard")}},
        {"cauchy", {"/glass/bsdf/int_ior", R"({"type": "cauchy", "A": 1.5, "B": 0.005})"}},
        {"sellmeier", {"/glass/bsdf/int_ior", R"({"type": "sellmeier", "material": "bk7"})"}},
        {"abbe", {"/glass/bsdf/int_ior", R"({"type": "abbe", "n_d": 1.5, "V_d": 60})"}}};
    if (const auto found = places.find(kind); found != places.end()) return found->second;
    for (const std::string sampler : {"independent", "stratified", "adaptive"})
        if (kind == sampler) return {"/sensor/sampler", plain(kind)};
    for (const std::string light : {"point", "spot", "directional", "constant", "ambient"})
        if (kind == light) return {"/light", plain(kind)};
    for (const std::string bsdf : {"diffuse", "schlick", "phong", "dielectric", "conductor"})
        if (kind == bsdf) return {"/floor/bsdf", plain(kind)};
    return {"/thing", plain(kind)};
}

class SceneKeys : public testing::Test {
protected:
    SceneKeys() {
        std::ofstream(folder_ / "scene.json") << R"({"sensor": {"type": "perspective",
                              "film": {"type": "hdrfilm", "filter": {"type": "box"}}},
                   "floor": {"type": "rectangle", "bsdf": {"type": "diffuse"}},
                   "glass": {"type": "sphere", "bsdf": {"type": "dielectric", "int_ior": 1.5}},
                   "water": )" << waves << R"(, "ground": )"
                                              << ground << R"(, "vase": )" << vase
                                              << R"(, "bowl": )" << bowl << "}";
        std::ofstream(folder_ / "one.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
        std::ofstream(folder_ / "one.ply")
            << "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
               "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
               "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    }

    /// What refuses the scene with these values in it; "" where it is taken.
    std::string refusal(const Overrides& values) const {
        try {
            load_scene(folder_ / "scene.json", values);
            return "";
        } catch (const InputError& error) {
            return error.what();
        }
    }

    Overrides at(const Place& place) const {
        if (place.object.empty()) return {};
        return {{place.pointer, place.object}};
    }

    std::string refusal_of(const Place& place, const std::string& key,
                           const std::string& value) const {
        Overrides values = at(place);
        values.emplace_back(place.pointer + "/" + key, value);
        return refusal(values);
    }

    /// The keys that the object's reader asks for, as its own message tells them.
    Words asked(const Place& place) const { return known(refusal_of(place, "no_such_key", "1")); }

    static Words known(const std::string& message) {
        EXPECT_NE(message.find("(known: "), std::string::npos) << message;
        return support::known_words(message);
    }

    support::TemporaryFolder folder_;
};

Words keys_of(const ObjectText& object) {
    Words all;
    for (const KeyText& key : object.keys) all.insert(key.key);
    return all;
}

/// Objects of a transform.
std::optional<Place> place_within(const std::string& name) {
    if (name == "transform") return Place{"/floor/to_world/0"};
    if (name == "rotate") return Place{"/floor/to_world/0/rotate"};
    if (name == "look_at") return Place{"/floor/to_world/0/look_at"};
    return {};
}

TEST_F(SceneKeys, AreThoseThatTheReadersAskFor) {
    for (const ObjectText& object : scene_file::scene_keys()) {
        if (object.name == "$include") continue;  // replaced before any reader sees it
        const auto within = place_within(object.name);
        if (within) {
            const Overrides values = {{"/floor/to_world", object.name == "look_at" ? view : turned},
                                      {within->pointer + "/no_such_key", "1"}};
            EXPECT_EQ(known(refusal(values)), keys_of(object)) << object.name;
            continue;
        }
        const Place place = place_of(object.name);
        EXPECT_EQ(refusal(at(place)), "") << object.name;
        EXPECT_EQ(asked(place), keys_of(object)) << object.name;
    }
}

TEST_F(SceneKeys, TakeTheirDefaultsAndChoices) {
    int tried = 0;
    for (const ObjectText& object : scene_file::scene_keys()) {
        if (object.name == "$include" || place_within(object.name)) continue;
        const Place place = place_of(object.name);
        for (const KeyText& key : object.keys) {
            std::istringstream choices(key.type == "choice" ? key.choices : "");
            for (std::string word; std::getline(choices >> std::ws, word, ',');)
                EXPECT_EQ(refusal_of(place, key.key, word), "") << object.name << " " << key.key;
            const bool is_told_in_words = key.usual.empty() || key.usual == "none" ||
                                          key.usual.find("times") != key.usual.npos ||
                                          key.usual.find(" with") != key.usual.npos;
            // Without a mesh there is nothing to shade.
            if (is_told_in_words || key.key == "face_normals") continue;
            EXPECT_EQ(refusal_of(place, key.key, key.usual), "") << object.name << " " << key.key;
            ++tried;
        }
    }
    EXPECT_GT(tried, 50);
}

TEST_F(SceneKeys, AreToldOfEveryType) {
    Words told;
    for (const ObjectText& object : scene_file::scene_keys()) told.insert(object.name);
    for (const std::string place : {"/thing", "/sensor/film", "/sensor/film/filter", "/floor/bsdf",
                                    "/floor/bsdf/reflectance", "/glass/bsdf/int_ior"})
        for (const std::string& type : known(refusal({{place, plain("no_such_type")}})))
            EXPECT_TRUE(told.contains(type)) << place << " " << type;
}

TEST_F(SceneKeys, IncludeAnotherFile) {
    std::ofstream(folder_ / "paint.json") << plain("diffuse");
    EXPECT_EQ(refusal({{"/floor/bsdf", R"({"$include": "paint.json"})"}}), "");
}

}  // namespace
}  // namespace caustics
