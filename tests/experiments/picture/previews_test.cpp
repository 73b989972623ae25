#include "experiments/picture/previews.h"

#include <gtest/gtest.h>

namespace caustics::experiments {
namespace {

using Pixel = std::array<int, 3>;

Pixel pixel(const Picture& picture, int x, int y) {
    const std::size_t at = 3 * static_cast<std::size_t>(y * picture.width + x);
    return {picture.rgb[at], picture.rgb[at + 1], picture.rgb[at + 2]};
}

Film row(const std::string& layer, const std::vector<float>& values) {
    Film film(static_cast<int>(values.size()), 1);
    for (std::size_t i = 0; i < values.size(); ++i)
        film.set_rgb(layer, i, Spectrum::Constant(values[i]));
    return film;
}

TEST(ToneMap, IsExposureThenSrgb) {
    const Picture picture = tone_map(row("", {0, 0.0025F, 0.25F, 4}), "", -1);
    EXPECT_EQ(pixel(picture, 0, 0), (Pixel{0, 0, 0}));
    EXPECT_EQ(pixel(picture, 1, 0), (Pixel{4, 4, 4})) << "255 * 12.92 * 0.00125";
    EXPECT_EQ(pixel(picture, 2, 0), (Pixel{99, 99, 99})) << "255 * (1.055 * 0.125^(1/2.4) - 0.055)";
    EXPECT_EQ(pixel(picture, 3, 0), (Pixel{255, 255, 255}));
}

TEST(AutoExposure, MapsTheBrightestOfFewLitPixelsToWhite) {
    EXPECT_DOUBLE_EQ(auto_exposure(row("caustic", {0, 0, 0, 8}), "caustic"), -3);
    EXPECT_EQ(auto_exposure(row("caustic", {0, 0}), "caustic"), 0);
}

TEST(SignedError, IsRedAboveBlueBelowWhiteWhereEqual) {
    Film film = row("caustic", {1, 3, 0, 7});
    film.plane("unreached.Y") = {0, 0, 0, 1};
    const Picture picture = signed_error(film, row("caustic", {1, 1, 1, 1}), "caustic", 1);
    EXPECT_EQ(pixel(picture, 0, 0), (Pixel{255, 255, 255}));
    const Pixel above = pixel(picture, 1, 0);
    EXPECT_TRUE(above[0] > 200 && above[1] == 0 && above[2] == 0);
    const Pixel below = pixel(picture, 2, 0);
    EXPECT_TRUE(below[0] == 0 && below[1] == 0 && below[2] > 200);
    const Pixel unreached = pixel(picture, 3, 0);
    EXPECT_TRUE(unreached[0] == unreached[1] && unreached[1] == unreached[2]);
}

TEST(Strip, PutsThreePicturesSideBySide) {
    const Film film = row("caustic", {1, 1});
    const Picture picture = strip(film, row("caustic", {1, 0}), "caustic");
    EXPECT_EQ(picture.width, 3 * 2 + 2 * 2);
    EXPECT_EQ(picture.rgb.size(), 3U * 10);
    EXPECT_EQ(pixel(picture, 1, 0), (Pixel{0, 0, 0})) << "reference";
    EXPECT_EQ(pixel(picture, 5, 0), (Pixel{255, 255, 255})) << "picture";
}

}  // namespace
}  // namespace caustics::experiments
