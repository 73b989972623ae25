#include "core/picture/picture_file.h"

#include <utility>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/picture/picture_format.h"

namespace caustics {

PictureFile::PictureFile(PictureReader& reader, const std::filesystem::path& file, PictureUse use)
    : file_(file), reader_(reader) {
    open(use);
}

PictureFile::PictureFile(const std::filesystem::path& file, PictureUse use)
    : file_(file), own_reader_(std::in_place), reader_(*own_reader_) {
    open(use);
}

void PictureFile::open(PictureUse use) {
    const std::string bytes = read_whole_file(file_);
    const std::string format = picture_format(bytes);
    if (format.empty())
        fail(std::string("its content is of none of the formats ") + picture_formats);
    const bool is_film = use == PictureUse::film;
    if (is_film && format != "openexr")
        fail("holds " + format + " values, not radiance as OpenEXR does");
    try {
        shape_ = reader_.open(bytes, format, use);
    } catch (const PictureError& error) {
        fail(error.what());
    }
    hash_ = fnv1a(bytes);
    const std::size_t most = is_film ? most_pixels : most_texture_pixels(bytes.size());
    if (pixel_count() > most)
        fail(std::to_string(shape_.width) + " x " + std::to_string(shape_.height) +
             " pixels, more than " + std::to_string(most) + " in a file of " +
             std::to_string(bytes.size()) + " bytes");
}

std::size_t PictureFile::pixel_count() const {
    return static_cast<std::size_t>(shape_.width) * static_cast<std::size_t>(shape_.height);
}

void PictureFile::read_rows(const std::function<void(int y, const float* values)>& take) {
    const std::size_t row = row_values(shape_);
    try {
        reader_.read_rows(shape_, [&](int first, int last, const float* values) {
            for (int y = first; y < last; ++y, values += row) take(y, values);
        });
    } catch (const PictureError& error) {
        fail(error.what());
    }
}

void PictureFile::fail(std::string why) const {
    throw InputError(file_.string() + ": cannot be read (" +
                     (why.empty() ? "no reason is given" : std::move(why)) + ")");
}

}  // namespace caustics
