#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "core/picture/picture_source.h"

namespace caustics {

/// A picture of a format in picture_format.h, which its content tells, not its name: PNG by libpng, others by OpenImageIO.
class PictureFile {
public:
    /// As many pixels as a film may have.
    static constexpr std::size_t most_pixels = std::size_t{1} << 27;

    /// As many as a file of so many bytes may have, so that a megabyte takes at most 220 MB as a texture: 2^24, and more where a
    /// pixel has half a bit in the file.
    static constexpr std::size_t most_pixels_of(std::size_t bytes) {
        constexpr std::size_t always = std::size_t{1} << 24;
        return std::min(most_pixels, std::max(always, 16 * bytes));
    }

    /// Throws InputError for what is no picture, and for more pixels than its file may have.
    explicit PictureFile(const std::filesystem::path& file);
    PictureFile(const PictureFile&) = delete;
    PictureFile& operator=(const PictureFile&) = delete;

    const PictureShape& shape() const { return source_->shape(); }
    std::size_t pixel_count() const;
    /// Hands over the values of a row after another: `channels` floats a pixel. Throws InputError for a broken
    /// picture.
    void read_rows(const std::function<void(int y, const float* values)>& take);
    [[noreturn]] void fail(std::string why) const;

private:
    std::filesystem::path file_;
    std::string bytes_;
    std::unique_ptr<PictureSource> source_;
};

}  // namespace caustics
