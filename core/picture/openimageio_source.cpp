#include "core/picture/openimageio_source.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <vector>

#include "core/picture/exr_header.h"
#include "core/picture/picture_limits.h"
#include "core/picture/primaries.h"

namespace caustics {
namespace {

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
    OpenImageIoSource(const std::string& bytes, const std::string& format)
        : memory_(bytes.data(), bytes.size()) {
        open_input(format);
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
        const std::size_t row = row_values(shape_);
        for (int y = first; y < last; ++y, values += row) {
            const bool done =
                input_->spec().tile_width > 0 ? read_row_of_tiles(y, values) : read_row(y, values);
            // Also of what was read: many complaints would end the process.
            const std::string why = input_->geterror();
            if (!done) throw std::runtime_error(why);
        }
    }

private:
    void open_input(const std::string& format) {
        const OIIO::ImageSpec config = reading();
        OIIO::ImageSpec found;
        input_ = OIIO::ImageInput::create(format);
        if (!input_) throw std::runtime_error(OIIO::geterror());
        input_->set_ioproxy(&memory_);
        const std::string name = "picture." + format;
        if (input_->open(name, found, config)) return;
        std::string why = input_->geterror();
        if (const std::size_t at = why.find('"' + name + '"'); at != std::string::npos)
            why.replace(at, name.size() + 2, "it");
        throw std::runtime_error(why);
    }

    // One row by itself: for many the library makes 64 MB of room, however small they are.
    bool read_row(int y, float* values) {
        const OIIO::ImageSpec& spec = input_->spec();
        const auto channels = static_cast<std::size_t>(spec.nchannels);
        const auto taken = static_cast<std::size_t>(shape_.channels);
        row_.resize(static_cast<std::size_t>(shape_.width) * channels);
        if (!input_->read_scanline(spec.y + y, 0, OIIO::TypeDesc::FLOAT, row_.data())) return false;
        for (std::size_t from = 0; from < row_.size(); from += channels)
            values = std::copy_n(&row_[from], taken, values);
        return true;
    }

    // A row of tiles is read whole, and kept for the rows of pixels in it.
    bool read_row_of_tiles(int y, float* values) {
        const OIIO::ImageSpec& spec = input_->spec();
        const std::size_t row = row_values(shape_);
        const int top = y - y % spec.tile_height;
        if (tiles_.empty() || top != tiles_top_) {
            const int bottom = std::min(top + spec.tile_height, shape_.height);
            tiles_.resize(row * static_cast<std::size_t>(bottom - top));
            tiles_top_ = top;
            if (!input_->read_tiles(0, 0, spec.x, spec.x + spec.width, spec.y + top,
                                    spec.y + bottom, 0, 1, 0, shape_.channels,
                                    OIIO::TypeDesc::FLOAT, tiles_.data()))
                return false;
        }
        std::copy_n(&tiles_[row * static_cast<std::size_t>(y - top)], row, values);
        return true;
    }

    Memory memory_;
    std::unique_ptr<OIIO::ImageInput> input_;
    std::vector<float> row_;    ///< with all its channels
    std::vector<float> tiles_;  ///< the rows of pixels from tiles_top_ on
    int tiles_top_ = 0;
};

}  // namespace

std::unique_ptr<PictureSource> open_with_openimageio(const std::string& bytes,
                                                     const std::string& format) {
    // Threads would take more memory than small pictures.
    OIIO::attribute("threads", 1);
    OIIO::attribute("exr_threads", -1);
    if (format == "openexr") require_attributes_within(bytes);
    return std::make_unique<OpenImageIoSource>(bytes, format);
}

}  // namespace caustics
