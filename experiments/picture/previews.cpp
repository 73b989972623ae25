#include "experiments/picture/previews.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "experiments/picture/metrics.h"

namespace caustics::experiments {

const char* const tone_mapping_rule =
    "sRGB(clamp(radiance * 2^exposure)); without --exposure the 99th percentile of luminance over "
    "lit pixels becomes white";

namespace {

constexpr int gap = 2;  // pixels between the pictures of a strip

double luminance(const Spectrum& s) {
    const SpectrumSum v = s.cast<double>();
    return 0.2126 * v[0] + 0.7152 * v[1] + 0.0722 * v[2];
}

// IEC 61966-2-1.
unsigned char srgb(double linear) {
    const double v = std::clamp(linear, 0.0, 1.0);
    const double encoded = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
    return static_cast<unsigned char>(std::lround(255 * encoded));
}

void append(Picture& picture, double r, double g, double b) {
    for (const double channel : {r, g, b}) picture.rgb.push_back(srgb(channel));
}

}  // namespace

Film read_caustic(const std::filesystem::path& file) {
    Film film = read_exr(file);
    if (!film.has_layer("caustic")) throw InputError(file.string() + ": has no layer \"caustic\"");
    return film;
}

double auto_exposure(const Film& film, const std::string& layer) {
    std::vector<double> lit;
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        const double value = luminance(film.rgb(layer, i));
        if (value > 0) lit.push_back(value);
    }
    if (lit.empty()) return 0;
    const auto at = lit.begin() + static_cast<std::ptrdiff_t>((lit.size() - 1) * 99 / 100);
    std::nth_element(lit.begin(), at, lit.end());
    return -std::log2(*at);
}

Picture tone_map(const Film& film, const std::string& layer, double exposure) {
    Picture picture{film.width(), film.height(), {}};
    const double scale = std::exp2(exposure);
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        const SpectrumSum v = film.rgb(layer, i).cast<double>() * scale;
        append(picture, v[0], v[1], v[2]);
    }
    return picture;
}

Picture signed_error(const Film& film, const Film& reference, const std::string& layer,
                     double scale) {
    Picture picture{film.width(), film.height(), {}};
    const PixelMask reached = reached_pixels(film, reference);
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        if (!reached[i]) {
            append(picture, 0.2, 0.2, 0.2);
            continue;
        }
        const SpectrumSum difference =
            film.rgb(layer, i).cast<double>() - reference.rgb(layer, i).cast<double>();
        const double t = std::clamp(difference.sum() / 3 / scale, -1.0, 1.0);
        const double fade = 1 - std::abs(t);
        if (t >= 0)
            append(picture, 1 - 0.3 * t, fade, fade);
        else
            append(picture, fade, fade, 1 + 0.3 * t);
    }
    return picture;
}

Picture strip(const Film& film, const Film& reference, const std::string& layer) {
    const double exposure = auto_exposure(reference, layer);
    const std::array<Picture, 3> parts = {
        tone_map(reference, layer, exposure), tone_map(film, layer, exposure),
        signed_error(film, reference, layer, std::exp2(-exposure) / 4)};
    Picture all{3 * film.width() + 2 * gap, film.height(), {}};
    const std::ptrdiff_t row_bytes = 3 * static_cast<std::ptrdiff_t>(film.width());
    for (int y = 0; y < film.height(); ++y)
        for (const Picture& part : parts) {
            if (&part != parts.data()) all.rgb.insert(all.rgb.end(), 3 * gap, 128);
            const auto row = part.rgb.begin() + y * row_bytes;
            all.rgb.insert(all.rgb.end(), row, row + row_bytes);
        }
    return all;
}

void require_png(const std::string& option, const std::string& file, const std::string& what) {
    if (std::filesystem::path(file).extension() != ".png")
        throw InputError(fmt::format("{} {}: {} are drawn as .png", option, file, what));
    require_writable_place(file);
}

void write_png(const Picture& picture, const std::filesystem::path& file) {
    caustics::write_png(picture.width, picture.height, picture.rgb, file);
}

}  // namespace caustics::experiments
