#include <gtest/gtest.h>

#include "experiments/base/file_io.h"
#include "tests/cli/program.h"
#include "tests/support/temporary_folder.h"

namespace caustics::experiments {
namespace {

using support::causticbench;
using support::ProgramResult;
namespace fs = std::filesystem;

const std::string scenes = CAUSTICS_SOURCE_DIR "/experiments/scenes/";

TEST(Export, WritesAFolderThatAnotherRendererReads) {
    const support::TemporaryFolder folder;
    const std::string out = folder / "new/folder";
    const ProgramResult mitsuba =
        causticbench({"export", scenes + "pool.json", "--to", "mitsuba", "-o", out, "--set",
                      "/water/bsdf/absorption=0", "--set",
                      "/floor/bsdf={\"type\":\"diffuse\",\"reflectance\":0.25}"});
    ASSERT_EQ(mitsuba.exit_code, 0) << mitsuba.err;
    EXPECT_NE(mitsuba.err.find("note: /water: a caster with vertex normals"), std::string::npos);
    EXPECT_NE(read_whole_file(out + "/scene.xml").find("0.25 0.25 0.25"), std::string::npos);
    EXPECT_EQ(std::distance(fs::directory_iterator(out), {}), 2);

    const ProgramResult povray = causticbench(
        {"export", scenes + "crosscheck/ball_point.json", "--to", "povray", "-o", out});
    ASSERT_EQ(povray.exit_code, 0) << povray.err;
    EXPECT_NE(read_whole_file(out + "/scene.ini").find("Input_File_Name=scene.pov"),
              std::string::npos);
    EXPECT_TRUE(fs::exists(out + "/scene.pov"));
}

TEST(Export, TakesNamesOfAnyLength) {
    const support::TemporaryFolder folder;
    const std::string name(300, 'w');
    std::string text = read_whole_file(scenes + "pool.json");
    text.replace(text.find("\"water\""), 7, '"' + name + '"');
    for (std::size_t at = text.find("parts/"); at != std::string::npos;
         at = text.find("parts/", at + scenes.size() + 6))
        text.insert(at, scenes);
    write_atomic_file(folder / "scene.json", text);
    const ProgramResult result =
        causticbench({"export", folder / "scene.json", "--to", "mitsuba", "-o", folder / "out",
                      "--set", "/" + name + "/bsdf/absorption=0", "--set",
                      "/floor/bsdf={\"type\":\"diffuse\",\"reflectance\":0.25}"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(std::distance(fs::directory_iterator(folder / "out"), {}), 2);
}

TEST(Export, RefusesWhatTheOtherCannotExpress) {
    const support::TemporaryFolder folder;
    const std::string out = folder / "out";
    const ProgramResult schlick =
        causticbench({"export", scenes + "ring.json", "--to", "povray", "-o", out});
    EXPECT_EQ(schlick.exit_code, 3);
    EXPECT_NE(schlick.err.find("ring.json: /floor: POV-Ray has no schlick"), std::string::npos)
        << schlick.err;
    EXPECT_FALSE(fs::exists(out));

    const ProgramResult target =
        causticbench({"export", scenes + "ring.json", "--to", "blender", "-o", out});
    EXPECT_EQ(target.exit_code, 2);
    EXPECT_NE(target.err.find("mitsuba"), std::string::npos) << target.err;
    const ProgramResult place = causticbench({"export", scenes + "crosscheck/ball_point.json",
                                              "--to", "mitsuba", "-o", scenes + "ring.json"});
    EXPECT_EQ(place.exit_code, 2);
    EXPECT_NE(place.err.find("no folder"), std::string::npos) << place.err;
}

}  // namespace
}  // namespace caustics::experiments
