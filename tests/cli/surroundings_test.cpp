#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/render/film.h"
#include "experiments/base/file_io.h"
#include "tests/cli/program.h"
#include "tests/support/sanitizers.h"
#include "tests/support/temporary_folder.h"

namespace caustics::experiments {
namespace {

using support::ProgramResult;
using support::shell;
namespace fs = std::filesystem;

const std::string scene_path = CAUSTICS_SOURCE_DIR "/tests/experiments/scenes/ball.json";

/// Streams that are closed or full, small limits, folders that are gone.
class Surroundings : public testing::Test {
protected:
    void SetUp() override {
        write_atomic_file(sweep_, fmt::format(R"({{"version": 1, "scenes": ["{}"], "spp": 1,
                                                  "methods": [{{"method": "none"}}]}})",
                                              scene_path));
    }
    /// $D is the test's folder.
    ProgramResult run(const std::string& line) const {
        return shell(fmt::format("D='{}'; S='{}'; {}", folder_.path().string(), scene_path, line));
    }
    std::size_t temporary_files() const {
        const auto all = fs::recursive_directory_iterator(folder_.path());
        return static_cast<std::size_t>(std::ranges::count_if(all, [](const auto& entry) {
            const std::string name = entry.path().filename();
            return name.find(".tmp-") != std::string::npos || name.ends_with(".part");
        }));
    }
    support::TemporaryFolder folder_;
    fs::path sweep_ = folder_ / "sweep.json";
};

TEST_F(Surroundings, WithoutAStandardErrorNothingElseIsLost) {
    for (const std::string no_errors : {"2>/dev/full", "2>&-"}) {
        EXPECT_EQ(run("$P info /absent " + no_errors).exit_code, 2);
        EXPECT_EQ(run("$P render $S --method none -o $D/a.exr " + no_errors).exit_code, 0);
        EXPECT_GT(read_exr(folder_ / "a.exr").width(), 0) << "no message is written into it";
        EXPECT_EQ(run("$P sweep $D/sweep.json -o $D/out " + no_errors).exit_code, 0);
        EXPECT_EQ(run("$P merge $D/out -o $D/merged " + no_errors).exit_code, 0);
        EXPECT_EQ(std::ranges::count(read_whole_file(folder_ / "merged/records.csv"), '\n'), 2);
        fs::remove_all(folder_ / "out");
        fs::remove_all(folder_ / "merged");
    }
}

TEST_F(Surroundings, AnAnswerThatCannotBeWrittenIsAnError) {
    for (const std::string verb :
         {"--version", "--help", "sweep --help", "info $S", "sweep $D/sweep.json -o $D/out"})
        for (const std::string no_answers : {" >/dev/full", " >&-"}) {
            const ProgramResult result = run("$P " + verb + no_answers);
            EXPECT_EQ(result.exit_code, 2) << verb << no_answers;
            EXPECT_NE(result.err.find("standard output: cannot be written\n"), std::string::npos)
                << verb << no_answers << result.err;
        }
}

// With less than 64 KiB the system's loader may end the program before it has begun.
TEST_F(Surroundings, TooSmallAStackIsOneLine) {
    if (CAUSTICS_ADDRESS_SANITIZER || CAUSTICS_THREAD_SANITIZER)
        GTEST_SKIP() << "sanitizers need a larger stack to start";
    for (const int kibibytes : {64, 100, 128, 256, 511})
        for (const std::string verb : {"--version", "render $S --method none -o $D/a.exr",
                                       "sweep $D/sweep.json -o $D/out"}) {
            const ProgramResult result = run(fmt::format("ulimit -s {}; $P {}", kibibytes, verb));
            EXPECT_EQ(result.exit_code, 1) << kibibytes << verb;
            EXPECT_EQ(
                result.err,
                fmt::format("causticbench: error: the stack is limited to {} KiB, and 512 KiB are "
                            "needed (ulimit -s 512)\n",
                            kibibytes))
                << verb;
        }
    EXPECT_FALSE(fs::exists(folder_ / "out"));
    EXPECT_EQ(run("ulimit -s 512; $P render $S --method beamtree -o $D/a.exr").exit_code, 0);
    EXPECT_EQ(run("ulimit -s unlimited; $P --version").exit_code, 0);
}

TEST_F(Surroundings, ASweepWhoseFolderIsMadeAnewLeavesNothingInTheNewOne) {
    write_atomic_file(folder_ / "many.json",
                      fmt::format(R"({{"version": 1, "scenes": ["{}"], "spp": 1, "repeats": 2000,
                                       "methods": [{{"method": "none"}}]}})",
                                  scene_path));
    const ProgramResult result =
        run("$P sweep $D/many.json -o $D/out & sweep=$!; "
            "until ls $D/out/trials/*/record.json >/dev/null 2>&1; do sleep 0.02; done; "
            "mv $D/out $D/old; mkdir $D/out; wait $sweep");
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_NE(result.err.find("out: was renamed, removed or made anew while"), std::string::npos)
        << result.err;
    EXPECT_TRUE(fs::is_empty(folder_ / "out"));
    EXPECT_FALSE(fs::is_empty(folder_ / "old/trials"));
}

