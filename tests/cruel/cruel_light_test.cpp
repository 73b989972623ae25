#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "core/base/error.h"
#include "core/light_path/empty_caustic.h"
#include "core/scene/scene_reader.h"
#include "tests/cruel/cruel_scene.h"
#include "tests/cruel/light_check.h"
#include "tests/cruel/scene_range.h"
#include "tests/cruel/shrink.h"
#include "tests/support/temporary_folder.h"

namespace caustics::cruel {
namespace {

std::filesystem::path write(const Json& scene, const std::filesystem::path& folder) {
    std::ofstream(folder / "scene.json") << scene.dump(1);
    return folder / "scene.json";
}

using experiments::Agreement;

// Where no light is sent towards casters there is nothing to compare.
Verdict verdict(const std::filesystem::path& file, const std::string& method, std::uint64_t seed) {
    const Scene scene(load_scene(file).desc);
    if (why_nothing_is_aimed(scene)) return {};
    return LightCheck(scene, seed).verdict(method);
}

Json shrunk_scene(const Json& scene, const std::filesystem::path& folder, const std::string& method,
                  std::uint64_t seed) {
    return shrunk(scene, [&](const Json& candidate) {
        try {
            return verdict(write(candidate, folder), method, seed).agreement == Agreement::fails;
        } catch (const std::exception&) {
            return false;  // without a floor, or no valid scene
        }
    });
}

// Slow ones, in few scenes.
bool is_its_turn(const std::string& method, std::uint64_t seed) {
    // With a planted fault the other methods say nothing new.
    if (const char* const fault = std::getenv("CAUSTICS_CRUEL_FAULT"))
        return std::string(fault).starts_with(method + "=");
    if (method == "causticpolygons") return seed % 16 == 0;
    if (method == "beamtree squares") return seed % 2 == 0;
    return true;
}

void check_light(const SceneRange& range, std::uint64_t seed) {
    const support::TemporaryFolder folder("cruel_light" + std::to_string(seed));
    const Json made = cruel_scene(Purpose::light, seed, folder.path());
    const Scene scene(load_scene(write(made, folder.path())).desc);
    if (why_nothing_is_aimed(scene)) return;
    LightCheck check(scene, seed);
    for (const std::string& method : checked_methods()) {
        if (!is_its_turn(method, seed)) continue;
        const Verdict found = check.verdict(method);
        if (found.served)
            range.note("{}\t{}\t{}\t{}\t{}\t{}\t{}\t{:.2f}\t{}", seed, method,
                       word(found.agreement), found.efforts, found.light, found.whole.value,
                       found.whole.error, found.cpu_seconds, found.text);
        if (found.agreement != Agreement::fails) continue;
        ADD_FAILURE() << "seed " << seed << ", " << method << ": " << found.text;
        if (std::getenv("CAUSTICS_CRUEL_SHRINK") != nullptr)
            ADD_FAILURE() << shrunk_scene(made, folder.path(), method, seed).dump();
    }
}

TEST(CruelLight, IsTheSameByEveryMethod) {
    const SceneRange range = SceneRange::asked(3);
    for (std::uint64_t seed = range.first; seed < range.first + range.count; ++seed) {
        SCOPED_TRACE(seed);
        EXPECT_NO_THROW(check_light(range, seed));
    }
}

// What cruel_light found stays here as scenes of their own.
TEST(CruelLight, AScenesFileIsAsked) {
    const char* const file = std::getenv("CAUSTICS_CRUEL_SCENE");
    if (file == nullptr) GTEST_SKIP() << "give a scene as CAUSTICS_CRUEL_SCENE";
    for (const std::string& method : checked_methods()) {
        const Verdict found = verdict(file, method, 1);
        EXPECT_NE(found.agreement, Agreement::fails) << method << ": " << found.text;
    }
}

}  // namespace
}  // namespace caustics::cruel
