#include "tests/cruel/cruel_scene.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "core/scene/scene_keys.h"
#include "core/scene/scene_reader.h"
#include "tests/support/temporary_folder.h"

namespace caustics::cruel {
namespace {

/// Names of types and keys, as far as a scene's text has them.
void collect(const Json& value, std::set<std::string>& words) {
    if (value.is_object())
        for (const auto& [key, child] : value.items()) {
            words.insert(key);
            collect(child, words);
        }
    if (value.is_array())
        for (const Json& child : value) collect(child, words);
    if (value.is_string()) words.insert(value.get<std::string>());
}

// Objects that stand in scene files without a name.
const std::set<std::string> unnamed = {"wave", "profile point", "ring", "transform"};

TEST(CruelScene, IsTakenAndHasEveryTypeAndKeyThatHelpLists) {
    std::set<std::string> words;
    for (std::uint64_t seed = 1; seed <= 120; ++seed)
        for (const Purpose purpose : {Purpose::bits, Purpose::light}) {
            const support::TemporaryFolder folder("cruel_scene");
            const Json scene = cruel_scene(purpose, seed, folder.path());
            std::ofstream(folder / "scene.json") << scene.dump();
            EXPECT_NO_THROW(load_scene(folder / "scene.json")) << seed << scene.dump();
            collect(scene, words);
        }
    for (const ObjectText& object : scene_file::scene_keys()) {
        if (object.name == "$include") continue;  // replaced before any reader sees it
        EXPECT_TRUE(words.contains(object.name) || unnamed.contains(object.name)) << object.name;
        for (const KeyText& key : object.keys)
            EXPECT_TRUE(words.contains(key.key)) << object.name << " " << key.key;
    }
}

TEST(CruelScene, IsTheSameForTheSameSeed) {
    const support::TemporaryFolder folder;
    EXPECT_EQ(cruel_scene(Purpose::bits, 7, folder.path()),
              cruel_scene(Purpose::bits, 7, folder.path()));
    EXPECT_NE(cruel_scene(Purpose::bits, 7, folder.path()),
              cruel_scene(Purpose::bits, 8, folder.path()));
}

}  // namespace
}  // namespace caustics::cruel