TEST_F(Surroundings, AFileThatMayNotGrowIsAnErrorAndLeavesNothing) {
    for (const std::string verb :
         {"render $S --method none -o $D/a.exr", "sweep $D/sweep.json -o $D/out",
          "export $S --to mitsuba -o $D/exported"}) {
        const ProgramResult result = run("ulimit -f 1; $P " + verb);
        EXPECT_EQ(result.exit_code, 2) << verb;
        EXPECT_NE(result.err.find("cannot be written (File too large)"), std::string::npos)
            << verb << result.err;
        EXPECT_EQ(temporary_files(), 0U) << verb;
    }
    EXPECT_FALSE(fs::exists(folder_ / "a.exr"));
    EXPECT_FALSE(fs::exists(folder_ / "exported"));
    EXPECT_EQ(run("$P sweep $D/sweep.json -o $D/out").exit_code, 0) << "and it goes on from there";
    const ProgramResult merge = run("ulimit -f 1; $P merge $D/out -o $D/merged");
    EXPECT_EQ(merge.exit_code, 2);
    EXPECT_NE(merge.err.find("merged.part/"), std::string::npos) << merge.err;
    EXPECT_NE(merge.err.find("File too large"), std::string::npos) << merge.err;
    EXPECT_EQ(temporary_files(), 0U);
}

// Of the address space the system's loader needs some for the libraries themselves: there it is the one that complains. With less
// than here some libraries end the program as they start.
TEST_F(Surroundings, TooLittleAddressSpaceIsOneLine) {
    if (CAUSTICS_ADDRESS_SANITIZER || CAUSTICS_THREAD_SANITIZER)
        GTEST_SKIP() << "sanitizers reserve terabytes";
    constexpr int unloaded = 127;
    int failures = 0;
    for (int megabytes = 100; megabytes <= 300; megabytes += 10) {
        const ProgramResult result = run(fmt::format(
            "ulimit -v {}; $P render $S --method beamtree --threads 2 -o $D/a.exr --set "
            "/sensor/film/width=8 --set /sensor/film/height=6",
            1000 * megabytes));
        if (result.exit_code == 0 || result.exit_code == unloaded) continue;
        ++failures;
        EXPECT_EQ(result.exit_code, 1) << megabytes << result.err;
        EXPECT_TRUE(result.err.starts_with("causticbench: error: ")) << megabytes << result.err;
        EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << megabytes << result.err;
    }
    EXPECT_GT(failures, 0);
    EXPECT_EQ(temporary_files(), 0U);
}

TEST_F(Surroundings, NoLinkIsReplacedByAPicture) {
    write_atomic_file(folder_ / "file.exr", "precious");
    fs::create_symlink("file.exr", folder_ / "link.exr");
    for (const std::string verb : {"render $S --method none -o $D/link.exr",
                                   "render $S --method photonmap --param photons=100 --param "
                                   "save=$D/link.exr -o $D/a.exr"}) {
        const ProgramResult result = run("$P " + verb);
        EXPECT_EQ(result.exit_code, 2) << verb;
        EXPECT_NE(result.err.find("link.exr: is a symbolic link"), std::string::npos) << result.err;
    }
    EXPECT_EQ(read_whole_file(folder_ / "link.exr"), "precious");
    EXPECT_TRUE(fs::is_symlink(folder_ / "link.exr"));
}

TEST_F(Surroundings, OneFileIsOneWhateverItsName) {
    for (const std::string results :
         {"-o a.exr -o ./a.exr", "-o a.exr -o $D/a.exr",
          "--param photons=10 --param save=../$(basename $D)/a.exr -o a.exr"}) {
        const ProgramResult result = run("cd $D; $P render $S --method photonmap " + results);
        EXPECT_EQ(result.exit_code, 2) << results << result.err;
        EXPECT_NE(result.err.find("take the other's place"), std::string::npos) << result.err;
        EXPECT_FALSE(fs::exists(folder_ / "a.exr")) << results;
    }
}

