#include "core/picture/picture_reader.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "core/picture/exr_file.h"
#include "core/picture/picture_format.h"
#include "core/picture/picture_limits.h"
#include "core/picture/png_file.h"

namespace caustics {
namespace {

const std::string two_pixels = "P3\n2 1\n255\n255 0 0 0 255 0\n";

/// The only child of this process.
pid_t child() {
    const std::string self = std::to_string(getpid());
    std::ifstream in("/proc/" + self + "/task/" + self + "/children");
    pid_t found = 0;
    in >> found;
    return found;
}

std::vector<float> values_of(PictureReader& reader, const PictureShape& shape) {
    std::vector<float> all;
    reader.read_rows(shape, [&](int first, int last, const float* values) {
        all.insert(all.end(), values, values + row_values(shape) * std::size_t(last - first));
    });
    return all;
}

std::string refusal(PictureReader& reader, const PictureShape& shape) {
    try {
        values_of(reader, shape);
    } catch (const PictureError& error) {
        return error.what();
    }
    return "read";
}

PictureShape open_texture(PictureReader& reader, const std::string& bytes) {
    return reader.open(bytes, picture_format(bytes), PictureUse::texture);
}

TEST(PictureReader, HasPicturesDecodedByOneProcessAfterAnother) {
    PictureReader reader;
    const std::string png = encode_png(2, 1, {255, 0, 0, 0, 255, 0});
    const std::vector<float> red_and_green = {1, 0, 0, 0, 1, 0};
    pid_t before = 0;
    for (const std::string& bytes : {png, png, two_pixels, two_pixels, png}) {
        EXPECT_EQ(values_of(reader, open_texture(reader, bytes)), red_and_green);
        before = child();
        EXPECT_GT(before, 0);
    }
    EXPECT_EQ(open_texture(reader, png).width, 2);
    EXPECT_EQ(child(), before) << "a process serves many pictures";
}

TEST(PictureReader, ServesAProgramThatHasThreads) {
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i)
        threads.emplace_back([] {
            PictureReader reader;
            EXPECT_EQ(values_of(reader, open_texture(reader, two_pixels)).size(), 6);
        });
    for (std::thread& thread : threads) thread.join();
}

TEST(PictureReader, ASignalIsAReasonAndTheNextPictureIsRead) {
    PictureReader reader;
    for (const int number : {SIGSEGV, SIGABRT, SIGKILL}) {
        const PictureShape shape = open_texture(reader, two_pixels);
        const pid_t decoder = child();
        ASSERT_GT(decoder, 0);
        kill(decoder, number);
        EXPECT_NE(refusal(reader, shape)
                      .find("decoding it ended by signal " + std::to_string(number) + ", "),
                  std::string::npos);
    }
    EXPECT_EQ(refusal(reader, open_texture(reader, two_pixels)), "read");
}

TEST(PictureReader, AHangIsAReasonAndTheNextPictureIsRead) {
    // A busy machine may take more than a second to start the process that decodes.
    PictureReader reader(std::chrono::seconds(15));
    const PictureShape shape = open_texture(reader, two_pixels);
    const pid_t decoder = child();
    ASSERT_GT(decoder, 0);
    kill(decoder, SIGSTOP);
    EXPECT_EQ(refusal(reader, shape), "decoding it did not go on for 15 s");
    EXPECT_EQ(refusal(reader, open_texture(reader, two_pixels)), "read");
}

TEST(PictureReader, LimitsMemoryAndTimeOfTheProcess) {
    PictureReader reader;
    open_texture(reader, two_pixels);
    const pid_t decoder = child();
    ASSERT_GT(decoder, 0);
    rlimit limit{};
    ASSERT_EQ(prlimit(decoder, RLIMIT_DATA, nullptr, &limit), 0);
    EXPECT_NE(limit.rlim_cur, RLIM_INFINITY);
    ASSERT_EQ(prlimit(decoder, RLIMIT_CPU, nullptr, &limit), 0);
    EXPECT_LT(limit.rlim_cur, 100U);
}

TEST(PictureReader, HandsOverEveryChannelOfAFilm) {
    constexpr int width = 700;
    constexpr int height = 900;
    std::vector<float> plane(std::size_t{width} * height);
    for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = static_cast<float>(i);
    const std::vector<std::string> names = {"A", "B", "C", "D", "E", "F", "G", "H", "I", "J"};
    std::vector<ExrChannel<const float>> channels;
    for (const std::string& name : names) channels.push_back({name, plane.data()});
    const std::string bytes = encode_exr(width, height, channels, {{"k", "v"}});
    PictureReader reader;
    const PictureShape shape = reader.open(bytes, "openexr", PictureUse::film);
    EXPECT_EQ(shape.names, names);
    EXPECT_EQ(shape.texts.at("k"), "v");
    EXPECT_LT(rows_at_once(shape), height) << "the film comes in parts";
    const std::vector<float> values = values_of(reader, shape);
    ASSERT_EQ(values.size(), names.size() * plane.size());
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t c = 0; c < names.size(); ++c)
            ASSERT_TRUE(std::equal(&plane[y * width], &plane[y * width] + width,
                                   &values[(y * names.size() + c) * width]))
                << "row " << y << ", channel " << c;
}

TEST(PictureReader, APictureThatIsNotReadToItsEndDoesNotDisturbTheNext) {
    PictureReader reader;
    const std::string large = encode_png(1000, 1000, std::vector<unsigned char>(3'000'000));
    const PictureShape shape = open_texture(reader, large);
    EXPECT_THROW(reader.read_rows(shape, [](int, int, const float*) { throw 1; }), int);
    const std::string small = encode_png(1, 1, {255, 255, 255});
    EXPECT_EQ(values_of(reader, open_texture(reader, small)), (std::vector<float>{1, 1, 1}));
}

}  // namespace
}  // namespace caustics
