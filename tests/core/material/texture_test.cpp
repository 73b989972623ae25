#include "core/material/texture.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>

#include "core/base/error.h"
#include "core/render/film.h"
#include "tests/support/bitmap_file.h"
#include "tests/support/temporary_folder.h"

namespace caustics {
namespace {

using support::load_bitmap;

namespace fs = std::filesystem;

fs::path temporary(const std::string& name) {
    static const support::TemporaryFolder folder("texture_test");
    return folder.path() / name;
}

float grey(const Texture& texture, float u, float v) { return evaluate(texture, {u, v})[1]; }

/// Top row 1, 2, bottom row 3, 4.
Bitmap two_by_two(Bitmap::Filter filter, Bitmap::Wrap wrap) {
    Bitmap bitmap;
    bitmap.width = 2;
    bitmap.height = 2;
    for (const float value : {1.0F, 2.0F, 3.0F, 4.0F})
        bitmap.texels.push_back(Spectrum::Constant(value));
    bitmap.filter = filter;
    bitmap.wrap = wrap;
    return bitmap;
}

TEST(Checkerboard, QuadrantsAlternateAndRepeat) {
    const Checkerboard board{Spectrum::Constant(1), Spectrum::Constant(0),
                             Eigen::Affine3f::Identity()};
    EXPECT_EQ(grey(board, 0.25F, 0.25F), 1);
    EXPECT_EQ(grey(board, 0.75F, 0.25F), 0);
    EXPECT_EQ(grey(board, 0.25F, 0.75F), 0);
    EXPECT_EQ(grey(board, 0.75F, 0.75F), 1);
    EXPECT_EQ(grey(board, 3.25F, -0.25F), 0);
    EXPECT_EQ(grey(board, -0.25F, -0.25F), 1);
}

TEST(Checkerboard, ToUvIsAppliedToTheCoordinates) {
    Checkerboard board{Spectrum::Constant(1), Spectrum::Constant(0), Eigen::Affine3f::Identity()};
    board.to_uv = Eigen::Translation3f(0.5F, 0, 0) * Eigen::Scaling(2.0F, 1.0F, 1.0F);
    // u = 0.1 -> 0.7, v = 0.25.
    EXPECT_EQ(grey(board, 0.1F, 0.25F), 0);
    EXPECT_EQ(grey(board, 0.3F, 0.25F), 1);
}

TEST(Bitmap, NearestTakesTheTexelThatHoldsThePoint) {
    const Bitmap bitmap = two_by_two(Bitmap::Filter::nearest, Bitmap::Wrap::repeat);
    EXPECT_EQ(grey(bitmap, 0.49F, 0.49F), 1);
    EXPECT_EQ(grey(bitmap, 0.51F, 0.1F), 2);
    EXPECT_EQ(grey(bitmap, 0.1F, 0.9F), 3);
    EXPECT_EQ(grey(bitmap, 0.9F, 0.51F), 4);
}

TEST(Bitmap, BilinearIsExactAtTexelCentresAndBetweenThem) {
    const Bitmap bitmap = two_by_two(Bitmap::Filter::bilinear, Bitmap::Wrap::clamp);
    EXPECT_EQ(grey(bitmap, 0.25F, 0.25F), 1);
    EXPECT_EQ(grey(bitmap, 0.75F, 0.75F), 4);
    EXPECT_EQ(grey(bitmap, 0.5F, 0.25F), 1.5F);
    EXPECT_EQ(grey(bitmap, 0.5F, 0.5F), 2.5F);
    EXPECT_EQ(grey(bitmap, 0.375F, 0.25F), 1.25F);
}

TEST(Bitmap, WrapsAtTheEdgeOfThePicture) {
    using Filter = Bitmap::Filter;
    using Wrap = Bitmap::Wrap;
    // At u = 0 the left neighbour is the last column, itself, or the first column again.
    EXPECT_EQ(grey(two_by_two(Filter::bilinear, Wrap::repeat), 0, 0.25F), 1.5F);
    EXPECT_EQ(grey(two_by_two(Filter::bilinear, Wrap::mirror), 0, 0.25F), 1);
    EXPECT_EQ(grey(two_by_two(Filter::bilinear, Wrap::clamp), 0, 0.25F), 1);
    // One picture further: repeated, mirrored, or the last column for ever.
    EXPECT_EQ(grey(two_by_two(Filter::nearest, Wrap::repeat), 1.25F, 0.25F), 1);
    EXPECT_EQ(grey(two_by_two(Filter::nearest, Wrap::mirror), 1.25F, 0.25F), 2);
    EXPECT_EQ(grey(two_by_two(Filter::nearest, Wrap::mirror), -0.25F, 0.25F), 1);
    EXPECT_EQ(grey(two_by_two(Filter::nearest, Wrap::clamp), 1.25F, 0.25F), 2);
    EXPECT_EQ(grey(two_by_two(Filter::nearest, Wrap::clamp), -9.25F, 0.25F), 1);
}

TEST(Bitmap, FarCoordinatesStayInThePicture) {
    for (const auto wrap : {Bitmap::Wrap::repeat, Bitmap::Wrap::mirror, Bitmap::Wrap::clamp})
        for (const float far : {1e30F, -1e30F, 1e9F, -1e-30F}) {
            const float value = grey(two_by_two(Bitmap::Filter::bilinear, wrap), far, far);
            EXPECT_GE(value, 1);
            EXPECT_LE(value, 4);
        }
}

TEST(LoadBitmap, DecodesSrgbUnlessRawAndStartsAtTheTop) {
    const fs::path file = temporary("bytes.png");
    write_png(2, 2, {0, 0, 0, 255, 255, 255, 128, 10, 200, 51, 51, 51}, file);
    const Bitmap raw = load_bitmap(file, true);
    ASSERT_EQ(raw.width, 2);
    ASSERT_EQ(raw.texels.size(), 4U);
    EXPECT_FLOAT_EQ(raw.texels[0][0], 0);
    EXPECT_FLOAT_EQ(raw.texels[1][0], 1);
    EXPECT_FLOAT_EQ(raw.texels[2][0], 128.0F / 255);
    const Bitmap decoded = load_bitmap(file, false);
    // ((128/255 + 0.055)/1.055)^2.4, (10/255)/12.92, ((200/255 + 0.055)/1.055)^2.4
    EXPECT_NEAR(decoded.texels[2][0], 0.2158605F, 1e-6);
    EXPECT_NEAR(decoded.texels[2][1], 0.00303527F, 1e-7);
    EXPECT_NEAR(decoded.texels[2][2], 0.5775804F, 1e-6);
    EXPECT_FLOAT_EQ(decoded.texels[1][2], 1);
}

TEST(LoadBitmap, FloatPicturesAreLinearAndOneChannelIsGrey) {
    Film film(1, 1);
    film.plane("Y") = {0.25F};
    write_exr(film, temporary("grey.exr"));
    const Bitmap bitmap = load_bitmap(temporary("grey.exr"), false);
    EXPECT_TRUE((bitmap.texels[0] == Spectrum::Constant(0.25F)).all());
}

TEST(LoadBitmap, AlphaIsIgnored) {
    // One pixel of a TGA: 32 bits, blue green red alpha, from the top left.
    const fs::path file = temporary("alpha.tga");
    const unsigned char bytes[] = {0, 0, 2, 0, 0, 0,  0,    0,  0,   0,   0,
                                   0, 1, 0, 1, 0, 32, 0x28, 50, 100, 200, 128};
    std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(bytes), sizeof bytes);
    const Bitmap bitmap = load_bitmap(file, true);
    EXPECT_FLOAT_EQ(bitmap.texels[0][0], 200.0F / 255);
    EXPECT_FLOAT_EQ(bitmap.texels[0][2], 50.0F / 255);
}

TEST(LoadBitmap, NamesWhatIsWrongInOneLine) {
    std::ofstream(temporary("broken.png")) << "no picture";
    Film negative(2, 1);
    negative.set_rgb("", 1, {0, -1, 0});
    write_exr(negative, temporary("negative.exr"));
    Film endless(2, 1);
    endless.set_rgb("", 1, {0, std::numeric_limits<float>::infinity(), 0});
    write_exr(endless, temporary("endless.exr"));
    for (const char* name : {"broken.png", "negative.exr", "endless.exr", "absent.png"}) {
        try {
            static_cast<void>(load_bitmap(temporary(name), false));
            ADD_FAILURE() << name;
        } catch (const InputError& e) {
            const std::string message = e.what();
            EXPECT_TRUE(message.starts_with(temporary(name).string() + ": ")) << message;
            EXPECT_EQ(message.find('\n'), std::string::npos);
        }
    }
}

}  // namespace
}  // namespace caustics
