#include "core/render/film.h"

#include <gtest/gtest.h>

#include <bit>
#include <chrono>
#include <cstdint>
#include <fstream>
#include <limits>
#include <sstream>
#include <thread>

#include "core/base/error.h"
#include "tests/support/temporary_folder.h"

namespace caustics {
namespace {

namespace fs = std::filesystem;

const fs::path& folder() {
    static const support::TemporaryFolder temporary("film_test");
    return temporary.path();
}

std::string bytes_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream bytes;
    bytes << in.rdbuf();
    return bytes.str();
}

Film film_with_hard_values() {
    Film film(3, 2);
    using Limits = std::numeric_limits<float>;
    film.plane("caustic.R") = {0.0F, -0.0F, Limits::denorm_min(), Limits::max(), 65505.0F, 0.1F};
    film.plane("caustic.G") = {1e-40F, 1e30F, -1.5F, 65504.0F, 1.0F / 3, Limits::infinity()};
    film.plane("caustic.B") = {1, 2, 3, 4, 5, 6};
    film.plane("depth.Z") = {6, 5, 4, 3, 2, 1};
    film.plane("B") = {7, 7, 7, 7, 7, 8};
    film.plane("G") = {9, 9, 9, 9, 9, 9};
    film.plane("R") = {0.5F, 0.25F, 0, 0, 0, 0};
    film.metadata = {{"config", "{\"scene\":\"pool\"}"},
                     {"a_name_longer_than_thirty_one_bytes", "1"}};
    return film;
}

TEST(Film, PlanesAreZeroWhenNewAndStayWhereTheyAre) {
    Film film(2, 2);
    std::vector<float>& first = film.plane("R");
    EXPECT_EQ(first, std::vector<float>(4, 0.0F));
    for (int i = 0; i < 100; ++i) film.plane("layer" + std::to_string(i) + ".R");
    first[3] = 5;
    EXPECT_EQ(film.find("R")->at(3), 5);
    EXPECT_EQ(film.find("G"), nullptr);
    EXPECT_FALSE(film.has_layer(""));
}

TEST(Film, RgbOfALayer) {
    Film film(2, 1);
    film.set_rgb("caustic", 1, {1, 2, 3});
    EXPECT_TRUE(film.has_layer("caustic"));
    EXPECT_FALSE(film.has_layer("direct"));
    EXPECT_TRUE((film.rgb("caustic", 1) == Spectrum(1, 2, 3)).all());
    EXPECT_TRUE((film.rgb("caustic", 0) == Spectrum(0, 0, 0)).all());
}

TEST(Exr, GivesBackEveryBitByName) {
    const fs::path file = folder() / "bits.exr";
    const Film film = film_with_hard_values();
    write_exr(film, file);
    const Film read = read_exr(file);
    ASSERT_EQ(read.width(), 3);
    ASSERT_EQ(read.height(), 2);
    ASSERT_EQ(read.planes().size(), film.planes().size());
    for (const Plane& plane : film.planes()) {
        const std::vector<float>* values = read.find(plane.channel);
        ASSERT_NE(values, nullptr) << plane.channel;
        for (std::size_t i = 0; i < plane.values.size(); ++i)
            EXPECT_EQ(std::bit_cast<std::uint32_t>(values->at(i)),
                      std::bit_cast<std::uint32_t>(plane.values[i]))
                << plane.channel << " " << i;
    }
    EXPECT_EQ(read.metadata, film.metadata);
}

TEST(Exr, TheSamePictureGivesTheSameBytesLater) {
    const fs::path first = folder() / "first.exr";
    const fs::path second = folder() / "second.exr";
    write_exr(film_with_hard_values(), first);
    // Long enough for a time stamp in seconds to differ.
    std::this_thread::sleep_for(std::chrono::milliseconds(1'100));
    write_exr(film_with_hard_values(), second);
    EXPECT_EQ(bytes_of(first), bytes_of(second));
}

TEST(Exr, LeavesNoTemporaryFileAndReplacesAnOldOne) {
    const fs::path place = folder() / "alone";
    fs::remove_all(place);
    fs::create_directories(place);
    const fs::path file = place / "picture.exr";
    std::ofstream(file) << "old";
    write_exr(film_with_hard_values(), file);
    EXPECT_EQ(read_exr(file).width(), 3);
    EXPECT_EQ(std::distance(fs::directory_iterator(place), fs::directory_iterator()), 1);
}

/// The message of the InputError that `action` throws.
template <class Action>
std::string error_of(const Action& action) {
    try {
        action();
    } catch (const InputError& e) {
        return e.what();
    }
    return "";
}

TEST(Exr, SaysInOneLineWhatCannotBeReadOrWritten) {
    const Film film = film_with_hard_values();
    const fs::path truncated = folder() / "truncated.exr";
    write_exr(film, truncated);
    fs::resize_file(truncated, fs::file_size(truncated) - 40);
    const fs::path text = folder() / "text.exr";
    std::ofstream(text) << "not a picture";
    for (const fs::path& file : {truncated, text, folder() / "absent.exr", folder()}) {
        const std::string message = error_of([&] { static_cast<void>(read_exr(file)); });
        EXPECT_TRUE(message.starts_with(file.string() + ": cannot be read")) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos);
    }
    const fs::path nowhere = folder() / "no_such_folder" / "a.exr";
    EXPECT_TRUE(error_of([&] {
                    write_exr(film, nowhere);
                }).starts_with(nowhere.string() + ": cannot be written"));
    const fs::path taken = folder() / "taken.exr";
    fs::create_directories(taken / "inside");
    EXPECT_NE(error_of([&] { write_exr(film, taken); }), "");
    EXPECT_TRUE(fs::is_directory(taken));
}

TEST(Png, IsDeterministicAndSaysWhatFails) {
    const std::vector<unsigned char> rgb{0, 1, 2, 253, 254, 255};
    const fs::path file = folder() / "small.png";
    write_png(2, 1, rgb, file);
    const std::string bytes = bytes_of(file);
    EXPECT_EQ(bytes.substr(1, 3), "PNG");
    write_png(2, 1, rgb, file);
    EXPECT_EQ(bytes_of(file), bytes);
    EXPECT_NE(error_of([&] { write_png(2, 1, rgb, folder() / "none" / "a.png"); }), "");
}

}  // namespace
}  // namespace caustics
