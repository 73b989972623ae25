#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <vector>

#include "core/picture/openimageio_source.h"
#include "core/picture/png_file.h"
#include "tests/support/png_kinds.h"

namespace caustics {
namespace {

std::vector<float> all_values(PictureSource& source) {
    const PictureShape& shape = source.shape();
    std::vector<float> values(static_cast<std::size_t>(shape.width) *
                              static_cast<std::size_t>(shape.height) *
                              static_cast<std::size_t>(shape.channels));
    source.read_rows(0, shape.height, values.data());
    return values;
}

TEST(PngPictures, AreReadAsOpenImageIoReadsThem) {
    constexpr int width = 37;
    constexpr int height = 29;
    std::mt19937 random(5);
    for (const support::PngKind& kind : support::all_png_kinds()) {
        std::vector<std::uint16_t> values(width * height * kind.channels());
        for (std::uint16_t& value : values)
            value = static_cast<std::uint16_t>(random() & ((1U << kind.bits) - 1));
        const std::string bytes = support::png_of_kind(kind, width, height, values);
        const auto ours = open_png(bytes);
        const auto theirs = open_with_openimageio(bytes, "png");
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

}  // namespace
}  // namespace caustics
