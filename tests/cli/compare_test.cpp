#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/render/film.h"
#include "tests/cli/program.h"
#include "tests/support/temporary_folder.h"

namespace caustics::experiments {
namespace {

using support::causticbench;
using support::ProgramResult;
namespace fs = std::filesystem;

const std::string ball_scene = CAUSTICS_SOURCE_DIR "/tests/experiments/scenes/ball.json";

class Compare : public testing::Test {
protected:
    std::string render(const std::string& name, const std::vector<std::string>& more = {}) const {
        const std::string file = folder_ / name;
        std::vector<std::string> arguments = {"render",  ball_scene,    "--method", "photonmap",
                                              "--param", "photons=500", "-o",       file};
        arguments.insert(arguments.end(), more.begin(), more.end());
        EXPECT_EQ(causticbench(arguments).exit_code, 0);
        return file;
    }
    support::TemporaryFolder folder_;
};

TEST_F(Compare, FindsAPictureEqualToItself) {
    const std::string file = render("a.exr");
    const std::string strip = folder_ / "strip.png";
    const ProgramResult result = causticbench({"compare", file, file, "--json", "--strip", strip});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const nlohmann::json json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json.at("layer"), "caustic");
    EXPECT_EQ(json.at("metrics").at("rmse"), 0);
    EXPECT_EQ(json.at("mask_metrics").at("mean_ratio"), 1);
    EXPECT_GT(json.at("mask_fraction"), 0);
    EXPECT_TRUE(fs::exists(strip));
    EXPECT_NE(causticbench({"compare", file, file}).out.find("0.01 mean(r)^2"), std::string::npos);
}

TEST_F(Compare, JudgesByAnotherProgramsPicture) {
    const std::string picture = render("a.exr");
    const Film film = read_exr(picture);
    Film plain(film.width(), film.height());
    for (std::size_t i = 0; i < plain.pixel_count(); ++i) plain.set_rgb("", i, film.rgb("", i));
    const std::string reference = folder_ / "plain.exr";
    write_exr(plain, reference);
    const ProgramResult result = causticbench({"compare", picture, reference, "--json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "") << "nothing is known of its light";
    const nlohmann::json json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json.at("layer"), "beauty");
    EXPECT_EQ(json.at("metrics").at("rmse"), 0);
    EXPECT_TRUE(json.at("reference_stderr").is_null());
    EXPECT_EQ(causticbench({"compare", picture, reference}).exit_code, 0);
}

TEST_F(Compare, NamesTheLayersThatBothPicturesHave) {
    const std::string picture = render("a.exr");
    Film few(16, 12);
    few.set_rgb("", 0, Spectrum::Ones());
    few.set_rgb("caustic", 0, Spectrum::Ones());
    few.set_rgb("foo", 0, Spectrum::Ones());
    const std::string other = folder_ / "few.exr";
    write_exr(few, other);
    const ProgramResult result = causticbench({"compare", picture, other, "--layer", "foo"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(
        result.err.find("a.exr: has no layer \"foo\" (both pictures have: beauty, caustic)\n"),
        std::string::npos)
        << result.err;
}

TEST_F(Compare, NamesThePictureThatIsNotFinite) {
    const std::string good = render("a.exr");
    Film film = read_exr(good);
    film.plane("caustic.G")[17] = std::nanf("");
    const std::string broken = folder_ / "nan.exr";
    write_exr(film, broken);
    const std::string why = "nan.exr: layer \"caustic\" is not finite at pixel (1, 1)";
    for (const auto& files : {std::pair(good, broken), std::pair(broken, good)}) {
        const ProgramResult result = causticbench({"compare", files.first, files.second});
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_NE(result.err.find(why), std::string::npos) << result.err;
    }
    const ProgramResult mask = causticbench({"compare", good, good, "--mask", broken});
    EXPECT_EQ(mask.exit_code, 2);
    EXPECT_NE(mask.err.find("nan.exr: the mask is not finite"), std::string::npos) << mask.err;
}

TEST_F(Compare, NamesAPictureOfLuminanceAlone) {
    const std::string picture = render("a.exr");
    Film grey(read_exr(picture).width(), read_exr(picture).height());
    grey.plane("Y");
    const std::string reference = folder_ / "grey.exr";
    write_exr(grey, reference);
    for (const auto& files : {std::pair(picture, reference), std::pair(reference, picture)}) {
        const ProgramResult result = causticbench({"compare", files.first, files.second});
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_NE(result.err.find("grey.exr: has no channels R, G and B to judge, but Y"),
                  std::string::npos)
            << result.err;
    }
}

TEST_F(Compare, NamesBothPicturesWhoseSizesDiffer) {
    const std::string picture = render("a.exr");
    const std::string reference = render("b.exr", {"--set", "/sensor/film/width=8"});
    const ProgramResult result = causticbench({"compare", picture, reference});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.err, fmt::format("causticbench: error: {} has 16x12 pixels, {} has 8x12\n",
                                      picture, reference));
}

TEST_F(Compare, RefusesToneMappedPictures) {
    const std::string tone_mapped = render("a.png");
    const std::string picture = render("a.exr");
    for (const auto& files : {std::pair(picture, tone_mapped), std::pair(tone_mapped, picture)}) {
        const ProgramResult result = causticbench({"compare", files.first, files.second});
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_NE(result.err.find("a.png: cannot be read (holds png values, not radiance"),
                  std::string::npos)
            << result.err;
    }
}

TEST_F(Compare, SaysWhereTheLightDiffers) {
    const std::string picture = render("a.exr");
    const std::string other =
        render("b.exr", {"--param", "max_bounces=1", "--set", "/floor/bsdf/reflectance=0.25"});
    const ProgramResult text = causticbench({"compare", picture, other});
    EXPECT_EQ(text.exit_code, 0);
    EXPECT_EQ(text.err,
              "note: the two pictures ask for different light: max_bounces: 1000 against 1, "
              "/floor/bsdf/reflectance: 0.5 against 0.25\n");
    EXPECT_NE(text.out.find("  rmse "), std::string::npos) << text.out;
    const nlohmann::json json =
        nlohmann::json::parse(causticbench({"compare", picture, other, "--json"}).out);
    EXPECT_EQ(json.at("light_differences").size(), 2U);
    const double rmse = json.at("metrics").at("rmse");
    EXPECT_NE(text.out.find(fmt::format("  {:<12} {:.4g} W/(m^2 sr)\n", "rmse", rmse)),
              std::string::npos)
        << "four digits as text, and all of " << rmse << "\n"
        << text.out;
}

}  // namespace
}  // namespace caustics::experiments
