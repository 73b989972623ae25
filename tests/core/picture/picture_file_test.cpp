#include "core/picture/picture_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <functional>
#include <vector>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/material/texture.h"
#include "core/picture/picture_format.h"
#include "core/picture/primaries.h"
#include "core/render/film.h"
#include "tests/support/bitmap_file.h"
#include "tests/support/exr_kinds.h"
#include "tests/support/temporary_folder.h"

namespace caustics {
namespace {

using support::load_bitmap;

std::string refusal(const std::function<void()>& reading) {
    try {
        reading();
    } catch (const InputError& error) {
        return error.what();
    }
    return "read";
}

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

/// A picture of two pixels, red and black, of each small format.
std::vector<std::pair<std::string, std::string>> small_pictures() {
    const std::string size{"\2\0\1\0", 4};
    return {{"hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n" +
                        std::string{"\x80\0\0\x81\0\0\0\0", 8}},
            {"targa", std::string{"\0\0\2\0\0\0\0\0\0\0\0\0", 12} + size +
                          std::string{"\x18\x20\0\0\xFF\0\0\0", 8}},
            {"pnm", "P3\n2 1\n255\n255 0 0 0 0 0\n"},
            {"openexr", support::exr_of_kind({})}};
}

TEST(PictureFile, ItsFormatIsToldByItsContentAlone) {
    const support::TemporaryFolder folder;
    for (const auto& [format, bytes] : small_pictures()) {
        EXPECT_EQ(picture_format(bytes), format);
        for (const std::string name : {"a.dpx", "a.iff", "a"}) {
            write_atomic_file(folder / name, bytes);
            EXPECT_EQ(PictureFile(folder / name).shape().format, format) << name;
            EXPECT_GT(load_bitmap(folder / name, true).texels[0][0], 0.9F) << format;
        }
    }
    EXPECT_EQ(picture_format("\xFF\xD8\xFF\xE0"), "jpeg");
    EXPECT_EQ(picture_format({"II*\0\b\0\0\0", 8}), "tiff");
}

// Readers of formats that hardly anyone uses wrote outside their memory (Maya IFF), or took 3.7 GB for 8 KB (DPX).
TEST(PictureFile, OtherFormatsAreRefusedBeforeAnyLibraryReadsThem) {
    const support::TemporaryFolder folder;
    const std::vector<std::string> beginnings = {
        "FOR4\0\0\1\0CIMG", "SDPX\0\0\0\0", "XPDS",          "8BPS\0\1", "BM6\0\0\0",
        "GIF89a",           "DDS |",        "SIMPLE  =",     "icns",     "RIFF\0\0\0\0WEBP",
        "\0\0\1\0\1\0",     "YIDR",         "\1\xDA\1\1\0\3"};
    for (const std::string& beginning : beginnings)
        for (const std::string name : {"a.iff", "a.dpx", "a.png", "a.tga"}) {
            write_atomic_file(folder / name, beginning + std::string(300, '\x11'));
            const std::string why = refusal([&] { load_bitmap(folder / name, true); });
            EXPECT_NE(why.find("of none of the formats PNG, OpenEXR, "), std::string::npos)
                << beginning << ": " << why;
        }
}

TEST(PictureFile, PrintsNothingOfItsOwnWhereThePictureIsBroken) {
    const support::TemporaryFolder folder;
    const std::filesystem::path file = folder / "a.png";
    write_png(64, 64, std::vector<unsigned char>(3 * 64 * 64, 7), file);
    const std::string good = read_whole_file(file);
    PictureReader reader;
    int refused = 0;
    testing::internal::CaptureStderr();
    for (std::size_t at = 8; at < good.size(); ++at) {
        std::string broken = good;
        broken[at] = static_cast<char>(broken[at] ^ 0x55);
        write_atomic_file(file, broken);
        try {
            static_cast<void>(caustics::load_bitmap(reader, file, true));
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

TEST(PictureFile, WhatAnOpenExrFileSaysOfItsValuesIsNotPassedOver) {
    const support::TemporaryFolder folder;
    const std::filesystem::path file = folder / "a.exr";
    const auto put = [&](const support::ExrKind& kind) {
        write_atomic_file(file, support::exr_of_kind(kind));
    };
    const auto as_texture = [&] { return refusal([&] { load_bitmap(file, true); }); };
    const auto as_film = [&] { return refusal([&] { read_exr(file); }); };
    constexpr std::array<float, 8> aces = {0.7347F, 0.2653F, 0,        1,
                                           0.0001F, -0.077F, 0.32168F, 0.33767F};
    put({.chromaticities = Primaries(rec709_primaries)});
    EXPECT_EQ(as_texture(), "read");
    EXPECT_EQ(as_film(), "read");
    EXPECT_EQ(load_bitmap(file, true).texels[3][1], 1);
    put({.chromaticities = aces});
    for (const std::string& why : {as_texture(), as_film()})
        EXPECT_NE(why.find("a.exr: cannot be read (its attribute chromaticities"),
                  std::string::npos)
            << why;
    put({.channels = {"Y"}, .chromaticities = aces});
    EXPECT_EQ(as_texture(), "read") << "one channel has no hue";
    put({.parts = 2});
    for (const std::string& why : {as_texture(), as_film()})
        EXPECT_NE(why.find("a.exr: cannot be read (it holds 2 parts"), std::string::npos) << why;
    put({.whole_numbers = true});
    EXPECT_NE(as_texture().find("its channel R holds whole numbers (UINT)"), std::string::npos);
    EXPECT_EQ(read_exr(file).rgb("", 3)[0], 1) << "a film's values are as they are";
}

TEST(PictureFile, WhatHoldsNoPictureIsRefusedWhateverItsName) {
    const support::TemporaryFolder folder;
    for (const std::string name : {"a.null", "a.png", "a.exr", "a.hdr", "a"}) {
        write_atomic_file(folder / name, "no picture");
        const std::string why = refusal([&] { load_bitmap(folder / name, true); });
        EXPECT_NE(why.find(name + ": cannot be read ("), std::string::npos) << why;
    }
}

/// The bytes with another value of an attribute, of the same length.
std::string with_attribute(std::string bytes, const std::string& name, const std::string& value) {
    const std::size_t type = bytes.find(name + '\0') + name.size() + 1;
    const std::size_t at = bytes.find('\0', type) + 1 + sizeof(std::int32_t);
    return bytes.replace(at, value.size(), value);
}

std::string window(std::int32_t width, std::int32_t height) {
    const std::array<std::int32_t, 4> corners = {0, 0, width - 1, height - 1};
    return {reinterpret_cast<const char*>(corners.data()), sizeof corners};
}

TEST(PictureFile, ATextureHasColoursByNameAndAllItsPixels) {
    const support::TemporaryFolder folder;
    const std::filesystem::path file = folder / "a.exr";
    const auto as_texture = [&](const std::string& bytes) {
        write_atomic_file(file, bytes);
        return refusal([&] { load_bitmap(file, true); });
    };
    using Channels = std::vector<std::string>;
    for (const Channels& good : {Channels{"Y"},
                                 {"Z"},
                                 {"A", "Y"},
                                 {"A", "B", "G", "R"},
                                 {"B", "G", "R", "Z", "caustic.B", "caustic.G", "caustic.R"}})
        EXPECT_EQ(as_texture(support::exr_of_kind({.channels = good})), "read") << good[0];
    for (const Channels& bad :
         {Channels{"U", "V"}, {"G", "R"}, {"A", "X", "Y"}, {"a.B", "a.G", "a.R"}})
        EXPECT_NE(as_texture(support::exr_of_kind({.channels = bad})).find("(its channels are "),
                  std::string::npos)
            << bad[0];
    EXPECT_NE(as_texture(with_attribute(support::exr_of_kind({}), "displayWindow", window(3, 3)))
                  .find("a.exr: cannot be read (its data window is not the whole picture)"),
              std::string::npos);
}

// 64 rows at a time were 0.8 GB.
TEST(PictureFile, MayBeAMillionPixelsWide) {
    const support::TemporaryFolder folder;
    constexpr int width = 1'000'000;
    std::vector<unsigned char> pixels(std::size_t{3} * width * 2, 0);
    pixels.back() = 255;
    write_png(width, 2, pixels, folder / "a.png");
    const auto most_memory = [] {
        rusage used{};
        getrusage(RUSAGE_SELF, &used);
        return used.ru_maxrss;  // KB
    };
    const long before = most_memory();
    const Bitmap bitmap = load_bitmap(folder / "a.png", true);
    EXPECT_TRUE((bitmap.texels.front() == black()).all());
    EXPECT_EQ(bitmap.texels.back()[2], 1);
    EXPECT_LT(most_memory() - before, 400'000);
}

// OpenImageIO read what lies before the file's bytes in memory.
TEST(PictureFile, AnOpenExrFileWhoseLinesLieBeforeItIsRefused) {
    const support::TemporaryFolder folder;
    std::string bytes = support::exr_of_kind({});
    // The first place in the table of lines is that behind the table.
    std::size_t table = 0;
    for (std::uint64_t place = 0; place <= table || place > table + 512; ++table)
        std::memcpy(&place, &bytes.at(table + 1), sizeof place);
    bytes.replace(table, sizeof(std::uint64_t), sizeof(std::uint64_t), '\xFF');
    write_atomic_file(folder / "a.exr", bytes);
    EXPECT_NE(refusal([&] { load_bitmap(folder / "a.exr", true); }).find("a.exr: cannot be read ("),
              std::string::npos);
}

/// OpenEXR makes room before it reads: 2 GB for a text, as much as the channels ask for.
TEST(PictureFile, AnOpenExrFileThatAsksForMoreThanItHoldsIsRefused) {
    const support::TemporaryFolder folder;
    const std::filesystem::path file = folder / "a.exr";
    const auto expect_refused = [&](const std::string& bytes, const std::string& film_reason,
                                    const std::string& texture_reason) {
        write_atomic_file(file, bytes);
        const std::string film = refusal([&] { read_exr(file); });
        EXPECT_NE(film.find("a.exr: cannot be read (" + film_reason), std::string::npos) << film;
        const std::string texture = refusal([&] { load_bitmap(file, true); });
        EXPECT_NE(texture.find("a.exr: cannot be read (" + texture_reason), std::string::npos)
            << texture;
    };
    const std::string good = support::exr_of_kind({});
    const std::string line_order{"lineOrder\0lineOrder\0\1\0\0\0", 24};
    const auto with_length = [&](unsigned char last, unsigned char first) {
        std::string bytes = good;
        const std::size_t at = bytes.find(line_order) + 20;
        bytes[at] = static_cast<char>(first);
        bytes[at + 3] = static_cast<char>(last);
        return bytes;
    };
    const std::string inside = "the file ends inside its attribute lineOrder)";
    for (const int last : {0x7F, 0x80})
        expect_refused(with_length(static_cast<unsigned char>(last), 0xFF), inside, inside);
    const std::string wrong = "its attribute lineOrder has 2 bytes";
    expect_refused(with_length(0, 2), wrong, wrong);

    // In a file of two parts the program was ended by SIGABRT.
    std::string odd = good;
    const std::string channels_and_length{"channels\0chlist\0", 16};
    const std::size_t type = odd.find('\0', odd.find(channels_and_length) + 20) + 1;
    odd[type] = 7;
    const std::string unknown = "its channel ";
    expect_refused(odd, unknown, unknown);
    EXPECT_NE(refusal([&] { read_exr(file); }).find("has values of an unknown type, 7)"),
              std::string::npos);

    const std::string tiles{"tiles\0tiledesc\0\t\0\0\0\4\0\0\0\4\0\x7e\0\0", 28};
    constexpr std::size_t magic_and_version = 8;
    const std::string large = "its tiles have 4 x 8257540 pixels";
    expect_refused(std::string(good).insert(magic_and_version, tiles), large, large);

    const auto with_size = [](std::string picture, std::int32_t width, std::int32_t height) {
        for (const char* name : {"dataWindow", "displayWindow"})
            picture = with_attribute(picture, name, window(width, height));
        return picture;
    };
    std::vector<std::string> many(400);
    for (std::size_t i = 0; i < many.size(); ++i) many[i] = "c" + std::to_string(1000 + i);
    const std::string channels =
        with_size(support::exr_of_kind({.channels = many}), 10'000, 10'000);
    const std::string square = "it declares 10000 x 10000 pixels, more than";
    expect_refused(channels + std::string(80'000, '\0'), square, square);
    // 500 bytes: 0.3 GB as a picture, 8.5 GB and 26 s as a texture.
    const std::string row = "it declares 67108865 x 1 pixels, more than";
    expect_refused(with_size(good, 67'108'865, 1), row, row);
}

TEST(PictureFile, AMegabyteTakesAtMost220MegabytesAsATexture) {
    constexpr std::size_t bytes_per_pixel = sizeof(Spectrum);
    EXPECT_LT(most_texture_pixels(1 << 20) * bytes_per_pixel, 210'000'000);
    EXPECT_EQ(most_texture_pixels(100), 4096 * 4096);
    EXPECT_EQ(most_texture_pixels(4'000'000), 64'000'000);
    EXPECT_EQ(most_texture_pixels(1'000'000'000), most_pixels);
    const support::TemporaryFolder folder;
    constexpr int width = 5000;
    constexpr int height = 4000;
    write_png(width, height, std::vector<unsigned char>(std::size_t{3} * width * height),
              folder / "a.png");
    const std::string why = refusal([&] { load_bitmap(folder / "a.png", true); });
    EXPECT_NE(why.find("5000 x 4000 pixels, more than 16777216 in a file of "), std::string::npos)
        << why;
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
        EXPECT_NE(std::string(error.what()).find("12000 x 12000 pixels, more than 16777216"),
                  std::string::npos)
            << error.what();
    }
}

}  // namespace
}  // namespace caustics
