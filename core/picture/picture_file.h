#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "core/picture/picture_limits.h"
#include "core/picture/picture_reader.h"
#include "core/picture/picture_source.h"

namespace caustics {

/// A picture of a format in picture_format.h, which its content tells, not its name. It is decoded by another process.
class PictureFile {
public:
    /// Reads the header alone. Throws InputError for what is no picture, and for more pixels than its file may have.
    /// `reader` outlives it.
    PictureFile(PictureReader& reader, const std::filesystem::path& file,
                PictureUse use = PictureUse::texture);
    /// With a process of its own.
    explicit PictureFile(const std::filesystem::path& file, PictureUse use = PictureUse::texture);
    PictureFile(const PictureFile&) = delete;
    PictureFile& operator=(const PictureFile&) = delete;

    const PictureShape& shape() const { return shape_; }
    std::size_t pixel_count() const;
    /// Hash of the file's bytes.
    std::uint64_t hash() const { return hash_; }
    /// Hands over the values of a row after another, as PictureSource has them. Once. Throws InputError for a broken picture.
    void read_rows(const std::function<void(int y, const float* values)>& take);
    [[noreturn]] void fail(std::string why) const;

private:
    void open(PictureUse use);

    std::filesystem::path file_;
    std::optional<PictureReader> own_reader_;
    PictureReader& reader_;
    PictureShape shape_;
    std::uint64_t hash_ = 0;
};

}  // namespace caustics
