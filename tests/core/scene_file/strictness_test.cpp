// Nothing in a scene file is silently ignored: whatever is changed in one that is good is refused.
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/scene/scene_reader.h"
#include "tests/support/temporary_folder.h"

namespace caustics {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

const fs::path scenes = CAUSTICS_SOURCE_DIR "/experiments/scenes";

/// Calls visit(pointer, value) for a value and all in it.
void walk(const json& value, const json::json_pointer& at,
          const std::function<void(const json::json_pointer&, const json&)>& visit) {
    visit(at, value);
    if (value.is_object())
        for (const auto& [key, child] : value.items()) walk(child, at / key, visit);
    if (value.is_array())
        for (std::size_t i = 0; i < value.size(); ++i) walk(value[i], at / i, visit);
}

json resolved(json value) {
    if (value.is_object() && value.contains("$include"))
        return resolved(
            json::parse(std::ifstream(scenes / value.at("$include").get<std::string>())));
    for (json& child : value)
        if (child.is_structured()) child = resolved(child);
    return value;
}

/// A value of another type than the good one's, so that no key takes both.
json of_other_type(const json& value) {
    if (value.is_boolean()) return 1;
    return true;
}

class Strictness : public testing::TestWithParam<std::string> {
protected:
    void SetUp() override {
        // Parts name textures as ../textures/...
        fs::create_directory(folder_ / "scenes");
        fs::create_directory_symlink(scenes / "textures", folder_ / "textures");
        good_ = resolved(json::parse(std::ifstream(scenes / (GetParam() + ".json"))));
        std::ofstream(folder_ / "scenes" / "good.json") << good_;
        static_cast<void>(load_scene(folder_ / "scenes" / "good.json"));
    }

    void expect_refused(const std::string& text, const std::string& change) {
        const fs::path file = folder_ / "scenes" / "changed.json";
        std::ofstream(file) << text;
        ++changes_;
        try {
            static_cast<void>(load_scene(file));
            ADD_FAILURE() << change << " is accepted";
        } catch (const InputError& error) {
            const std::string message = error.what();
            EXPECT_NE(message.find(folder_.path().string()), std::string::npos) << message;
            EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        }
    }

    support::TemporaryFolder folder_{"strictness_" + GetParam()};
    json good_;
    int changes_ = 0;
};

TEST_P(Strictness, AnyUnknownKeyIsRefused) {
    walk(good_, json::json_pointer(), [&](const json::json_pointer& at, const json& value) {
        if (!value.is_object()) return;
        json changed = good_;
        changed[at]["unknwon"] = 1;
        expect_refused(changed.dump(), at.to_string() + " with an unknown key");
    });
    EXPECT_GT(changes_, 3);
}

TEST_P(Strictness, AnyDoubledKeyIsRefused) {
    walk(good_, json::json_pointer(), [&](const json::json_pointer& at, const json& value) {
        if (!value.is_object()) return;
        for (const auto& [key, child] : value.items()) {
            // The copy gets a name of its own in the tree, and the key's in the text.
            json changed = good_;
            changed[at]["doubled"] = child;
            std::string text = changed.dump();
            text.replace(text.find("\"doubled\""), 9, json(key).dump());
            expect_refused(text, (at / key).to_string() + " doubled");
        }
    });
    EXPECT_GT(changes_, 10);
}

TEST_P(Strictness, AnyMisspeltKeyIsRefused) {
    walk(good_, json::json_pointer(), [&](const json::json_pointer& at, const json& value) {
        // The names of children that are objects are the user's to choose.
        if (!value.is_object()) return;
        for (const auto& [key, child] : value.items()) {
            const bool named_by_user = child.is_object() && child.contains("type");
            if (named_by_user && !child.contains("value")) continue;
            json changed = good_;
            changed[at].erase(key);
            changed[at][key + "x"] = child;
            expect_refused(changed.dump(), (at / key).to_string() + " misspelt");
        }
    });
    EXPECT_GT(changes_, 10);
}

TEST_P(Strictness, AnyValueOfAnotherTypeIsRefused) {
    walk(good_, json::json_pointer(), [&](const json::json_pointer& at, const json& value) {
        for (const json& other : {of_other_type(value), json()}) {
            json changed = good_;
            changed[at] = other;
            expect_refused(changed.dump(), at.to_string() + " as " + other.dump());
        }
    });
    EXPECT_GT(changes_, 20);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Strictness,
                         testing::Values("ball", "pool", "pool_area", "pool_waves", "ring",
                                         "ring_figure1"),
                         [](const auto& scene) { return scene.param; });

}  // namespace
}  // namespace caustics
