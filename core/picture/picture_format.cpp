#include "core/picture/picture_format.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

#include "core/picture/exr_file.h"
#include "core/picture/png_file.h"

namespace caustics {
namespace {

using namespace std::string_view_literals;

unsigned byte(const std::string& bytes, std::size_t at) {
    return static_cast<unsigned char>(bytes[at]);
}

bool is_one_of(unsigned value, std::initializer_list<unsigned> values) {
    return std::find(values.begin(), values.end(), value) != values.end();
}

// Targa has no mark at its beginning: the fields of its header have few values each.
bool is_targa(const std::string& bytes) {
    constexpr std::size_t header = 18;
    if (bytes.size() < header) return false;
    const unsigned has_map = byte(bytes, 1);
    const unsigned kind = byte(bytes, 2);
    const bool is_mapped = is_one_of(kind, {1, 9});
    return has_map <= 1 && is_one_of(kind, {1, 2, 3, 9, 10, 11}) && (!is_mapped || has_map == 1) &&
           is_one_of(byte(bytes, 7), {0, 15, 16, 24, 32}) &&
           is_one_of(byte(bytes, 16), {8, 15, 16, 24, 32}) && (byte(bytes, 17) & 0xC0U) == 0;
}

// With floats (PFM) too.
bool is_pnm(const std::string& bytes) {
    constexpr std::string_view kinds = "123456Ff";
    return bytes.size() > 2 && bytes[0] == 'P' && kinds.find(bytes[1]) != kinds.npos &&
           is_one_of(byte(bytes, 2), {' ', '\t', '\r', '\n', '#'});
}

}  // namespace

std::string picture_format(const std::string& bytes) {
    struct Mark {
        std::string_view begin;
        const char* format;
    };
    constexpr std::array marks = {Mark{"#?RADIANCE"sv, "hdr"},    Mark{"#?RGBE"sv, "hdr"},
                                  Mark{"\xFF\xD8\xFF"sv, "jpeg"}, Mark{"II*\0"sv, "tiff"},
                                  Mark{"MM\0*"sv, "tiff"},        Mark{"II+\0"sv, "tiff"},
                                  Mark{"MM\0+"sv, "tiff"}};
    if (is_png(bytes)) return "png";
    if (is_exr(bytes)) return "openexr";
    for (const Mark& mark : marks)
        if (bytes.starts_with(mark.begin)) return mark.format;
    if (is_pnm(bytes)) return "pnm";
    return is_targa(bytes) ? "targa" : "";
}

}  // namespace caustics
