#include "core/picture/picture_file.h"

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/picture/exr_header.h"
#include "core/picture/foreign_picture.h"
#include "core/picture/picture_format.h"
#include "core/picture/png_file.h"

namespace caustics {

PictureFile::PictureFile(const std::filesystem::path& file)
    : file_(file), bytes_(read_whole_file(file)) {
    try {
        const std::string format = picture_format(bytes_);
        if (format.empty())
            throw std::runtime_error(std::string("its content is of none of the formats ") +
                                     picture_formats);
        if (format == "openexr") require_attributes_within(bytes_);
        source_ = format == "png" ? open_png(bytes_) : open_foreign_picture(file_, bytes_, format);
    } catch (const std::runtime_error& error) {
        fail(error.what());
    }
    const PictureShape& found = shape();
    if (found.width < 1 || found.height < 1 || found.channels < 1) fail("it has no pixels");
    const std::size_t most = most_pixels_of(bytes_.size());
    if (pixel_count() > most)
        fail(std::to_string(found.width) + " x " + std::to_string(found.height) +
             " pixels, more than " + std::to_string(most) + " in a file of " +
             std::to_string(bytes_.size()) + " bytes");
}

std::size_t PictureFile::pixel_count() const {
    return static_cast<std::size_t>(shape().width) * static_cast<std::size_t>(shape().height);
}

void PictureFile::read_rows(const std::function<void(int y, const float* values)>& take) {
    constexpr std::size_t values_at_once = 1 << 22;  // a row may have a million pixels
    const std::size_t row =
        static_cast<std::size_t>(shape().width) * static_cast<std::size_t>(shape().channels);
    const int rows_at_once = static_cast<int>(std::clamp<std::size_t>(values_at_once / row, 1, 64));
    std::vector<float> values(row * static_cast<std::size_t>(rows_at_once));
    for (int first = 0; first < shape().height; first += rows_at_once) {
        const int last = std::min(first + rows_at_once, shape().height);
        try {
            source_->read_rows(first, last, values.data());
        } catch (const std::runtime_error& error) {
            fail(error.what());
        }
        for (int y = first; y < last; ++y)
            take(y, &values[row * static_cast<std::size_t>(y - first)]);
    }
}

void PictureFile::fail(std::string why) const {
    throw InputError(file_.string() + ": cannot be read (" +
                     (why.empty() ? "no reason is given" : std::move(why)) + ")");
}

}  // namespace caustics
