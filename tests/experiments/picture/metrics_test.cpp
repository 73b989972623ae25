#include "experiments/picture/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "tests/experiments/refusal.h"

namespace caustics::experiments {
namespace {

Film grey_film(const std::string& layer, const std::vector<float>& values) {
    Film film(2, 2);
    for (std::size_t i = 0; i < values.size(); ++i)
        film.set_rgb(layer, i, Spectrum::Constant(values[i]));
    return film;
}

const PixelMask all(4, true);

TEST(Metrics, FollowTheirFormulasByHand) {
    const Film x = grey_film("caustic", {1, 3, 2, 1});
    const Film r = grey_film("caustic", {0, 2, 4, 2});
    const Metrics m = measure(x, r, "caustic", all);
    // Differences 1, 1, -2, -1; mean(r) = 2, so epsilon = 0.01 * 4.
    EXPECT_DOUBLE_EQ(*m.rmse, std::sqrt(7.0 / 4));
    EXPECT_DOUBLE_EQ(*m.relmse, (1 / 0.04 + 1 / 4.04 + 4 / 16.04 + 1 / 4.04) / 4);
    EXPECT_DOUBLE_EQ(*m.bias, -0.25 / 2);
    EXPECT_DOUBLE_EQ(*m.mean_ratio, 1.75 / 2);
    EXPECT_DOUBLE_EQ(*m.leak_energy, 1.0 / 2);
    EXPECT_EQ(m.pixels, 4U);
}

TEST(Metrics, CountTheChannelsApart) {
    Film x(1, 1);
    Film r(1, 1);
    x.set_rgb("", 0, {1, 5, 0});
    r.set_rgb("", 0, {1, 2, 0});
    const Metrics m = measure(x, r, "", PixelMask(1, true));
    EXPECT_DOUBLE_EQ(*m.rmse, std::sqrt(9.0 / 3));
    EXPECT_DOUBLE_EQ(*m.mean_ratio, 2);
    EXPECT_DOUBLE_EQ(*m.leak_energy, 0);
}

TEST(Metrics, LeaveUncountedPixelsOut) {
    const Film x = grey_film("caustic", {1, 100, 2, 1});
    const Film r = grey_film("caustic", {1, 2, 2, 1});
    const Metrics m = measure(x, r, "caustic", {true, false, true, true});
    EXPECT_EQ(m.pixels, 3U);
    EXPECT_EQ(*m.rmse, 0);
    EXPECT_EQ(*m.mean_ratio, 1);
    EXPECT_FALSE(m.leak_energy) << "no dark pixel to leak into";
}

TEST(Metrics, AreUndefinedAgainstABlackReference) {
    const Film x = grey_film("caustic", {1, 1, 1, 1});
    const Film r = grey_film("caustic", {0, 0, 0, 0});
    const Metrics m = measure(x, r, "caustic", all);
    EXPECT_EQ(*m.rmse, 1);
    EXPECT_FALSE(m.relmse || m.bias || m.mean_ratio || m.leak_energy);
    EXPECT_FALSE(measure(x, r, "caustic", PixelMask(4, false)).rmse);
}

TEST(Metrics, NameThePixelThatIsNotFinite) {
    const std::vector<std::string> places = {"(0, 0)", "(1, 0)", "(0, 1)", "(1, 1)"};
    for (std::size_t i = 0; i < places.size(); ++i) {
        Film x = grey_film("caustic", {1, 1, 1, 1});
        x.set_rgb("caustic", i, {1, std::numeric_limits<float>::quiet_NaN(), 1});
        try {
            measure(x, grey_film("caustic", {1, 1, 1, 1}), "caustic", all);
            FAIL() << "a NaN went through";
        } catch (const InputError& error) {
            EXPECT_EQ(error.what(),
                      "picture: layer \"caustic\" is not finite at pixel " + places[i]);
        }
    }
}

TEST(Metrics, RefuseOtherSizesAndMissingLayers) {
    const Film x = grey_film("caustic", {1, 1, 1, 1});
    const auto refusal = [](const Film& film, const Film& reference) {
        return refusal_of([&] { measure(film, reference, "caustic", all); });
    };
    EXPECT_EQ(refusal(x, Film(2, 1)), "the picture has 2x2 pixels, the reference 2x1");
    EXPECT_EQ(refusal(x, Film(1, 2)), "the picture has 2x2 pixels, the reference 1x2");
    const Film other = grey_film("direct", {1, 1, 1, 1});
    EXPECT_EQ(refusal(x, other), "no layer \"caustic\" in the reference");
    EXPECT_EQ(refusal(other, x), "no layer \"caustic\" in the picture");
}

TEST(Metrics, WantBeautyAndCausticOfEveryPictureAndIndirectLightWhereItIsThere) {
    const auto refusal = [](const Film& film) {
        return refusal_of([&] { require_finite(film, "a.exr"); });
    };
    Film film = grey_film("caustic", {1, 1, 1, 1});
    EXPECT_EQ(refusal(film), "a.exr: no layer \"beauty\"");
    for (std::size_t i = 0; i < 4; ++i) film.set_rgb("", i, Spectrum::Constant(1));
    EXPECT_EQ(refusal(film), "taken");
    film.set_rgb("indirect", 3, Spectrum::Constant(std::numeric_limits<float>::infinity()));
    EXPECT_EQ(refusal(film), "a.exr: layer \"indirect\" is not finite at pixel (1, 1)");
}

TEST(Masks, LeaveOutWhatEitherPictureCannotReach) {
    Film x(2, 2);
    Film r(2, 2);
    x.plane("unreached.Y") = {0, 0.25F, 0, 0};
    r.plane("unreached.Y") = {0, 0, 0, 1};
    EXPECT_EQ(reached_pixels(x, r), (PixelMask{true, false, true, false}));
    EXPECT_DOUBLE_EQ(fraction(reached_pixels(x, r)), 0.5);
    EXPECT_EQ(fraction({}), 0);
}

TEST(Masks, KeepPixelsAtLeastAsBrightAsTheMean) {
    const Film r = grey_film("caustic", {0, 1, 2, 100});
    EXPECT_EQ(bright_pixels(r, "caustic", {true, true, true, false}),
              (PixelMask{false, true, true, false}));
    EXPECT_EQ(bright_pixels(grey_film("caustic", {3, 0, 0, 1}), "caustic", all),
              (PixelMask{true, false, false, true}));
    EXPECT_EQ(bright_pixels(grey_film("caustic", {0, 0, 0, 0}), "caustic", all),
              PixelMask(4, false));
}

TEST(Masks, IntersectPixelByPixel) {
    EXPECT_EQ(intersection({true, true, false, false}, {true, false, true, false}),
              (PixelMask{true, false, false, false}));
}

TEST(StandardError, IsEmptyWhereThereIsNoCaustic) {
    Film film(1, 1);
    film.set_rgb("", 0, Spectrum::Constant(1));
    EXPECT_FALSE(relative_standard_error(film, "caustic", {true}));
    film.plane("stderr.Y")[0] = 1;
    EXPECT_FALSE(relative_standard_error(film, "caustic", {true}));
    EXPECT_THROW(static_cast<void>(film.rgb("caustic", 0)), std::logic_error);
}

TEST(StandardError, IsTheRootMeanSquareOverTheMean) {
    Film r = grey_film("caustic", {1, 1, 1, 5});
    EXPECT_FALSE(relative_standard_error(r, "caustic", all)) << "no layer stderr";
    r.plane("stderr.Y") = {1, 2, 2, 9};
    EXPECT_DOUBLE_EQ(*relative_standard_error(r, "caustic", {true, true, true, false}),
                     std::sqrt(3.0));
    EXPECT_DOUBLE_EQ(mean(r, "caustic", all), 2);
    EXPECT_FALSE(relative_standard_error(r, "indirect", all));
    for (std::size_t i = 0; i < 4; ++i) r.set_rgb("indirect", i, Spectrum::Constant(4));
    EXPECT_FALSE(relative_standard_error(r, "indirect", all)) << "that is the caustic's";
    for (std::size_t i = 0; i < 4; ++i) r.set_rgb("indirect_stderr", i, {1, 2, 2});
    EXPECT_NEAR(*relative_standard_error(r, "indirect", all), std::sqrt(3.0) / 4, 1e-7);
    EXPECT_FALSE(relative_standard_error(r, "direct", all));
    Film black = grey_film("caustic", {0, 0, 0, 0});
    black.plane("stderr.Y") = {1, 1, 1, 1};
    EXPECT_FALSE(relative_standard_error(black, "caustic", all)) << "of what share?";
}

}  // namespace
}  // namespace caustics::experiments
