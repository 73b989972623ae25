#include "core/picture/picture_file.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <random>
#include <vector>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/material/texture.h"
#include "core/picture/foreign_picture.h"
#include "core/picture/png_file.h"
#include "core/render/film.h"
#include "tests/support/png_kinds.h"
#include "tests/support/temporary_folder.h"

namespace caustics {
namespace {

TEST(PictureFile, IsReadFromAnyPlace) {
    const support::TemporaryFolder folder;
    const std::filesystem::path place = folder / "a?b=c&d";
    std::filesystem::create_directory(place);
    Film film(3, 2);
    film.set_rgb("", 4, {1, 2, 3});
    write_exr(film, place / "e?f.exr");
    EXPECT_TRUE((read_exr(place / "e?f.exr").rgb("", 4) == Spectrum(1, 2, 3)).all());
    write_png(2, 1, {0, 0, 0, 255, 0, 0}, place / "a.png");
    EXPECT_EQ(load_bitmap(place / "a.png", true).texels[1][0], 1);
}

TEST(PictureFile, IsReadByItsContentWhereItsNameIsWrong) {
    const support::TemporaryFolder folder;
    write_png(2, 1, {0, 0, 0, 255, 0, 0}, folder / "a.png");
    for (const std::string name : {"b.jpg", "c.PNG", "d"}) {
        std::filesystem::copy_file(folder / "a.png", folder / name);
        EXPECT_EQ(load_bitmap(folder / name, true).texels[1][0], 1) << name;
    }
}

std::vector<float> all_values(PictureSource& source) {
    const PictureShape& shape = source.shape();
    std::vector<float> values(static_cast<std::size_t>(shape.width) *
                              static_cast<std::size_t>(shape.height) *
                              static_cast<std::size_t>(shape.channels));
    source.read_rows(0, shape.height, values.data());
    return values;
}

TEST(PictureFile, PngsOfEveryKindAreReadAsOpenImageIoReadsThem) {
    const support::TemporaryFolder folder;
    constexpr int width = 37;
    constexpr int height = 29;
    std::mt19937 random(5);
    for (const support::PngKind& kind : support::all_png_kinds()) {
        std::vector<std::uint16_t> values(width * height * kind.channels());
        for (std::uint16_t& value : values)
            value = static_cast<std::uint16_t>(random() & ((1U << kind.bits) - 1));
        const std::string bytes = support::png_of_kind(kind, width, height, values);
        const auto ours = open_png(bytes);
        const auto theirs = open_foreign_picture(folder / "a.png", bytes);
        SCOPED_TRACE(testing::Message()
                     << "colours " << static_cast<int>(kind.colours) << " bits " << kind.bits
                     << " interlaced " << kind.interlaced << " transparent " << kind.transparent
                     << " gamma " << kind.has_gamma);
        EXPECT_EQ(ours->shape().width, width);
        EXPECT_EQ(ours->shape().height, height);
        EXPECT_EQ(ours->shape().channels, theirs->shape().channels);
        EXPECT_EQ(ours->shape().bytes_per_value, theirs->shape().bytes_per_value);
        EXPECT_EQ(ours->shape().is_float, theirs->shape().is_float);
        EXPECT_EQ(ours->shape().format, theirs->shape().format);
        EXPECT_EQ(all_values(*ours), all_values(*theirs));
    }
}

TEST(PictureFile, PrintsNothingOfItsOwnWhereThePictureIsBroken) {
    const support::TemporaryFolder folder;
    const std::filesystem::path file = folder / "a.png";
    write_png(64, 64, std::vector<unsigned char>(3 * 64 * 64, 7), file);
    const std::string good = read_whole_file(file);
    int refused = 0;
    testing::internal::CaptureStderr();
    for (std::size_t at = 8; at < good.size(); ++at) {
        std::string broken = good;
        broken[at] = static_cast<char>(broken[at] ^ 0x55);
        write_atomic_file(file, broken);
        try {
            static_cast<void>(load_bitmap(file, true));
        } catch (const InputError& error) {
            ++refused;
            EXPECT_TRUE(std::string(error.what()).starts_with(file.string() + ": "));
        }
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_GT(refused, 20);
    testing::internal::CaptureStderr();
    std::fputs("heard", stderr);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "heard");
}

TEST(PictureFile, HasNoMorePixelsThanAFilm) {
    const support::TemporaryFolder folder;
    // The header of a TGA picture of 12,000 x 12,000 pixels: 100 bytes that ask for 1.7 GB.
    const unsigned char header[100] = {0, 0, 10, 0,    0,    0,    0,    0,  0,
                                       0, 0, 0,  0xE0, 0x2E, 0xE0, 0x2E, 24, 0};
    write_atomic_file(folder / "a.tga", {reinterpret_cast<const char*>(header), sizeof header});
    try {
        PictureFile(folder / "a.tga");
        ADD_FAILURE();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("12000 x 12000 pixels, more than 134217728"),
                  std::string::npos)
            << error.what();
    }
}

}  // namespace
}  // namespace caustics
