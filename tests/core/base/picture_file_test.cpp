#include "core/base/picture_file.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/material/texture.h"
#include "core/render/film.h"
#include "tests/support/sanitizers.h"
#include "tests/support/temporary_folder.h"

// libpng leaves OpenImageIO's reader of broken files by longjmp, and what that had allocated is lost. The
// whole stack is needed to tell such a leak from ours.
#if CAUSTICS_ADDRESS_SANITIZER
extern "C" const char* __asan_default_options() { return "fast_unwind_on_malloc=0"; }
extern "C" const char* __lsan_default_suppressions() { return "leak:libpng\n"; }
#endif

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