TEST_F(Surroundings, NoFileThatIsReadIsReplaced) {
    nlohmann::json content = nlohmann::json::parse(read_whole_file(scene_path));
    content["floor"]["bsdf"] = {{"$include", "bsdf.json"}};
    content["gem"] = {{"type", "obj"}, {"filename", "gem.obj"}};
    content["gem"]["bsdf"] = {{"type", "dielectric"}};
    write_atomic_file(folder_ / "scene.json", content.dump());
    write_atomic_file(folder_ / "bsdf.json", R"({"type": "diffuse", "reflectance":
        {"type": "bitmap", "filename": "wood.png"}})");
    write_atomic_file(folder_ / "gem.obj",
                      "v 0 0 1.5\nv 0.1 0 1.5\nv 0 0.1 1.5\nv 0 0 1.6\n"
                      "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    write_atomic_file(folder_ / "points.csv", "x,y,z,nx,ny,nz\n0,0,0,0,0,1\n");
    ASSERT_EQ(run("cd $D; $P render $S --method none -o wood.png").exit_code, 0);
    const std::string methods =
        "--method photonmap --param photons=100 --param save={} --indirect globalphotonmap "
        "--indirect-param photons=100 --indirect-param save={} --spp 1 -o {}";
    const auto render = [&](const std::string& map, const std::string& global_map,
                            const std::string& picture) {
        return "render scene.json " + fmt::format(fmt::runtime(methods), map, global_map, picture);
    };
    const std::string load = " --param load=map.exr",
                      load_global = " --indirect-param load=global.exr";
    ASSERT_EQ(run("cd $D; $P " + render("map.exr", "global.exr", "a.exr")).exit_code, 0);
    const std::string probe = "probe scene.json --points points.csv --method ";
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"scene.json", probe + "none -o ./scene.json"},
        {"scene.json", render("$D/scene.json", "b", "b.exr")},
        {"bsdf.json", probe + "none -o ../$(basename $D)/bsdf.json"},
        {"bsdf.json", render("b", "bsdf.json", "b.exr")},
        {"gem.obj", probe + "none -o gem.obj"},
        {"gem.obj", render("gem.obj", "b", "b.exr")},
        {"wood.png", "render scene.json --method none -o b.exr -o wood.png"},
        {"points.csv", probe + "none -o points.csv"},
        {"map.exr", probe + "photonmap -o map.exr" + load},
        {"map.exr", "render scene.json --method photonmap -o map.exr" + load},
        {"global.exr",
         "render scene.json --method none --indirect globalphotonmap -o global.exr" + load_global}};
    for (const auto& [file, line] : cases) {
        const std::string before = read_whole_file(folder_ / file);
        const ProgramResult result = run("cd $D; $P " + line);
        EXPECT_EQ(result.exit_code, 2) << line << result.err;
        EXPECT_NE(result.err.find(file + ": is read, and "), std::string::npos)
            << line << result.err;
        EXPECT_EQ(read_whole_file(folder_ / file), before) << line;
    }
    for (const char* made : {"b", "b.exr"}) EXPECT_FALSE(fs::exists(folder_ / made)) << made;
}

TEST_F(Surroundings, AWorkingFolderThatIsGoneIsNamed) {
    const std::string gone = "mkdir $D/gone; cd $D/gone; rmdir $D/gone; ";
    const ProgramResult sweep = run(gone + "$P sweep $D/sweep.json -o $D/out");
    EXPECT_EQ(sweep.exit_code, 2);
    EXPECT_NE(sweep.err.find("the working folder: No such file or directory"), std::string::npos)
        << sweep.err;
    EXPECT_EQ(run(gone + "$P render $S --method none -o $D/a.exr").exit_code, 0);
}

TEST_F(Surroundings, WhatTheFileSystemRefusesIsOneLineWithItsPlace) {
    write_atomic_file(folder_ / "long.json", fmt::format(R"({{"version": 1, "scenes": ["{}"],
                                      "methods": [{{"method": "none"}}]}})",
                                                         std::string(5000, 'a')));
    const ProgramResult scenes = run("$P sweep $D/long.json -o $D/out");
    EXPECT_EQ(scenes.exit_code, 2);
    EXPECT_NE(scenes.err.find("File name too long"), std::string::npos) << scenes.err;
    EXPECT_EQ(std::ranges::count(scenes.err, '\n'), 1) << scenes.err;

    const ProgramResult report =
        run("mkdir $D/out; : > $D/out/report; "
            "$P sweep $D/sweep.json -o $D/out");
    EXPECT_EQ(report.exit_code, 2);
    EXPECT_NE(report.err.find("out/report"), std::string::npos) << report.err;
    EXPECT_NE(report.err.find("Not a directory"), std::string::npos) << report.err;
}

