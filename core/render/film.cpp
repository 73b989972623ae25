#include "core/render/film.h"

#include <algorithm>
#include <array>
#include <new>
#include <stdexcept>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/picture/exr_file.h"
#include "core/picture/picture_file.h"
#include "core/picture/png_file.h"

namespace caustics {
namespace {

namespace fs = std::filesystem;

const std::string text_prefix = "causticbench.";  // of our attributes

std::array<std::string, 3> rgb_channels(const std::string& layer) {
    const std::string prefix = layer.empty() ? "" : layer + ".";
    return {prefix + "R", prefix + "G", prefix + "B"};
}

[[noreturn]] void fail(const fs::path& file, const std::string& doing, const std::string& why) {
    throw InputError(file.string() + ": cannot be " + doing + " (" + why + ")");
}

/// What the library throws becomes an InputError that names the file.
template <class Work>
auto with_reasons(const fs::path& file, const std::string& doing, const Work& work) {
    try {
        return work();
    } catch (const InputError&) {
        throw;
    } catch (const std::bad_alloc&) {
        fail(file, doing, "it does not fit into memory");
    } catch (const std::exception& error) {
        fail(file, doing, error.what());
    }
}

Film film_of(PictureFile& file) {
    const PictureShape& shape = file.shape();
    Film film(shape.width, shape.height);
    std::vector<float*> planes;
    for (const std::string& name : shape.names) film.plane(name);
    for (const std::string& name : shape.names) planes.push_back(film.plane(name).data());
    const auto width = static_cast<std::size_t>(shape.width);
    file.read_rows([&](int y, const float* values) {
        const std::size_t begin = width * static_cast<std::size_t>(y);
        for (float* const plane : planes) {
            std::copy_n(values, width, plane + begin);
            values += width;
        }
    });
    for (const auto& [name, text] : shape.texts)
        if (name.starts_with(text_prefix)) film.metadata[name.substr(text_prefix.size())] = text;
    return film;
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
    std::vector<ExrChannel<const float>> channels;
    for (const Plane& plane : film.planes())
        channels.push_back({plane.channel, plane.values.data()});
    std::map<std::string, std::string> texts;
    for (const auto& [name, value] : film.metadata) texts[text_prefix + name] = value;
    const std::string bytes = with_reasons(
        file, "written", [&] { return encode_exr(film.width(), film.height(), channels, texts); });
    write_atomic_file(file, bytes);
}

Film read_exr(const fs::path& file) {
    PictureFile picture(file, PictureUse::film);
    return with_reasons(file, "read", [&] { return film_of(picture); });
}

void write_png(int width, int height, const std::vector<unsigned char>& rgb, const fs::path& file) {
    write_atomic_file(file, encode_png(width, height, rgb));
}

}  // namespace caustics
