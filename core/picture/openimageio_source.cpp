// The module with OpenImageIO, which foreign_picture loads.

#include <fcntl.h>
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <vector>

#include "core/picture/foreign_picture.h"
#include "core/picture/primaries.h"

namespace caustics {
namespace {

/// Standard error leads nowhere as long as it lives.
class SilentStandardError {
public:
    SilentStandardError() : kept_(fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 0)) {
        if (kept_ < 0) return;  // it could not be brought back
        const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
        if (nowhere >= 0) dup2(nowhere, STDERR_FILENO);
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

/// One channel is grey, whatever its name. Of more, which ones are the colours has to be plain: OpenImageIO brings R,
/// G, B and A to the front, and leaves the others in the order of their names.
void require_plain_channels(const OIIO::ImageSpec& spec) {
    const std::vector<std::string> colours = spec.nchannels == 2
                                                 ? std::vector<std::string>{"Y", "A"}
                                                 : std::vector<std::string>{"R", "G", "B"};
    const std::vector<std::string>& names = spec.channelnames;
    if (spec.nchannels == 1 || std::equal(colours.begin(), colours.end(), names.begin())) return;
    std::string all;
    for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
    throw std::runtime_error("its channels are " + all +
                             "; write the colours as R, G and B, or grey as Y alone");
}

/// What an OpenEXR file says of its values is not passed over.
void require_plain_exr(const OIIO::ImageSpec& spec) {
    const int parts = spec.get_int_attribute("oiio:subimages", 1);
    if (parts > 1)
        throw std::runtime_error("it holds " + std::to_string(parts) +
                                 " parts, and pictures of one are read");
    for (int channel = 0; channel < spec.nchannels; ++channel)
        if (!spec.channelformat(channel).is_floating_point())
            throw std::runtime_error("its channel " + std::string(spec.channel_name(channel)) +
                                     " holds whole numbers (UINT), which have no scale; write half "
                                     "or float");
    require_plain_channels(spec);
    if (spec.x != spec.full_x || spec.y != spec.full_y || spec.width != spec.full_width ||
        spec.height != spec.full_height)
        throw std::runtime_error("its data window is not the whole picture");
    constexpr OIIO::TypeDesc eight(OIIO::TypeDesc::FLOAT, 8);
    Primaries primaries = rec709_primaries;
    if (const OIIO::ParamValue* given = spec.find_attribute("chromaticities", eight))
        std::copy_n(static_cast<const float*>(given->data()), primaries.size(), primaries.begin());
    if (spec.nchannels >= 3) require_rec709(primaries);
}

/// The library's own takes a place before the bytes, of a broken file, for one behind them, and reads there.
class Memory : public OIIO::Filesystem::IOMemReader {
public:
    using IOMemReader::IOMemReader;

    std::size_t pread(void* to, std::size_t count, std::int64_t from) override {
        return from < 0 ? 0 : IOMemReader::pread(to, count, from);
    }
};

class OpenImageIoSource : public PictureSource {
public:
    OpenImageIoSource(const std::filesystem::path& file, const std::string& bytes,
                      const std::string& format) {
        const SilentStandardError silent;
        open_input(file, bytes, format);
        const OIIO::ImageSpec& spec = input_->spec();
        if (format == "openexr") require_plain_exr(spec);
        shape_ = {spec.width,
                  spec.height,
                  std::min(spec.nchannels, 4),  // colours and alpha
                  static_cast<int>(spec.format.size()),
                  spec.format.is_floating_point(),
                  input_->format_name()};
    }

    void read_rows(int first, int last, float* values) override {
        const SilentStandardError silent;
        const OIIO::ImageSpec& spec = input_->spec();
        const int top = spec.y;
        const bool done = spec.tile_width > 0 ? read_tiles(first, last, values)
                                              : input_->read_scanlines(
                                                    0, 0, top + first, top + last, 0, 0,
                                                    shape_.channels, OIIO::TypeDesc::FLOAT, values);
        if (!done) throw std::runtime_error(input_->geterror());
    }

private:
    void open_input(const std::filesystem::path& file, const std::string& bytes,
                    const std::string& format) {
        const OIIO::ImageSpec config = reading();
        OIIO::ImageSpec found;
        input_ = OIIO::ImageInput::create(format);
        if (!input_) throw std::runtime_error(OIIO::geterror());
        if (input_->supports("ioproxy")) {
            memory_ = std::make_unique<Memory>(bytes.data(), bytes.size());
            input_->set_ioproxy(memory_.get());
            const std::string name = "picture." + format;
            if (input_->open(name, found, config)) return;
            std::string why = input_->geterror();
            if (const std::size_t at = why.find('"' + name + '"'); at != std::string::npos)
                why.replace(at, name.size() + 2, "it");
            throw std::runtime_error(why);
        }
        if (!input_->open(file.string(), found, config))
            throw std::runtime_error(input_->geterror());
    }

    // Tiles are read whole, once: all rows are kept.
    bool read_tiles(int first, int last, float* values) {
        const auto row = static_cast<std::ptrdiff_t>(shape_.width) * shape_.channels;
        if (tiles_.empty()) {
            tiles_.resize(static_cast<std::size_t>(row) * static_cast<std::size_t>(shape_.height));
            if (!input_->read_image(0, 0, 0, shape_.channels, OIIO::TypeDesc::FLOAT, tiles_.data()))
                return false;
        }
        std::copy(tiles_.begin() + row * first, tiles_.begin() + row * last, values);
        return true;
    }

    std::unique_ptr<Memory> memory_;
    std::unique_ptr<OIIO::ImageInput> input_;
    std::vector<float> tiles_;
};

}  // namespace
}  // namespace caustics

extern "C" caustics::PictureSource* caustics_open_picture(const char* file,
                                                          const std::string& bytes,
                                                          const std::string& format) {
    return new caustics::OpenImageIoSource(file, bytes, format);
}