/// Results from elsewhere may hold links: what a sweep, a merge or a report writes and removes is in its folder.
TEST_F(Surroundings, NoLinkInAFolderLeadsElsewhere) {
    const auto precious = [&](const std::string& name) {
        write_atomic_file(folder_ / name, "precious");
        return folder_ / name;
    };
    fs::create_directory(folder_ / "home");
    const fs::path file = precious("home/file");
    precious("home/a.tmp-1");
    fs::create_directory(folder_ / "out");
    for (const char* name : {".lock", "plan.json", "environment.json", "records.csv",
                             "records.jsonl", ".table", "records.csv.tmp-1"})
        fs::create_symlink(file, folder_ / "out" / name);
    const ProgramResult lock = run("$P sweep $D/sweep.json -o $D/out");
    EXPECT_EQ(lock.exit_code, 2);
    EXPECT_NE(lock.err.find("out/.lock: is a symbolic link"), std::string::npos) << lock.err;
    fs::remove(folder_ / "out/.lock");
    for (const char* name : {"trials", "report", "report/figures"}) {
        fs::create_directories((folder_ / "out" / name).parent_path());
        fs::create_directory_symlink(folder_ / "home", folder_ / "out" / name);
        const ProgramResult result = run("$P sweep $D/sweep.json -o $D/out");
        EXPECT_EQ(result.exit_code, 2) << name;
        EXPECT_NE(result.err.find(std::string("out/") + name + ": is a symbolic link"),
                  std::string::npos)
            << result.err;
        fs::remove(folder_ / "out" / name);
    }
    EXPECT_EQ(run("$P sweep $D/sweep.json -o $D/out").exit_code, 0);
    EXPECT_EQ(read_whole_file(file), "precious");
    EXPECT_EQ(read_whole_file(folder_ / "home/a.tmp-1"), "precious");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "home"), {}), 2);
}

/// Names that would leave their folder, their line, their word, their quotes or their element.
TEST_F(Surroundings, HostileNamesAreNamesAndNothingElse) {
    const std::vector<std::string> names = {"$(touch pwned)`touch pwned`;touch pwned",
                                            "=cmd|'pwned'!A1",
                                            "<script>pwned()",
                                            "a'b\"c&d",
                                            "..",
                                            "-o pwned",
                                            "%n$x\\"};
    std::string scenes;
    nlohmann::json content = nlohmann::json::parse(read_whole_file(scene_path));
    for (const std::string& name : names) {
        content["sensor"]["fov"] = 30 + scenes.size();  // the same scene twice would be one trial
        write_atomic_file(folder_ / (name + ".json"), content.dump());
        scenes += (scenes.empty() ? "" : ", ") + nlohmann::json(name + ".json").dump();
    }
    write_atomic_file(sweep_, R"({"version": 1, "scenes": [)" + scenes +
                                  R"(], "spp": 1, "methods": [{"method": "none"}]})");
    EXPECT_EQ(run("cd $D && $P sweep sweep.json -o out").exit_code, 0);
    EXPECT_EQ(run("cd $D && for t in $(ls out/trials); do $P explain out $t | sh || exit 1; done")
                  .exit_code,
              0);
    EXPECT_EQ(run("cd $(dirname $P) && $P explain $D/out $(ls $D/out/trials | head -n 1) | "
                  "grep -q '^[.]/causticbench render '")
                  .exit_code,
              0)
        << "the shell looks for a bare name elsewhere";
    const std::string table = read_whole_file(folder_ / "out/records.csv");
    EXPECT_EQ(table.find(",=cmd"), std::string::npos) << table;
    EXPECT_NE(table.find(",'=cmd"), std::string::npos) << table;
    EXPECT_EQ(run("cd $D && $P merge out -o merged").exit_code, 0);
    EXPECT_EQ(run("cd $D && $P export './<script>pwned().json' --to mitsuba -o xml").exit_code, 0);
    EXPECT_EQ(run("cd $D && $P export './-o pwned.json' --to povray -o pov").exit_code, 0);
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path()))
        EXPECT_NE(entry.path().filename(), "pwned") << entry.path();
}

TEST_F(Surroundings, SlashesAtTheEndOfAFolderMakeNoDifference) {
    for (const std::string slashes : {"/", "//", "/."}) {
        EXPECT_EQ(run("$P sweep $D/sweep.json -o $D/out" + slashes).exit_code, 0) << slashes;
        EXPECT_EQ(run("$P merge $D/out" + slashes + " -o $D/merged" + slashes).exit_code, 0)
            << slashes;
        EXPECT_EQ(run("$P export $S --to povray -o $D/exported" + slashes).exit_code, 0) << slashes;
        EXPECT_TRUE(fs::exists(folder_ / "merged/records.csv")) << slashes;
        EXPECT_TRUE(fs::exists(folder_ / "exported/scene.pov")) << slashes;
        for (const char* folder : {"out", "merged", "exported"}) fs::remove_all(folder_ / folder);
    }
}

}  // namespace
}  // namespace caustics::experiments
