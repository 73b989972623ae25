#include "core/base/picture_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/lower_case.h"

namespace caustics {
namespace {

/// Standard error leads nowhere as long as it lives.
class SilentStandardError {
public:
    SilentStandardError() : kept_(fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 0)) {
        const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
        if (kept_ >= 0 && nowhere >= 0) dup2(nowhere, STDERR_FILENO);
        if (nowhere >= 0) close(nowhere);
    }
    ~SilentStandardError() {
        if (kept_ < 0) return;
        std::fflush(stderr);
        dup2(kept_, STDERR_FILENO);
        close(kept_);
    }
    SilentStandardError(const SilentStandardError&) = delete;
    SilentStandardError& operator=(const SilentStandardError&) = delete;

private:
    int kept_;
};

OIIO::ImageSpec reading() {
    OIIO::ImageSpec config;
    config["oiio:UnassociatedAlpha"] = 1;
    return config;
}

}  // namespace

PictureFile::PictureFile(const std::filesystem::path& file)
    : file_(file), bytes_(read_whole_file(file)) {
    open();
    const OIIO::ImageSpec& found = spec();
    if (found.width < 1 || found.height < 1 || found.nchannels < 1) fail("it has no pixels");
    if (pixel_count() > most_pixels)
        fail(std::to_string(found.width) + " x " + std::to_string(found.height) +
             " pixels, more than " + std::to_string(most_pixels));
}

void PictureFile::open() {
    const SilentStandardError silent;
    const OIIO::ImageSpec config = reading();
    std::string format = lower_case(file_.extension().string());
    if (!format.empty()) format.erase(0, 1);
    OIIO::ImageSpec found;
    std::string why;
    if (!format.empty()) input_ = OIIO::ImageInput::create(format);
    if (input_ && input_->supports("ioproxy")) {
        memory_ = std::make_unique<OIIO::Filesystem::IOMemReader>(bytes_.data(), bytes_.size());
        input_->set_ioproxy(memory_.get());
        if (input_->open("picture." + format, found, config)) return;
        why = input_->geterror();
    }
    // A format that is read by name alone, or another one than the name says.
    if (file_.string().find('?') == std::string::npos)
        input_ = OIIO::ImageInput::open(file_.string(), &config);
    else
        input_.reset();
    const std::string by_name = OIIO::geterror();
    if (!input_) fail(why.empty() ? by_name : why);
}

std::size_t PictureFile::pixel_count() const {
    return static_cast<std::size_t>(spec().width) * static_cast<std::size_t>(spec().height);
}

void PictureFile::read_rows(const std::function<void(int y, const float* values)>& take) {
    const SilentStandardError silent;
    const int rows_at_once = spec().tile_width > 0 ? spec().height : 64;
    const std::size_t row =
        static_cast<std::size_t>(spec().width) * static_cast<std::size_t>(spec().nchannels);
    std::vector<float> values(row * static_cast<std::size_t>(rows_at_once));
    const int top = spec().y;
    for (int first = 0; first < spec().height; first += rows_at_once) {
        const int last = std::min(first + rows_at_once, spec().height);
        const bool done =
            spec().tile_width > 0
                ? input_->read_image(0, 0, 0, spec().nchannels, OIIO::TypeDesc::FLOAT,
                                     values.data())
                : input_->read_scanlines(0, 0, top + first, top + last, 0, 0, spec().nchannels,
                                         OIIO::TypeDesc::FLOAT, values.data());
        if (!done) fail(input_->geterror());
        for (int y = first; y < last; ++y)
            take(y, &values[row * static_cast<std::size_t>(y - first)]);
    }
}

void PictureFile::fail(std::string why) const {
    throw InputError(file_.string() + ": cannot be read (" +
                     (why.empty() ? "not a picture of a known format" : std::move(why)) + ")");
}

}  // namespace caustics
