#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/atomic_file.h"
#include "tests/cli/program.h"
#include "tests/support/sanitizers.h"
#include "tests/support/temporary_folder.h"

namespace caustics {
namespace {

using support::ProgramResult;
using support::shell;

const std::string scene_folder = CAUSTICS_SOURCE_DIR "/experiments/scenes/";

/// Libraries that the program and its helpers load, as the loader tells (ld.so(8)).
class Start : public testing::Test {
protected:
    /// $D is the test's folder, $S that of the scenes.
    ProgramResult run(const std::string& line) const {
        return shell(
            fmt::format("D='{}'; S='{}'; {}", folder_.path().string(), scene_folder, line));
    }

    std::size_t libraries_of(const std::string& words) const {
        const ProgramResult result =
            run("rm -f $D/log.*; LD_DEBUG=files LD_DEBUG_OUTPUT=$D/log $P " + words +
                " >/dev/null || exit; cat $D/log.* | grep -c 'calling init:'");
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return std::stoul(result.out);
    }

    /// A scene whose floor shows a picture of a format that only OpenImageIO reads.
    std::string foreign_scene() const {
        write_atomic_file(folder_ / "floor.ppm", "P3\n2 1\n255\n255 0 0 0 255 0\n");
        write_atomic_file(folder_ / "scene.json", support::scene_of_picture("floor.ppm"));
        return folder_ / "scene.json";
    }

    support::TemporaryFolder folder_;
};

/// The libraries that are linked are fewer than 20 for each process, a sanitizer's included; OpenImageIO needs 250.
constexpr std::size_t few = 50;
constexpr std::size_t many = 60;

TEST_F(Start, LoadsFewLibrariesForPicturesOfItsOwn) {
    const std::string small =
        "--method none --set /sensor/film/width=4 --set /sensor/film/height=3 --spp 1";
    EXPECT_LT(libraries_of("--version"), few);
    EXPECT_LT(libraries_of("info $S/ball.json"), few) << "its texture is a PNG";
    EXPECT_LT(libraries_of("render $S/ball.json " + small + " -o $D/a.exr -o $D/a.png"), few);
    EXPECT_LT(libraries_of("compare $D/a.exr $D/a.exr"), few);
}

TEST_F(Start, LoadsOpenImageIoForAForeignPicture) {
    EXPECT_GT(libraries_of("info " + foreign_scene()), many);
}

TEST_F(Start, TrialsAreForkedAfterAForeignPictureWasRead) {
    write_atomic_file(folder_ / "sweep.json",
                      fmt::format(R"({{"version": 1, "scenes": ["{}"], "spp": 1, "seeds": [1, 2],
                                       "methods": [{{"method": "none"}}]}})",
                                  foreign_scene()));
    const ProgramResult swept = run("$P sweep $D/sweep.json -o $D/out");
    EXPECT_EQ(swept.exit_code, 0) << swept.err;
}

TEST_F(Start, ACopyOfTheProgramSaysWhereItLooksForItsHelper) {
    foreign_scene();
    const ProgramResult copied =
        run("mkdir $D/bin && cp $P $D/bin/copy && $D/bin/copy info $D/scene.json");
    EXPECT_EQ(copied.exit_code, 2) << copied.err;
    EXPECT_NE(copied.err.find(
                  "/causticbench/read_foreign_pictures, which cannot be started: No such file"),
              std::string::npos)
        << copied.err;
}

// An empty element of a search path is the working folder, where files of strangers are.
TEST_F(Start, TakesNoLibraryFromTheWorkingFolder) {
    write_atomic_file(
        folder_ / "planted.c",
        "#include <stdio.h>\n"
        "__attribute__((constructor)) static void begin(void) { puts(\"planted\"); }\n");
    const ProgramResult result =
        run("cd $D && c++ -x c -shared -fPIC planted.c -o one && "
            "for library in $(ldd $P | awk '$2 == \"=>\" {print $1}'); do cp one $library; done && "
            "ls lib*.so* && $P --version");
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.out.find("libpng16.so"), std::string::npos) << result.out;
    EXPECT_EQ(result.out.find("planted"), std::string::npos) << result.out;
}

TEST_F(Start, ProgramsAndHelpersHaveNoSearchPathAndAreBoundAtTheStart) {
    const ProgramResult result = run(
        "cd $(dirname $P)/.. && for file in bin/* tests/test_* $(find lib* -name 'read_*' -type "
        "f); do "
        "readelf -d $file >$D/dynamic && echo read; grep -E '\\((RPATH|RUNPATH)\\)' $D/dynamic; "
        "grep -q BIND_NOW $D/dynamic || echo $file is not bound at the start; done");
    EXPECT_NE(result.out.find("read"), std::string::npos) << result.err;
    EXPECT_EQ(result.out.find("PATH"), std::string::npos) << result.out;
    if (CAUSTICS_ADDRESS_SANITIZER) return;
    EXPECT_EQ(result.out.find("not bound"), std::string::npos) << result.out;
}

}  // namespace
}  // namespace caustics
