#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "core/render/film.h"
#include "experiments/base/file_io.h"
#include "experiments/cli/verbs.h"
#include "tests/cli/program.h"
#include "tests/support/temporary_folder.h"

namespace caustics::experiments {
namespace {

using support::causticbench;
using support::ProgramResult;
namespace fs = std::filesystem;

const std::string scene_of_ball = CAUSTICS_SOURCE_DIR "/tests/experiments/scenes/ball.json";

std::vector<std::string> lines(const std::string& text) {
    std::vector<std::string> all;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) all.push_back(line);
    return all;
}

TEST(Program, TellsItsVersionAndHelp) {
    const ProgramResult version = causticbench({"--version"});
    EXPECT_EQ(version.exit_code, 0);
    EXPECT_EQ(version.out.rfind("causticbench ", 0), 0U) << version.out;
    for (const std::string verb :
         {"render", "probe", "sweep", "compare", "info", "verify", "export", "report"}) {
        const ProgramResult help = causticbench({verb, "--help"});
        EXPECT_EQ(help.exit_code, 0);
        EXPECT_NE(help.out.find("Example:\n  causticbench " + verb), std::string::npos) << help.out;
    }
}

TEST(Program, PrintsTheHelpOfAVerb) {
    CLI::App app;
    for (const Verb& verb : add_verbs(app)) {
        const std::string name = verb.app->get_name();
        const ProgramResult told = causticbench({"help", name});
        EXPECT_EQ(told.exit_code, 0) << name << told.err;
        EXPECT_TRUE(told.out.starts_with(causticbench({name, "--help"}).out)) << name;
        EXPECT_NE(told.out.find("Usage: causticbench " + name), std::string::npos) << told.out;
    }
    EXPECT_NE(causticbench({"help", "sweep"}).out.find("Sweep files: JSON"), std::string::npos);
    EXPECT_NE(causticbench({"help"}).out.find("help VERB prints"), std::string::npos);
}

TEST(Program, TakesWordsAfterAVerbForItsArguments) {
    for (const std::string topic : {"scene", "sweep", "records", "beamtree"}) {
        const ProgramResult help = causticbench({"help", topic});
        EXPECT_EQ(help.exit_code, 0) << topic << ": " << help.err;
        EXPECT_GT(std::ranges::count(help.out, '\n'), 15) << topic;
    }
    EXPECT_EQ(causticbench({"help", "verbs"}).exit_code, 2);
    EXPECT_EQ(causticbench({"info", "sweep"}).err.find("causticbench: error: sweep:"), 0U);
}

TEST(Render, GivesTheSameBytesOnAnyNumberOfThreads) {
    const support::TemporaryFolder folder;
    const auto render = [&](const std::string& name, const std::string& threads,
                            const std::string& seed) {
        const std::string file = folder / name;
        const ProgramResult result = causticbench(
            {"render", scene_of_ball, "--method", "photonmap", "--param", "photons=2000",
             "--threads", threads, "--seed", seed, "-o", file, "-o", file + ".png"});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_TRUE(fs::exists(file + ".png"));
        return read_whole_file(file);
    };
    const std::string one = render("one.exr", "1", "1");
    EXPECT_EQ(one, render("two.exr", "2", "1"));
    EXPECT_NE(one, render("other.exr", "2", "7"));
}

TEST(Render, AddsTheIndirectLayerWhereAMethodIsNamed) {
    const support::TemporaryFolder folder;
    const auto render = [&](const std::string& name, const std::vector<std::string>& more) {
        std::vector<std::string> words = {"render",  scene_of_ball, "--method", "photonmap",
                                          "--param", "photons=500", "--spp",    "1",
                                          "-o",      folder / name};
        words.insert(words.end(), more.begin(), more.end());
        return causticbench(words);
    };
    ASSERT_EQ(render("without.exr", {}).exit_code, 0);
    ASSERT_EQ(render("none.exr", {"--indirect", "none"}).exit_code, 0);
    EXPECT_EQ(read_whole_file(folder / "without.exr"), read_whole_file(folder / "none.exr"));
    const ProgramResult global =
        render("global.exr", {"--indirect", "globalphotonmap", "--indirect-param", "photons=1000",
                              "--indirect-param", "gather=2"});
    ASSERT_EQ(global.exit_code, 0) << global.err;
    const Film film = read_exr(folder / "global.exr");
    EXPECT_TRUE(film.has_layer("indirect"));
    EXPECT_EQ(film.metadata.at("indirect"), "globalphotonmap");
    EXPECT_NE(film.metadata.at("command").find("--indirect globalphotonmap"), std::string::npos);
    for (const std::vector<std::string>& bad :
         {std::vector<std::string>{"--indirect", "globalphotonmap", "--indirect-param",
                                   "gather=-1"},
          {"--indirect", "beamtree"},
          {"--indirect-param", "gather=1"}})
        EXPECT_EQ(render("bad.exr", bad).exit_code, 2) << bad.back();
}

TEST(Probe, AnswersTheIndirectLayer) {
    const support::TemporaryFolder folder;
    std::ofstream(folder / "points.csv") << "x,y,z,nx,ny,nz\n0.3,0.2,0,0,0,1\n";
    const std::string points = folder / "points.csv";
    const ProgramResult answer =
        causticbench({"probe", scene_of_ball, "--layer", "indirect", "--indirect",
                      "globalphotonmap", "--indirect-param", "photons=1000", "--points", points});
    EXPECT_EQ(answer.exit_code, 0) << answer.err;
    EXPECT_NE(answer.out.find("irradiance_r"), std::string::npos);
    EXPECT_EQ(
        causticbench({"probe", scene_of_ball, "--layer", "indirect", "--points", points}).exit_code,
        2);
    EXPECT_EQ(causticbench({"probe", scene_of_ball, "--points", points}).exit_code, 2);
    EXPECT_EQ(causticbench({"probe", scene_of_ball, "--method", "none", "--indirect",
                            "globalphotonmap", "--points", points})
                  .exit_code,
              2);
}

TEST(Probe, OfTheIndirectLayerNotesWhatIsAmissWithTheScene) {
    const support::TemporaryFolder folder;
    write_atomic_file(folder / "points.csv", "x,y,z,nx,ny,nz\n0.3,0.2,0,0,0,1\n");
    const ProgramResult answer =
        causticbench({"probe", scene_of_ball, "--set",
                      R"(/second={"type": "sphere", "center": [0.3, 0, 0.6], "radius": 0.4,
                                    "bsdf": {"type": "dielectric"}})",
                      "--layer", "indirect", "--indirect", "globalphotonmap", "--indirect-param",
                      "photons=100", "--points", folder / "points.csv"});
    EXPECT_EQ(answer.exit_code, 0) << answer.err;
    EXPECT_NE(answer.err.find("note: the dielectrics ball and second cross"), std::string::npos)
        << answer.err;
}

