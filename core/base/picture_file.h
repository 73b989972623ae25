#pragma once

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace caustics {

/// A picture opened by OpenImageIO. It decodes from memory where the format can: a '?' in a file's
/// name would be taken for a query, and pipes are kept away from it. What the formats' own libraries
/// print meanwhile is left out, since the error repeats it; so nothing else should print
/// at that time.
class PictureFile {
public:
    /// As many pixels as a film may have.
    static constexpr std::size_t most_pixels = std::size_t{1} << 27;

    /// Throws InputError for what is no picture, and for more than `most_pixels`.
    explicit PictureFile(const std::filesystem::path& file);
    PictureFile(const PictureFile&) = delete;
    PictureFile& operator=(const PictureFile&) = delete;

    const OIIO::ImageSpec& spec() const { return input_->spec(); }
    /// OpenImageIO's name: "openexr", "png", ...
    std::string format() const { return input_->format_name(); }
    std::size_t pixel_count() const;
    /// Hands over the values of a row after another: `spec().nchannels` floats a pixel. Colours are
    /// as written, not multiplied by alpha. Throws InputError for a broken picture.
    void read_rows(const std::function<void(int y, const float* values)>& take);
    [[noreturn]] void fail(std::string why) const;

private:
    void open();

    std::filesystem::path file_;
    std::string bytes_;
    std::unique_ptr<OIIO::Filesystem::IOMemReader> memory_;
    std::unique_ptr<OIIO::ImageInput> input_;
};

}  // namespace caustics
