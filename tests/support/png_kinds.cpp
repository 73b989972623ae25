#include "tests/support/png_kinds.h"

#include <png.h>

#include <array>

namespace caustics::support {
namespace {

extern "C" void take_png_bytes(png_structp png, png_bytep from, std::size_t count) {
    static_cast<std::string*>(png_get_io_ptr(png))
        ->append(reinterpret_cast<const char*>(from), count);
}

extern "C" void nothing_to_flush(png_structp) {}

int type_of(PngKind::Colours colours) {
    switch (colours) {
        case PngKind::Colours::grey: return PNG_COLOR_TYPE_GRAY;
        case PngKind::Colours::palette: return PNG_COLOR_TYPE_PALETTE;
        case PngKind::Colours::grey_alpha: return PNG_COLOR_TYPE_GRAY_ALPHA;
        case PngKind::Colours::rgb: return PNG_COLOR_TYPE_RGB;
        case PngKind::Colours::rgb_alpha: break;
    }
    return PNG_COLOR_TYPE_RGB_ALPHA;
}

void put_palette(png_structp png, png_infop info, int bits) {
    std::array<png_color, 256> palette{};
    for (std::size_t i = 0; i < palette.size(); ++i)
        palette[i] = {static_cast<png_byte>(37 * i), static_cast<png_byte>(255 - i),
                      static_cast<png_byte>(11 * i)};
    png_set_PLTE(png, info, palette.data(), 1 << bits);
}

void put_transparency(png_structp png, png_infop info, PngKind::Colours colours) {
    std::array<png_byte, 2> alphas{0, 128};
    png_color_16 colour{0, 1, 1, 1, 1};
    const bool indexed = colours == PngKind::Colours::palette;
    png_set_tRNS(png, info, indexed ? alphas.data() : nullptr, indexed ? 2 : 0,
                 indexed ? nullptr : &colour);
}

/// A row as PNG keeps it: the first value in the highest bits.
std::vector<png_byte> packed(const std::uint16_t* values, std::size_t count, int bits) {
    std::vector<png_byte> row((count * static_cast<std::size_t>(bits) + 7) / 8);
    std::size_t at = 0;
    for (std::size_t i = 0; i < count; ++i)
        for (int bit = bits - 1; bit >= 0; --bit, ++at)
            if ((values[i] >> bit & 1) != 0)
                row[at / 8] = static_cast<png_byte>(row[at / 8] | (0x80U >> at % 8));
    return row;
}

}  // namespace

std::size_t PngKind::channels() const {
    switch (colours) {
        case Colours::grey_alpha: return 2;
        case Colours::rgb: return 3;
        case Colours::rgb_alpha: return 4;
        default: return 1;
    }
}

std::vector<PngKind> all_png_kinds() {
    using Colours = PngKind::Colours;
    std::vector<PngKind> kinds;
    for (const Colours colours :
         {Colours::grey, Colours::palette, Colours::grey_alpha, Colours::rgb, Colours::rgb_alpha})
        for (const int bits : {1, 2, 4, 8, 16}) {
            const bool narrow = colours == Colours::grey || colours == Colours::palette;
            if ((bits < 8 && !narrow) || (bits == 16 && colours == Colours::palette)) continue;
            for (int marks = 0; marks < 8; ++marks) {
                const bool transparent = (marks & 2) != 0;
                if (transparent &&
                    (colours == Colours::grey_alpha || colours == Colours::rgb_alpha))
                    continue;
                kinds.push_back({colours, bits, (marks & 1) != 0, transparent, (marks & 4) != 0});
            }
        }
    return kinds;
}

std::string png_of_kind(const PngKind& kind, int width, int height,
                        const std::vector<std::uint16_t>& values) {
    std::string bytes;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(png, &bytes, take_png_bytes, nothing_to_flush);
    png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height),
                 kind.bits, type_of(kind.colours),
                 kind.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (kind.colours == PngKind::Colours::palette) put_palette(png, info, kind.bits);
    if (kind.transparent) put_transparency(png, info, kind.colours);
    if (kind.has_gamma) png_set_gAMA(png, info, 1.0);
    png_write_info(png, info);
    const std::size_t row = static_cast<std::size_t>(width) * kind.channels();
    std::vector<std::vector<png_byte>> rows;
    std::vector<png_bytep> begins;
    for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y)
        rows.push_back(packed(&values[row * y], row, kind.bits));
    for (std::vector<png_byte>& each : rows) begins.push_back(each.data());
    png_write_image(png, begins.data());
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return bytes;
}

}  // namespace caustics::support