TEST(Render, WritesTheWholeConfigurationIntoThePicture) {
    const support::TemporaryFolder folder;
    const std::string file = folder / "a.exr";
    ASSERT_EQ(
        causticbench({"render", scene_of_ball, "--method", "photonmap", "--param", "photons=500",
                      "--set", "/floor/bsdf/reflectance=0.25", "--spp", "9", "-o", file})
            .exit_code,
        0);
    const Film film = read_exr(file);
    for (const char* layer : {"", "direct", "caustic", "specular", "albedo"})
        EXPECT_TRUE(film.has_layer(layer)) << layer;
    EXPECT_NE(film.metadata.at("scene").find("0.25"), std::string::npos);
    EXPECT_EQ(nlohmann::json::parse(film.metadata.at("parameters")).at("nearest"), 50);
    EXPECT_NE(film.metadata.at("command").find("--set /floor/bsdf/reflectance=0.25"),
              std::string::npos);
    EXPECT_EQ(film.metadata.at("spp"), "9");
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        const Spectrum sum =
            film.rgb("direct", i) + film.rgb("caustic", i) + film.rgb("specular", i);
        EXPECT_TRUE((film.rgb("", i) == sum).all()) << "beauty is not the sum at pixel " << i;
    }
}

TEST(Render, TellsItsCountsAndWhyACausticIsEmpty) {
    const support::TemporaryFolder folder;
    const std::string file = folder / "a.exr";
    std::vector<std::string> arguments = {"render",  scene_of_ball, "--method", "photonmap",
                                          "--param", "emitted=200", "-o",       file};
    const ProgramResult lit = causticbench(arguments);
    EXPECT_NE(lit.err.find("200 light paths, "), std::string::npos) << lit.err;
    EXPECT_EQ(lit.err.find("empty"), std::string::npos) << lit.err;
    EXPECT_FALSE(read_exr(file).metadata.contains("why_empty"));
    arguments.insert(arguments.end(), {"--set", R"(/ball/bsdf={"type": "diffuse"})"});
    const ProgramResult empty = causticbench(arguments);
    EXPECT_EQ(empty.exit_code, 0);
    EXPECT_NE(empty.err.find("\nthe caustic is empty: no shape is a caster"), std::string::npos)
        << empty.err;
    EXPECT_EQ(read_exr(file).metadata.at("why_empty").find("no shape is a caster"), 0U);
}

