#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>

#include "experiments/base/file_io.h"
#include "tests/cli/program.h"
#include "tests/support/temporary_folder.h"

namespace caustics::experiments {
namespace {

const std::string good_scene = CAUSTICS_SOURCE_DIR "/tests/experiments/scenes/ball.json";

/// A command line or scene that cannot be used. "SCENE" stands for the good scene, "BROKEN" for a
/// file with `text`, "DIR" for a folder of the test's own.
struct Broken {
    const char* name;
    std::vector<std::string> arguments;
    std::vector<std::string> words;  ///< that the message must have
    std::string text = {};
    int exit_code = 2;

    friend std::ostream& operator<<(std::ostream& out, const Broken& broken) {
        return out << broken.name;
    }
};

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    const std::size_t at = text.find(what);
    return at == std::string::npos ? text : text.replace(at, what.size(), by);
}

/// The good scene with one thing replaced.
std::string scene_with(const std::string& what, const std::string& by) {
    const std::string text = read_whole_file(good_scene);
    EXPECT_NE(text.find(what), std::string::npos) << what;
    return replaced(text, what, by);
}

const std::vector<std::string> render_broken = {"render", "BROKEN", "--method",
                                                "none",   "-o",     "DIR/a.exr"};

std::vector<std::string> render_good(const std::vector<std::string>& more) {
    std::vector<std::string> all = {"render", "SCENE", "-o", "DIR/a.exr"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
}

std::vector<std::string> probe_with(const std::string& method) {
    return {"probe", "SCENE", "--method", method, "--points", "BROKEN"};
}

const std::vector<Broken> broken_scenes = {
    {"NotJson", render_broken, {"broken.json"}, "{\"type\": "},
    {"NulBehindTheScene",
     render_broken,
     {"broken.json", "is NUL", "UTF-8"},
     read_whole_file(good_scene) + '\0' + "more"},
    {"UnknownKey", render_broken, {"/ball/bsdf", "iro", "int_ior"}, scene_with("int_ior", "iro")},
    {"MisspeltKey",
     render_broken,
     {"/ball/bsdf: unknown key \"int_iro\": did you mean int_ior? (known: "},
     scene_with("int_ior", "int_iro")},
    {"UnknownType",
     render_broken,
     {"/ball/bsdf", "glas", "dielectric"},
     scene_with("dielectric", "glas")},
    {"MisspeltType",
     render_broken,
     {"/ball/bsdf", "\"dielectrc\" is unknown: did you mean dielectric? (known: "},
     scene_with("dielectric", "dielectrc")},
    {"WrongType", render_broken, {"/ball/radius", "number"}, scene_with("0.4", "\"big\"")},
    {"NegativeRadius", render_broken, {"/ball/radius"}, scene_with("0.4", "-0.4")},
    {"MissingKey", render_broken, {"/light", "type"}, scene_with("\"type\": \"point\", ", "")},
    {"MissingMesh",
     render_broken,
     {"absent.ply"},
     scene_with(R"("type": "sphere",
    "center": [0, 0, 0.6],
    "radius": 0.4,)",
                R"("type": "ply", "filename": "absent.ply",)")},
    {"MissingInclude",
     render_broken,
     {"absent.json"},
     scene_with(R"({"type": "diffuse", "reflectance": 0.5})", R"({"$include": "absent.json"})")},
    {"DuplicateKey",
     render_broken,
     {"type"},
     scene_with(R"("type": "point",)", R"("type": "point", "type": "point",)")},
    {"ShortVector", render_broken, {"/light/position"}, scene_with("[0.5, 0.5, 3]", "[0.5, 3]")},
    {"WrongVersion", render_broken, {"/version"}, scene_with("\"version\": 1", "\"version\": 9")},
    {"ReflectanceAboveOne",
     render_broken,
     {"/floor/bsdf/reflectance"},
     scene_with("\"reflectance\": 0.5", "\"reflectance\": 1.5")},
    {"ForeignFilter",
     render_broken,
     {"/sensor/film/rfilter", "box"},
     scene_with("\"box\"", "\"gaussian\"")},
    {"NotSquareSamples",
     render_broken,
     {"5 is no square number", "4 or 9"},
     scene_with("\"sample_count\": 4", "\"sample_count\": 5")},
};

const std::vector<Broken> broken_commands = {
    {"EmptyFolder", {"merge", "", "-o", "DIR/out"}, {"DIR \"\"", "empty word"}},
    {"NoVerb", {}, {"no verb", "render, probe, sweep, compare, info"}},
    {"UnknownVerb",
     {"rendr", "SCENE"},
     {"unknown verb \"rendr\": did you mean render? (known: render, probe"}},
    {"BeamsWithoutPicture", {"info", "SCENE", "--beams"}, {"--beams and -o"}},
    {"DotsOfAScene", {"info", "SCENE", "--dot", "3"}, {"--dot", "photon map"}},
    {"SetOfTheGallery", {"verify", "--gallery", "--set", "/ball/radius=1"}, {"--set", "--gallery"}},
    {"ParameterOfNoMethodToVerify",
     {"verify", "SCENE", "--param", "nearest=3"},
     {"--param", "--method"}},
    {"SamplesOfTheGallery", {"verify", "--gallery", "--spp", "4"}, {"--spp", "--gallery"}},
    {"MethodWithoutKnownAnswers", {"verify", "--gallery", "--method", "none"}, {"none", "answer"}},
    {"MethodWithoutKnownAnswersBesideOthers",
     {"verify", "--gallery", "--method", "pathtrace", "--method", "none"},
     {"--method none", "answer"}},
    {"NoMethodToVerifyBesideOthers",
     {"verify", "SCENE", "--method", "photonmap", "--method", "none"},
     {"--method none", "no caustic"}},
    {"StripAsExr",
     {"compare", "a.exr", "b.exr", "--strip", "DIR/strip.exr"},
     {"strip.exr", ".png"}},
    {"OnePlaceForTwoPictures",
     render_good({"--method", "none", "-o", "DIR/./a.exr"}),
     {"a.exr", "by -o and by -o"}},
    {"OnePlaceForAPictureAndAMap",
     render_good({"--method", "photonmap", "--param", "save=DIR/a.exr"}),
     {"a.exr", "by -o and by --param save"}},
    {"OnePlaceForTwoMaps",
     render_good({"--method", "photonmap", "--param", "save=DIR/m", "--indirect", "globalphotonmap",
                  "--indirect-param", "save=DIR/m"}),
     {"by --param save and by --indirect-param save"}},
    {"OnePlaceForATableAndAMap",
     {"probe", "SCENE", "--method", "photonmap", "--param", "save=DIR/m", "--points", "BROKEN",
      "-o", "DIR/m"},
     {"by -o and by --param save"}},
    {"TwoLayersOfAProbe",
     {"probe", "SCENE", "--layer", "indirect", "--indirect", "pathtrace", "--method", "beamtree",
      "--points", "BROKEN"},
     {"--method", "one layer"}},
    {"InfoOfAPng",
     {"info", "BROKEN"},
     {"broken.json", "is a picture", "scenes", "photon maps"},
     "\x89PNG\r\n\x1a\n"},
    {"InfoOfAnExr",
     {"info", "BROKEN"},
     {"broken.json", "is a picture", "scenes", "photon maps"},
     std::string("\x76\x2f\x31\x01\x02\0\0\0", 8)},
    {"HelpOfAWord",
     {"help", "bsdf"},
     {"unknown topic \"bsdf\" (known: ",
      "scene, sweep, records, indirect, render, probe, compare, "}},
    {"HelpOfAMisspeltMethod", {"help", "beamtre"}, {"\"beamtre\": did you mean beamtree? ("}},
    {"HelpOfAMisspeltVerb", {"help", "rendr"}, {"\"rendr\": did you mean render? ("}},
    {"BeamsAsExr", {"info", "SCENE", "--beams", "-o", "beams.exr"}, {"beams.exr", ".png"}},
    {"UnknownOption",
     render_good({"--metod", "none"}),
     {"unknown option --metod: did you mean --method? (known: "}},
    {"ParameterAsAnOption",
     render_good({"--method", "photonmap", "--photons", "1000"}),
     {"--photons: photons is a parameter of photonmap, given as --param photons=1000 (known: "}},
    {"ParameterAsAnOptionWithEquals",
     render_good({"--method", "beamtree", "--mesh-resolution=64"}),
     {"a parameter of beamtree, given as --param mesh_resolution=64 ("}},
    {"MisspeltParameterAsAnOption",
     render_good({"--method", "photonmap", "--nearst", "50"}),
     {"unknown option --nearst: did you mean --param nearest=50? ("}},
    {"ParameterAsAnOptionOfASweep",
     {"sweep", "BROKEN", "-o", "DIR", "--photons", "1000"},
     {"\"param\": {\"photons\": 1000} in the sweep file"}},
    {"ParameterAsAnOptionWithoutValue",
     {"compare", "a.exr", "b.exr", "--photons"},
     {"--param photons=VALUE of render"}},
    {"MissingMethod", render_good({}), {"--method"}},
    {"UnknownMethod", render_good({"--method", "photons"}), {"photons", "photonmap"}},
    {"UnknownParameter",
     render_good({"--method", "photonmap", "--param", "photns=5"}),
     {"unknown key \"photns\": did you mean photons? (known: "}},
    {"ParameterWithoutValue",
     render_good({"--method", "none", "--param", "photons"}),
     {"key=value"}},
    {"ParameterOutOfRange",
     render_good({"--method", "photonmap", "--param", "nearest=-1"}),
     {"/nearest"}},
    {"NoSuchScene",
     {"render", "absent.json", "--method", "none", "-o", "DIR/a.exr"},
     {"absent.json"}},
    {"SetIntoNothing", render_good({"--method", "none", "--set", "/bal/radius=1"}), {"/bal"}},
    {"SetWithoutValue",
     render_good({"--method", "none", "--set", "/ball/radius"}),
     {"/json/pointer=value"}},
    {"SetTwice",
     render_good({"--method", "none", "--set", "/ball/radius=0.3", "--set", "/ball/radius=0.2"}),
     {"--set \"/ball/radius=0.2\"", "takes the place of --set \"/ball/radius=0.3\""}},
    {"SetAValueThenItsObject",
     render_good({"--method", "none", "--set", "/ball/bsdf/int_ior=1.3", "--set",
                  R"(/ball/bsdf={"type": "dielectric"})"}),
     {"takes the place of --set \"/ball/bsdf/int_ior=1.3\""}},
    {"UnknownPicture",
     {"render", "SCENE", "--method", "none", "-o", "DIR/a.jpg"},
     {".jpg", ".exr, .png"}},
    {"NoSuchFolder",
     {"render", "SCENE", "--method", "none", "-o", "DIR/absent/a.exr"},
     {"absent", "does not exist"}},
    {"SamplesNotSquare", render_good({"--method", "none", "--spp", "5"}), {"--spp 5", "n^2"}},
    {"SamplesNotPositive", render_good({"--method", "none", "--spp", "0"}), {"--spp"}},
    {"UnknownInstructionSet",
     render_good({"--method", "none", "--isa", "avx3"}),
     {"\"avx3\"", "known: plain"}},
    {"SeedNotNumber", render_good({"--method", "none", "--seed", "x"}), {"--seed"}},
    {"PathTraceWithPointLight",
     render_good({"--method", "pathtrace"}),
     {"point", "lighttrace"},
     {},
     3},
    {"IlluminationMapOfAGlossyFloor",
     render_good({"--method", "illuminationmap", "--set",
                  R"(/floor/bsdf={"type": "schlick", "alpha": 0.1})"}),
     {"\"floor\"", "diffuse", "photonmap"},
     {},
     3},
    {"IlluminationMapOfACube",
     render_good({"--method", "illuminationmap", "--set", "/floor/type=cube"}),
     {"\"floor\"", "texture coordinates that overlap"},
     {},
     3},
    {"ProbeWithoutRadius",
     probe_with("lighttrace"),
     {"row 1", "radius"},
     "x,y,z,nx,ny,nz\n0,0,0,0,0,1\n"},
    {"ProbeOfTheIndirectLayerWithoutRadius",
     {"probe", "SCENE", "--layer", "indirect", "--indirect", "lighttrace", "--points", "BROKEN"},
     {"row 1", "--indirect-param radius=metres"},
     "x,y,z,nx,ny,nz\n0,0,0,0,0,1\n"},
    {"ProbeFarFromReceivers",
     probe_with("none"),
     {"row 2", "receiver"},
     "x,y,z,nx,ny,nz\n0,0,0,0,0,1\n0,0,0.2,0,0,1\n"},
    {"ProbeZeroNormal",
     probe_with("none"),
     {"row 1", "normal is zero"},
     "x,y,z,nx,ny,nz\n0,0,0,0,0,0\n"},
    {"ProbeOfPixels",
     {"probe", "SCENE", "--method", "beamtree", "--param", "rest=max_beams", "--param",
      "pixel_footprint=true", "--points", "BROKEN"},
     {"beamtree: pixel_footprint", "points have none"},
     "x,y,z,nx,ny,nz\n0,0,0,0,0,1\n"},
    {"ProbeNaN", probe_with("none"), {"row 1", "x"}, "x,y,z,nx,ny,nz\nnan,0,0,0,0,1\n"},
    {"ProbeUnknownColumn", probe_with("none"), {"\"w\"", "wx"}, "x,y,z,nx,ny,nz,w\n"},
    {"ProbeHalfAViewer", probe_with("none"), {"wx, wy, wz"}, "x,y,z,nx,ny,nz,wx\n0,0,0,0,0,1,0\n"},
    {"CompareMissingFile", {"compare", "absent.exr", "absent.exr"}, {"absent.exr"}},
    {"CompareNotAPicture", {"compare", "BROKEN", "BROKEN"}, {"broken"}, "no picture"},
    {"SceneIsADevice", {"info", "/dev/zero"}, {"/dev/zero", "not a regular file"}},
    {"SweepIsADevice",
     {"sweep", "/dev/zero", "-o", "DIR/out"},
     {"/dev/zero", "not a regular file"}},
    {"PhotonMapIsADevice",
     render_good({"--method", "photonmap", "--param", "load=/dev/zero"}),
     {"/dev/zero", "not a regular file"}},
    {"PointsAreADevice",
     {"probe", "SCENE", "--method", "none", "--points", "/dev/zero"},
     {"/dev/zero", "neither a file nor a pipe"}},
    {"PictureOntoADevice",
     {"probe", "SCENE", "--method", "none", "--points", "BROKEN", "-o", "/dev/null"},
     {"/dev/null", "no regular file"}},
    {"PictureToAPipe",
     {"render", "SCENE", "--method", "none", "-o", "-"},
     {"standard output", ".exr, .png"}},
    {"ScaledTooFar",
     render_good({"--method", "none", "--set", R"(/floor/to_world=[{"scale": 1e19}])"}),
     {"/floor", "5e+17 m"}},
    {"ProbeTooFar", probe_with("none"), {"row 1", "5e+17 m"}, "x,y,z,nx,ny,nz\n1e19,0,0,0,0,1\n"},
    {"NegativeSeed", render_good({"--method", "none", "--seed", "-1"}), {"--seed \"-1\""}},
    {"TimeoutNaN",
     {"sweep", "BROKEN", "-o", "DIR/out", "--timeout", "nan"},
     {"--timeout \"nan\"", "from 0.001 to"}},
    {"NotUtf8", {"info", "\xff.json"}, {"?.json", "UTF-8"}},
    {"ControlCharacters", {"info", "\x1b[2J"}, {"?[2J", "no such file"}},
    {"LongWord", {"info", std::string(5000, 'x')}, {"xxx...xxx"}},
    {"EmptyTrial", {"explain", "DIR", ""}, {"TRIAL \"\"", "empty word"}},
    {"EmptyStrip", {"compare", "a.exr", "b.exr", "--strip", ""}, {"--strip \"\"", "FILE"}},
    {"EmptyLayer", {"compare", "a.exr", "b.exr", "--layer", ""}, {"--layer \"\"", "NAME"}},
    {"EmptyShard", {"sweep", "BROKEN", "-o", "DIR/out", "--shard", ""}, {"--shard \"\"", "I/N"}},
    {"EmptyDrawing", {"info", "SCENE", "-o", ""}, {"--output \"\"", "FILE"}},
    {"EmptySceneOfAMap", {"info", "SCENE", "--scene", ""}, {"--scene \"\"", "SCENE"}},
    {"EmptyTopic", {"help", ""}, {"TOPIC \"\"", "empty word"}},
    {"SweepOfManyThreads",
     {"sweep", "BROKEN", "-o", "DIR/out"},
     {"/threads", "4096"},
     R"({"version": 1, "scenes": ["broken.json"], "methods": [{"method": "none"}], "threads": 1000000000})"},
    {"SweepEmptyList",
     {"sweep", "BROKEN", "-o", "DIR/out"},
     {"/scenes", "empty"},
     R"({"version": 1, "scenes": [], "methods": [{"method": "none"}]})"},
    {"SweepUnknownReferenceMode",
     {"sweep", "BROKEN", "-o", "DIR/out", "--references", "remake"},
     {"keep", "rebuild"},
     "{}"},
};

class BrokenInput : public testing::TestWithParam<Broken> {};

TEST_P(BrokenInput, EndsInOneLine) {
    const Broken& broken = GetParam();
    const support::TemporaryFolder folder;
    const std::string file = folder / "broken.json";
    write_atomic_file(file, broken.text);
    std::vector<std::string> arguments = broken.arguments;
    for (std::string& argument : arguments) {
        if (argument == "SCENE") argument = good_scene;
        if (argument == "BROKEN") argument = file;
        argument = replaced(argument, "DIR", folder.path());
    }
    const support::ProgramResult result = support::causticbench(arguments);
    EXPECT_EQ(result.exit_code, broken.exit_code) << result.err;
    EXPECT_EQ(result.err.rfind("causticbench: error: ", 0), 0U) << result.err;
    EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
    EXPECT_EQ(result.err.find('\x1b'), std::string::npos);
    EXPECT_LT(result.err.size(), 2100U) << "no word is echoed whole";
    EXPECT_EQ(result.out, "");
    // The folder's name holds the case's and a number, which are not the program's words.
    const std::string message = replaced(result.err, folder.path(), "DIR");
    for (const std::string& word : broken.words)
        EXPECT_NE(message.find(word), std::string::npos) << word << " is not in " << message;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
        EXPECT_EQ(entry.path(), file) << "nothing is written";
}

std::string name_of(const testing::TestParamInfo<Broken>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Scenes, BrokenInput, testing::ValuesIn(broken_scenes), name_of);
INSTANTIATE_TEST_SUITE_P(Commands, BrokenInput, testing::ValuesIn(broken_commands), name_of);

}  // namespace
}  // namespace caustics::experiments
