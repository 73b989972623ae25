#include "core/render/film.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <new>
#include <stdexcept>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/picture_file.h"

namespace caustics {
namespace {

namespace fs = std::filesystem;

std::array<std::string, 3> rgb_channels(const std::string& layer) {
    const std::string prefix = layer.empty() ? "" : layer + ".";
    return {prefix + "R", prefix + "G", prefix + "B"};
}

[[noreturn]] void fail(const fs::path& file, const std::string& doing, const std::string& why) {
    throw InputError(file.string() + ": cannot be " + doing + " (" + why + ")");
}

// OpenImageIO encodes to memory: its own writers do not report a full disk, and a temporary name
// would hide the extension they choose the format by.
void encode_and_write(const std::string& format, const OIIO::ImageSpec& spec, OIIO::TypeDesc type,
                      const void* pixels, const fs::path& file) {
    const auto output = OIIO::ImageOutput::create(format);
    if (!output) fail(file, "written", OIIO::geterror());
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    const bool done = output->set_ioproxy(&memory) &&
                      output->open(file.filename().string(), spec) &&
                      output->write_image(type, pixels) && output->close();
    if (!done) fail(file, "written", output->geterror());
    write_atomic_file(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace

std::vector<float>& Film::plane(const std::string& channel) {
    for (Plane& plane : planes_)
        if (plane.channel == channel) return plane.values;
    try {
        planes_.push_back({channel, std::vector<float>(pixel_count(), 0.0F)});
    } catch (const std::bad_alloc&) {
        throw InputError("a film of " + std::to_string(width_) + " x " + std::to_string(height_) +
                         " pixels does not fit into memory");
    }
    return planes_.back().values;
}

const std::vector<float>* Film::find(const std::string& channel) const {
    for (const Plane& plane : planes_)
        if (plane.channel == channel) return &plane.values;
    return nullptr;
}

bool Film::has_layer(const std::string& layer) const {
    return std::ranges::all_of(rgb_channels(layer),
                               [this](const std::string& name) { return find(name) != nullptr; });
}

Spectrum Film::rgb(const std::string& layer, std::size_t pixel) const {
    Spectrum value;
    Eigen::Index c = 0;
    for (const std::string& name : rgb_channels(layer)) {
        const std::vector<float>* const values = find(name);
        if (values == nullptr) throw std::logic_error("a picture has no channel " + name);
        value[c++] = values->at(pixel);
    }
    return value;
}

void Film::set_rgb(const std::string& layer, std::size_t pixel, const Spectrum& value) {
    Eigen::Index c = 0;
    for (const std::string& name : rgb_channels(layer)) plane(name)[pixel] = value[c++];
}

void write_exr(const Film& film, const fs::path& file) {
    OIIO::ImageSpec spec(film.width(), film.height(), static_cast<int>(film.planes().size()),
                         OIIO::TypeDesc::FLOAT);
    spec.channelnames.clear();
    for (const Plane& plane : film.planes()) spec.channelnames.push_back(plane.channel);
    spec.attribute("compression", "zip");
    // Without it the writer puts the hour of writing here, and the bytes differ.
    spec.attribute("DateTime", "1970:01:01 00:00:00");
    for (const auto& [name, value] : film.metadata) spec.attribute("causticbench." + name, value);
    std::vector<float> pixels(film.pixel_count() * film.planes().size());
    for (std::size_t c = 0; c < film.planes().size(); ++c)
        for (std::size_t i = 0; i < film.pixel_count(); ++i)
            pixels[i * film.planes().size() + c] = film.planes()[c].values[i];
    encode_and_write("openexr", spec, OIIO::TypeDesc::FLOAT, pixels.data(), file);
}

Film read_exr(const fs::path& file) {
    PictureFile picture(file);
    if (picture.format() != "openexr")
        picture.fail("holds " + picture.format() + " values, not radiance as OpenEXR does");
    const OIIO::ImageSpec& spec = picture.spec();
    if (spec.x != spec.full_x || spec.y != spec.full_y || spec.width != spec.full_width ||
        spec.height != spec.full_height)
        fail(file, "read", "its data window is not the whole picture");
    Film film(spec.width, spec.height);
    const auto channels = static_cast<std::size_t>(spec.nchannels);
    const auto width = static_cast<std::size_t>(spec.width);
    std::vector<std::vector<float>*> planes;
    for (const std::string& channel : spec.channelnames) planes.push_back(&film.plane(channel));
    picture.read_rows([&](int y, const float* values) {
        for (std::size_t i = width * static_cast<std::size_t>(y), end = i + width; i < end; ++i)
            for (std::size_t c = 0; c < channels; ++c) (*planes[c])[i] = *values++;
    });
    const std::string prefix = "causticbench.";
    for (const auto& attribute : spec.extra_attribs) {
        const std::string name = attribute.name().string();
        if (name.starts_with(prefix))
            film.metadata[name.substr(prefix.size())] = attribute.get_string();
    }
    return film;
}

void write_png(int width, int height, const std::vector<unsigned char>& rgb, const fs::path& file) {
    OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::UINT8);
    encode_and_write("png", spec, OIIO::TypeDesc::UINT8, rgb.data(), file);
}

}  // namespace caustics