TEST(Render, MakesThePictureOfATimeAgainByTheCommandThatItTells) {
    const support::TemporaryFolder folder;
    const std::string timed = folder / "timed.exr", again = folder / "again.exr";
    for (const std::string method : {"photonmap", "lighttrace", "beamtree", "causticpolygons"}) {
        const ProgramResult result = causticbench(
            {"render", scene_of_ball, "--method", method, "--seconds", "1", "-o", timed});
        ASSERT_EQ(result.exit_code, 0) << result.err;
        const std::string words = "the same picture again: causticbench render ";
        const std::size_t told = result.err.find(words);
        ASSERT_NE(told, std::string::npos) << result.err;
        const std::string command = result.err.substr(told + words.size());
        const ProgramResult second = support::shell(
            "$P render " + command.substr(0, command.find('\n')) + " -o '" + again + "' 2>&1");
        ASSERT_EQ(second.exit_code, 0) << second.out;
        EXPECT_TRUE(read_input(timed) == read_input(again)) << method;
    }
}

// With 64 samples a pixel, 1 to 64 paths a pixel make the same picture: each sample has one path.
TEST(Render, GoesOnWhereSamplesHaveAPathEachAnyway) {
    const support::TemporaryFolder folder;
    const ProgramResult result =
        causticbench({"render", CAUSTICS_SOURCE_DIR "/experiments/scenes/ring_area.json", "--set",
                      "/sensor/film/width=4", "--set", "/sensor/film/height=3", "--spp", "64",
                      "--method", "pathtrace", "--seconds", "2", "-o", folder / "a.exr"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err.find("makes no difference"), std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("spp=64: "), 0U) << result.err;
    EXPECT_NE(result.err.find("\nspp=2048: "), std::string::npos) << result.err;
}

TEST(Render, RefusesATimeThatIsTooShortWithTheLeast) {
    const support::TemporaryFolder folder;
    const ProgramResult result =
        causticbench({"render", scene_of_ball, "--method", "photonmap", "--spp", "2500",
                      "--seconds", "0.01", "-o", folder / "a.exr"});
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
    const std::string words = "--seconds 0.01: the least that this picture takes is about ";
    const std::size_t told = result.err.find(words);
    ASSERT_NE(told, std::string::npos) << result.err;
    const std::string rest = result.err.substr(told + words.size());
    const std::string least = rest.substr(0, rest.find(' '));
    EXPECT_NE(rest.find(" for loading (give --seconds " + least + " or more)"), std::string::npos)
        << result.err;
    EXPECT_FALSE(fs::exists(folder / "a.exr"));
}

// Beams carry all the light of a ball.
TEST(Render, GivesTheTimeOfBeamsToTheMeshesOfExactCasters) {
    const support::TemporaryFolder folder;
    const ProgramResult result = causticbench({"render", scene_of_ball, "--method", "beamtree",
                                               "--seconds", "2", "-o", folder / "a.exr"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err.find("pencils=20000: "), 0U) << result.err;
    EXPECT_NE(result.err.find("\nmesh_resolution=8: "), std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("makes no difference"), std::string::npos) << result.err;
}

TEST(Render, GivesTheTimeToANumberOfTheScene) {
    const support::TemporaryFolder folder;
    const std::string pool = CAUSTICS_SOURCE_DIR "/experiments/scenes/pool.json";
    const ProgramResult by_mesh =
        causticbench({"render", pool, "--method", "beamtree", "--param", "rest=max_beams",
                      "--seconds", "1e4", "-o", folder / "a.exr"});
    EXPECT_EQ(by_mesh.exit_code, 0) << by_mesh.err;
    EXPECT_NE(by_mesh.err.find("note: mesh_resolution makes no difference here, so that the "
                               "picture does not take the 10000 s of --seconds"),
              std::string::npos)
        << by_mesh.err;
    const ProgramResult by_scene =
        causticbench({"render", pool, "--method", "beamtree", "--seconds", "2", "--work",
                      "/water/resolution", "-o", folder / "b.exr"});
    EXPECT_EQ(by_scene.exit_code, 0) << by_scene.err;
    EXPECT_EQ(by_scene.err.find("/water/resolution=8"), 0U) << by_scene.err;
    EXPECT_NE(read_exr(folder / "b.exr").metadata.at("command").find("--set /water/resolution="),
              std::string::npos);
}

TEST(Render, RefusesATimeThatNothingCouldTake) {
    const support::TemporaryFolder folder;
    const auto error = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), {"render", scene_of_ball, "-o", folder / "a.exr"});
        const ProgramResult result = causticbench(arguments);
        EXPECT_EQ(result.exit_code, 2) << result.err;
        return result.err;
    };
    EXPECT_NE(error({"--method", "none", "--seconds", "1"}).find("none has no parameter"),
              std::string::npos);
    EXPECT_NE(error({"--method", "photonmap", "--param", "photons=9", "--seconds", "1"})
                  .find("--seconds chooses photons: leave --param photons=9 out"),
              std::string::npos);
    EXPECT_NE(error({"--method", "photonmap", "--work", "/ball/radius"})
                  .find("--work: belongs to --seconds"),
              std::string::npos);
    const auto of_work = [&](const std::string& work) {
        return error({"--method", "photonmap", "--seconds", "1", "--work", work});
    };
    EXPECT_NE(
        of_work("/ball/radius").find("--work /ball/radius: holds 0.4, which is no whole number"),
        std::string::npos);
    EXPECT_NE(of_work("/ball").find("--work /ball: holds an object, which is no whole number"),
              std::string::npos);
    // One that is not there is set, and refused by the scene's reader where it has no such key.
    EXPECT_NE(of_work("/bal/radius").find("/bal/radius: there is nothing of that name"),
              std::string::npos);
    EXPECT_NE(of_work("/ball/rings").find("unknown key \"rings\""), std::string::npos);
    EXPECT_NE(error({"--method", "photonmap", "--seconds", "0"}).find("--seconds \"0\""),
              std::string::npos);
    EXPECT_FALSE(fs::exists(folder / "a.exr"));
}

