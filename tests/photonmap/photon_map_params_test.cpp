#include <gtest/gtest.h>

#include <string>

#include "core/base/error.h"
#include "photonmap/photon_map_method.h"

namespace caustics::photonmap {
namespace {

PhotonMapParams params_of(const std::string& json) {
    return photonmap_method().read(JsonNode::parse_text(json, "params"));
}

/// The one line that refuses these parameters, or "" where they are taken.
std::string refusal_of_params(const std::string& json) {
    try {
        params_of(json);
        return "";
    } catch (const InputError& e) {
        return e.what();
    }
}

TEST(PhotonMapParams, AreReadWithTheirDefaultsInPlace) {
    const PhotonMapParams defaults = params_of("{}");
    EXPECT_EQ(defaults.photons, 100'000U);
    EXPECT_EQ(defaults.nearest, 50);
    const PhotonMapParams given = params_of(
        R"({"photons": 2000000000, "nearest": 1, "estimator": "raw", "max_radius": 0.25,
            "max_bounces": 4, "emission": "random", "interaction": "roulette",
            "tree": "balanced", "tables": true})");
    EXPECT_EQ(defaults.tree, TreeKind::packed);
    EXPECT_EQ(given.tree, TreeKind::balanced);
    EXPECT_EQ(given.photons, 2'000'000'000U);
    EXPECT_EQ(given.emitted, 0U);
    EXPECT_EQ(given.nearest, 1);
    EXPECT_EQ(given.estimator, PhotonMapParams::Estimator::raw);
    EXPECT_EQ(given.max_radius, 0.25);
    EXPECT_EQ(given.max_bounces, 4);
    EXPECT_TRUE(given.tables);
    EXPECT_FALSE(defaults.tables);
}

TEST(PhotonMapParams, ChooseTheKernelThatTheyNeed) {
    EXPECT_EQ(params_of("{}").kernel, KernelKind::photon);
    EXPECT_TRUE(params_of("{}").averages_pixels());
    EXPECT_FALSE(params_of(R"({"pixel_footprint": false})").averages_pixels());
    EXPECT_FALSE(params_of(R"({"footprint": 0.1})").averages_pixels());
    EXPECT_FALSE(params_of(R"({"kernel": "point"})").averages_pixels());
    EXPECT_EQ(params_of(R"({"preset": "jensen1996"})").kernel, KernelKind::point);
    for (const std::string key :
         {R"("tree": "balanced")", R"("tree": "unbalanced")", R"("adaptive": true)",
          R"("estimator": "raw")", R"("filter": "gaussian", "filter_alpha": 0.918)"}) {
        EXPECT_EQ(params_of("{" + key + "}").kernel, KernelKind::point) << key;
        const std::string line = refusal_of_params(R"({"kernel": "photon", )" + key + "}");
        EXPECT_NE(line.find("belongs to the kernel \"point\""), std::string::npos) << line;
    }
    EXPECT_NE(refusal_of_params(R"({"kernel": "photon", "preset": "jensen1996"})")
                  .find("/kernel: belongs to the kernel"),
              std::string::npos);
    for (const std::string other :
         {R"("kernel": "point")", R"("adaptive": true)", R"("footprint": 1)"})
        EXPECT_NE(refusal_of_params(R"({"pixel_footprint": true, )" + other + "}")
                      .find("/pixel_footprint"),
                  std::string::npos)
            << other;
}

TEST(PhotonMapParams, EmittedReplacesPhotons) {
    const PhotonMapParams given = params_of(R"({"emitted": 5000})");
    EXPECT_EQ(given.emitted, 5'000U);
    EXPECT_EQ(given.photons, 0U);
    EXPECT_NE(refusal_of_params(R"({"emitted": 5000, "photons": 10})").find("/emitted"),
              std::string::npos);
}

TEST(PhotonMapParams, ChooseTheEmissionAndTheInteraction) {
    EXPECT_EQ(params_of("{}").emission, PhotonMapParams::Emission::stratified);
    EXPECT_EQ(params_of(R"({"emission": "random"})").emission, PhotonMapParams::Emission::random);
    for (const std::string with_point :
         {R"("preset": "jensen1996")", R"("kernel": "point")", R"("tree": "balanced")"})
        EXPECT_EQ(params_of("{" + with_point + "}").emission, PhotonMapParams::Emission::random)
            << with_point;
    EXPECT_EQ(params_of("{}").interaction, Interaction::roulette);
    const PhotonMapParams given =
        params_of(R"({"emission": "stratified", "interaction": "split"})");
    EXPECT_EQ(given.emission, PhotonMapParams::Emission::stratified);
    EXPECT_EQ(given.interaction, Interaction::split);
    EXPECT_NE(refusal_of_params(R"({"emission": "regular"})").find("stratified"),
              std::string::npos);
}

TEST(PhotonMapParams, ChooseTheFilterAndARadiusInPlaceOfTheNearest) {
    EXPECT_EQ(params_of("{}").filter, FilterKind::epanechnikov);
    EXPECT_EQ(params_of(R"({"kernel": "point"})").filter, FilterKind::none);
    EXPECT_EQ(params_of(R"({"preset": "jensen1996"})").filter, FilterKind::none);
    EXPECT_EQ(params_of(R"({"adaptive": true})").filter, FilterKind::none);
    EXPECT_EQ(params_of(R"({"filter": "none"})").filter, FilterKind::none);
    EXPECT_EQ(params_of("{}").radius, 0);
    EXPECT_EQ(params_of(R"({"filter": "epanechnikov"})").filter, FilterKind::epanechnikov);
    EXPECT_EQ(params_of(R"({"filter": "cone", "radius": 0.5})").radius, 0.5);
    for (const std::string other : {R"("nearest": 50)", R"("max_radius": 1)"}) {
        const std::string line = refusal_of_params(R"({"radius": 0.1, )" + other + "}");
        EXPECT_NE(line.find("/radius"), std::string::npos) << line;
        EXPECT_NE(line.find("in place of the nearest"), std::string::npos) << line;
    }
}

// A number that would change nothing is refused rather than ignored.
TEST(PhotonMapParams, NumbersOfAFilterBelongToThatFilter) {
    EXPECT_EQ(params_of(R"({"filter": "cone", "filter_k": 1.5})").filter_k, 1.5);
    EXPECT_EQ(params_of(R"({"filter": "gaussian", "filter_beta": 2})").filter_beta, 2);
    EXPECT_EQ(params_of(R"({"filter": "gaussian", "filter_alpha": 0.918})").filter_alpha, 0.918);
    for (const std::string filter : {"none", "gaussian", "epanechnikov"})
        EXPECT_NE(refusal_of_params(R"({"filter_k": 1.5, "filter": ")" + filter + "\"}")
                      .find("/filter_k: belongs to the filter cone"),
                  std::string::npos)
            << filter;
    for (const std::string key : {"filter_beta", "filter_alpha"})
        for (const std::string filter : {"none", "cone", "epanechnikov"})
            EXPECT_NE(refusal_of_params("{\"" + key + R"(": 2, "filter": ")" + filter + "\"}")
                          .find("/" + key + ": belongs to the filter gaussian"),
                      std::string::npos)
                << key << " " << filter;
}

TEST(PhotonMapParams, AverageOverASquareWhereThatHasAMeaning) {
    EXPECT_EQ(params_of("{}").footprint, 0);
    EXPECT_EQ(params_of(R"({"footprint": 0.5, "nearest": 20})").footprint, 0.5F);
    EXPECT_EQ(params_of(R"({"footprint": 0.5, "radius": 0.1, "tables": true})").footprint, 0.5F);
    for (const std::string other : {R"("adaptive": true)", R"("estimator": "raw")",
                                    R"("filter": "gaussian", "filter_alpha": 1)"}) {
        const std::string line = refusal_of_params(R"({"footprint": 0.1, )" + other + "}");
        EXPECT_NE(line.find("footprint"), std::string::npos) << line;
    }
    EXPECT_NE(refusal_of_params(R"({"footprint": 0})").find("/footprint"), std::string::npos);
}

TEST(PhotonMapParams, AdaptiveHasItsOwnLargestNumber) {
    EXPECT_FALSE(params_of("{}").adaptive);
    EXPECT_EQ(params_of(R"({"adaptive": true})").nearest, 200);
    EXPECT_EQ(params_of(R"({"adaptive": true, "nearest": 80})").nearest, 80);
    EXPECT_EQ(params_of(R"({"adaptive": false})").nearest, 50);
    EXPECT_NE(refusal_of_params(R"({"adaptive": true, "nearest": 10})").find("/nearest"),
              std::string::npos);
    EXPECT_NE(refusal_of_params(R"({"adaptive": true, "radius": 1})").find("adaptive"),
              std::string::npos);
}

TEST(PhotonMapParams, SaveAndLoadNameFilesBesideTheFileThatNamesThem) {
    EXPECT_EQ(params_of("{}").save, "");
    EXPECT_EQ(params_of(R"({"save": "out/a.photons"})").save, "out/a.photons");
    const PhotonMapParams given = params_of(R"({"load": "a.photons", "nearest": 20})");
    EXPECT_EQ(given.load, "a.photons");
    EXPECT_EQ(given.photons + given.emitted, 0U);
    const PhotonMapParams beside = photonmap_method().read(
        JsonNode::parse_text(R"({"load": "../a.photons"})", "params", "sweeps/b.json"));
    EXPECT_EQ(beside.load, "a.photons");
    EXPECT_NE(refusal_of_params(R"({"save": ""})").find("/save"), std::string::npos);
}

TEST(PhotonMapParams, NothingOfTheTracingCanBeGivenWithLoad) {
    for (const std::string key :
         {R"("photons": 5)", R"("emitted": 5)", R"("emission": "random")", R"("max_bounces": 16)",
          R"("interaction": "roulette")", R"("save": "b.photons")"}) {
        const std::string line = refusal_of_params(R"({"load": "a.photons", )" + key + "}");
        EXPECT_NE(line.find("with load"), std::string::npos) << key << ": " << line;
    }
}

TEST(PhotonMapParams, CountPasses) {
    EXPECT_EQ(params_of("{}").passes, 1);
    EXPECT_EQ(params_of(R"({"passes": 64, "radius": 0.1})").passes, 64);
    EXPECT_EQ(params_of(R"({"passes": 1, "load": "a"})").passes, 1);
    EXPECT_NE(refusal_of_params(R"({"passes": 2, "load": "a"})").find("/load"), std::string::npos);
    EXPECT_NE(refusal_of_params(R"({"passes": 2, "save": "a"})").find("/save"), std::string::npos);
}

TEST(PhotonMapParams, RefuseWhatIsUnknownOrOutOfRange) {
    for (const std::string json :
         {R"({"photon": 1})",           R"({"photons": 0})",          R"({"photons": -1})",
          R"({"photons": 1.5})",        R"({"photons": 2000000001})", R"({"emitted": 0})",
          R"({"nearest": 0})",          R"({"nearest": 1})",          R"({"max_radius": 0})",
          R"({"max_radius": -1})",      R"({"max_radius": 1e-30})",   R"({"max_radius": 1e30})",
          R"({"estimator": "biased"})", R"({"tree": "balancd"})",     R"({"max_bounces": 0})",
          R"({"photons": "many"})",     R"({"tables": 1})",           R"({"filter": "box"})",
          R"({"adaptive": 1})",         R"({"passes": 0})",           R"({"passes": 2.5})",
          R"({"radius": 0})",           R"({"radius": -1})",          R"({"radius": 1e-30})",
          R"({"radius": "wide"})"}) {
        const std::string line = refusal_of_params(json);
        EXPECT_NE(line, "") << json;
        EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    }
    EXPECT_NE(
        refusal_of_params(R"({"filter": "gaussian", "filter_alpha": 0})").find("from 0.001 to 100"),
        std::string::npos)
        << "as help says";
    EXPECT_NE(refusal_of_params(R"({"max_radius": 1e30})").find("1.8e19"), std::string::npos);
}

}  // namespace
}  // namespace caustics::photonmap