TEST(Info, TellsWhatTheSceneHolds) {
    const ProgramResult result = causticbench({"info", scene_of_ball, "--quick"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    for (const char* word :
         {"exact sphere", "caster", "receiver", "point at", "16 x 12", "photonmap        yes\n",
          "pathtrace        no: ",
          "beamtree         yes, by beams of up to 16 events with 100.0 % of the caustic"})
        EXPECT_NE(result.out.find(word), std::string::npos) << word << "\n" << result.out;
}

TEST(Info, ForetellsWhatEachMethodTakes) {
    const ProgramResult result = causticbench({"info", scene_of_ball});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const std::regex cost("yes, (at least )?[0-9.e+]+ CPU s and [0-9]+ MB");
    int methods = 0;
    for (const std::string& line : lines(result.out)) {
        if (line.find(" yes") == std::string::npos) continue;
        EXPECT_TRUE(std::regex_search(line, cost)) << line;
        ++methods;
    }
    EXPECT_EQ(methods, 6) << result.out;
}

TEST(Info, DrawsBeams) {
    const support::TemporaryFolder folder;
    const std::string drawing = folder / "beams.png";
    const ProgramResult result = causticbench(
        {"info", scene_of_ball, "--beams", "--param", "mesh_resolution=8", "-o", drawing});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.out.find("exact sphere"), std::string::npos);
    EXPECT_TRUE(fs::exists(drawing));
}

TEST(PhotonMaps, AreSavedLoadedDescribedAndDrawn) {
    const support::TemporaryFolder folder;
    const std::string map = folder / "ball.photons";
    for (const auto& [param, picture] :
         {std::pair("save=" + map, "traced.exr"), std::pair("load=" + map, "loaded.exr")}) {
        std::vector<std::string> arguments = {"render",  scene_of_ball,   "--method", "photonmap",
                                              "--param", param,           "--param",  "nearest=20",
                                              "-o",      folder / picture};
        if (param[0] == 's') arguments.insert(arguments.end(), {"--param", "photons=1000"});
        ASSERT_EQ(causticbench(arguments).exit_code, 0) << param;
    }
    const Film traced = read_exr(folder / "traced.exr"), loaded = read_exr(folder / "loaded.exr");
    for (std::size_t i = 0; i < traced.pixel_count(); ++i)
        EXPECT_TRUE((traced.rgb("", i) == loaded.rgb("", i)).all());
    EXPECT_EQ(loaded.metadata.at("load_hash").size(), 16U);

    const std::string drawing = folder / "photons.png";
    const ProgramResult info = causticbench({"info", map, "--scene", scene_of_ball, "-o", drawing});
    EXPECT_EQ(info.exit_code, 0) << info.err;
    for (const char* word : {"format version 4", "1000 stored", "seed 1", "param photons=1000"})
        EXPECT_NE(info.out.find(word), std::string::npos) << word << "\n" << info.out;
    EXPECT_TRUE(fs::exists(drawing));
}

TEST(Probe, KeepsTheRowsAndAddsItsAnswers) {
    const support::TemporaryFolder folder;
    const std::string points = folder / "points.csv";
    write_atomic_file(points,
                      "radius,x,y,z,nx,ny,nz,wx,wy,wz\n"
                      "0.1,0,0,0,0,0,2,0,0,1\n"
                      "0.1,0,0,0,0,0,-1,0,0,-1\n");
    const ProgramResult result = causticbench({"probe", scene_of_ball, "--method", "lighttrace",
                                               "--param", "paths=20000", "--points", points});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const std::vector<std::string> table = lines(result.out);
    ASSERT_EQ(table.size(), 3U);
    EXPECT_EQ(table[0],
              "radius,x,y,z,nx,ny,nz,wx,wy,wz,irradiance_r,irradiance_g,irradiance_b,"
              "radiance_r,radiance_g,radiance_b,stderr_r,stderr_g,stderr_b,"
              "stderr_radiance_r,stderr_radiance_g,stderr_radiance_b");
    const std::string first = "0.1,0,0,0,0,0,2,0,0,1,";
    ASSERT_EQ(table[1].substr(0, first.size()), first);
    const double irradiance = std::stod(table[1].substr(first.size()));
    EXPECT_GT(irradiance, 0);
    EXPECT_EQ(table[2], "0.1,0,0,0,0,0,-1,0,0,-1,0,0,0,0,0,0,0,0,0,0,0,0")
        << "the back of a one-sided floor is black";
}

TEST(Probe, ReadsPointsFromStandardInputAndWritesToStandardOutput) {
    const support::TemporaryFolder folder;
    write_atomic_file(folder / "points.csv", "x,y,z,nx,ny,nz\n0,0,0,0,0,1\n");
    const ProgramResult result = support::causticbench_reading(
        folder / "points.csv",
        {"probe", scene_of_ball, "--method", "none", "--points", "-", "-o", "-"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.out,
              "x,y,z,nx,ny,nz,irradiance_r,irradiance_g,irradiance_b\n0,0,0,0,0,1,0,0,0\n");
    const ProgramResult empty = support::causticbench_reading(
        "/dev/zero", {"probe", scene_of_ball, "--method", "none", "--points", "-"});
    EXPECT_EQ(empty.exit_code, 2);
    EXPECT_EQ(empty.err,
              "causticbench: error: standard input: cannot be read (neither a file nor a pipe)\n");
    write_atomic_file(folder / "half.csv", "x,y,z,nx,ny,nz,wz\n0,0,0,0,0,1,1\n");
    const ProgramResult half = support::causticbench_reading(
        folder / "half.csv", {"probe", scene_of_ball, "--method", "none", "--points", "-"});
    EXPECT_EQ(half.exit_code, 2);
    EXPECT_EQ(half.err,
              "causticbench: error: standard input: give all of the columns wx, wy, wz or none\n");
}

// Light along a diagonal starts outside of the scene's bounds, where Embree must still take it.
TEST(Render, FollowsLightToTheFarthestCoordinates) {
    const support::TemporaryFolder folder;
    const std::string file = folder / "far.json";
    write_atomic_file(file, R"({
        "sensor": {"type": "perspective",
            "to_world": [{"look_at": {"origin": [0, -4e17, 4e17], "target": [0, 0, 0], "up": [0, 0, 1]}}],
            "film": {"type": "hdrfilm", "width": 4, "height": 3}},
        "sun": {"type": "directional", "direction": [-1, -1, -1], "irradiance": 1e-3},
        "ball": {"type": "sphere", "to_world": [{"scale": 5e17}], "bsdf": {"type": "dielectric"}},
        "floor": {"type": "rectangle", "to_world": [{"scale": 5e17}]}})");
    for (const std::string emission : {"random", "stratified"}) {
        const ProgramResult result =
            causticbench({"render", file, "--method", "photonmap", "--param", "photons=200",
                          "--param", "emission=" + emission, "--spp", "1", "-o", folder / "a.exr"});
        EXPECT_EQ(result.exit_code, 0) << result.err;
    }
}

// Every method that can serve it, on every scene whose answer is known.
TEST(Verify, TheGalleryHolds) {
    const ProgramResult result = causticbench({"verify", "--gallery"});
    EXPECT_EQ(result.exit_code, 0) << result.out;
    for (const std::string method :
         {"photonmap", "lighttrace", "pathtrace", "beamtree", "causticpolygons", "illuminationmap",
          "lighttrace, indirect", "pathtrace, indirect"})
        EXPECT_NE(result.out.find("| " + method + " |"), std::string::npos) << method;
}

// A mirror over the floor, whose light has no bright edges.
const std::string scene_of_mirror = CAUSTICS_SOURCE_DIR "/tests/experiments/scenes/mirror.json";

TEST(Verify, ASceneHoldsAndSaysWhatWasChecked) {
    const ProgramResult result = causticbench({"verify", scene_of_mirror, "--method", "beamtree"});
    EXPECT_EQ(result.exit_code, 0) << result.out;
    for (const std::string what :
         {"holds     light: ", "caustic: casters", "holds     threads: beamtree",
          "light of beamtree ", "sent ", " W = arrived ",
          "holds     against the reference: beamtree", "verify: all holds"})
        EXPECT_NE(result.out.find(what), std::string::npos) << what << "\n" << result.out;
}

// By eq. 4 as printed five photons bring 5 / 4 of the light, however many there are in all.
TEST(Verify, AMethodWithTheWrongSumFails) {
    const ProgramResult result = causticbench({"verify", scene_of_mirror, "--method", "photonmap",
                                               "--param", "estimator=raw", "--param", "nearest=5",
                                               "--param", "photons=2000", "--allow-converging"});
    EXPECT_EQ(result.exit_code, 1) << result.out;
    for (const std::string what :
         {"fails     against the reference: photonmap", "with photons=8000", "with photons=32000",
          "whole picture: order", "verify: not all holds: 1 fails"})
        EXPECT_NE(result.out.find(what), std::string::npos) << what << "\n" << result.out;
}

TEST(Verify, IsUnsureWhereTheErrorIsTooLargeWhenTheTimeIsOver) {
    const ProgramResult result =
        causticbench({"verify", scene_of_ball, "--method", "photonmap", "--param", "photons=300",
                      "--seconds", "0", "--allow-converging"});
    EXPECT_EQ(result.exit_code, 1) << result.out;
    for (const std::string what : {"unsure    against the reference: photonmap",
                                   "the standard error is above 0.4 %", "seeds of the method"})
        EXPECT_NE(result.out.find(what), std::string::npos) << what << "\n" << result.out;
}

TEST(Verify, TellsWhyThereIsNoCaustic) {
    const ProgramResult result = causticbench(
        {"verify", scene_of_ball, "--method", "photonmap", "--set", "/light/intensity=0"});
    EXPECT_NE(result.out.find("no caustic: "), std::string::npos) << result.out << result.err;
}

TEST(Verify, WantsASceneOrTheGallery) {
    EXPECT_EQ(causticbench({"verify"}).exit_code, 2);
    EXPECT_EQ(causticbench({"verify", scene_of_ball, "--gallery"}).exit_code, 2);
    EXPECT_EQ(causticbench({"verify", scene_of_ball, "--method", "photonmaps"}).exit_code, 2);
    EXPECT_EQ(causticbench({"verify", scene_of_ball, "--method", "none"}).exit_code, 2);
    const ProgramResult unserved = causticbench({"verify", scene_of_ball, "--method", "pathtrace"});
    EXPECT_EQ(unserved.exit_code, 3) << "of what cannot serve the scene nothing is checked";
    EXPECT_NE(unserved.err.find("point light"), std::string::npos) << unserved.err;
}

}  // namespace
}  // namespace caustics::experiments
