#include "core/picture/exr_header.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "core/base/printable.h"

namespace caustics {
namespace {

constexpr std::size_t magic_and_version = 8;
constexpr std::size_t channel_bytes = 16;  // behind its name

/// Types that the library reads without asking for their length.
struct Length {
    std::string_view type;
    std::size_t bytes;
};
constexpr std::array<Length, 24> lengths = {
    {{"box2f", 16},      {"box2i", 16},   {"chromaticities", 32},
     {"compression", 1}, {"double", 8},   {"envmap", 1},
     {"float", 4},       {"int", 4},      {"keycode", 28},
     {"lineOrder", 1},   {"m33d", 72},    {"m33f", 36},
     {"m44d", 128},      {"m44f", 64},    {"rational", 8},
     {"tiledesc", 9},    {"timecode", 8}, {"v2d", 16},
     {"v2f", 8},         {"v2i", 8},      {"v3d", 24},
     {"v3f", 12},        {"v3i", 12},     {"deepImageState", 1}}};

/// What stands before the next NUL, which is taken away with it.
std::optional<std::string_view> take_word(std::string_view& rest) {
    const std::size_t end = rest.find('\0');
    if (end == std::string_view::npos) return {};
    const std::string_view word = rest.substr(0, end);
    rest.remove_prefix(end + 1);
    return word;
}

bool is_channel_list(std::string_view value) {
    for (;;) {
        const std::optional<std::string_view> name = take_word(value);
        if (!name) return false;
        if (name->empty()) return value.empty();
        if (value.size() < channel_bytes) return false;
        value.remove_prefix(channel_bytes);
    }
}

bool has_its_length(std::string_view type, std::string_view value) {
    if (type == "chlist") return is_channel_list(value);
    const auto* const known = std::ranges::find(lengths, type, &Length::type);
    return known == lengths.end() || known->bytes == value.size();
}

/// The library makes room for a whole tile, however small the picture is.
void require_small_tiles(std::string_view tile_description) {
    constexpr std::uint64_t most_pixels = 1 << 22;
    std::array<std::uint32_t, 2> sides{};
    std::memcpy(sides.data(), tile_description.data(), sizeof sides);
    if (std::uint64_t{sides[0]} * sides[1] > most_pixels)
        throw std::runtime_error("its tiles have " + std::to_string(sides[0]) + " x " +
                                 std::to_string(sides[1]) + " pixels, more than " +
                                 std::to_string(most_pixels));
}

/// Up to the empty name that ends a header. Whether it is there.
bool pass_header(std::string_view& rest) {
    for (;;) {
        const std::optional<std::string_view> name = take_word(rest);
        if (!name || name->empty()) return name.has_value();
        const std::optional<std::string_view> type = take_word(rest);
        std::int32_t length = 0;
        if (!type || rest.size() < sizeof length) return false;
        std::memcpy(&length, rest.data(), sizeof length);
        rest.remove_prefix(sizeof length);
        const auto bytes = static_cast<std::size_t>(length);
        if (length < 0 || bytes > rest.size())
            throw std::runtime_error("the file ends inside its attribute " + one_line(*name));
        if (!has_its_length(*type, rest.substr(0, bytes)))
            throw std::runtime_error("its attribute " + one_line(*name) + " has " +
                                     std::to_string(bytes) + " bytes, which no " + one_line(*type) +
                                     " has");
        if (*type == "tiledesc") require_small_tiles(rest);
        rest.remove_prefix(bytes);
    }
}

}  // namespace

void require_attributes_within(const std::string& bytes) {
    constexpr unsigned char many_parts = 0x10;  // of the second byte of the version
    if (bytes.size() < magic_and_version) return;
    std::string_view rest = std::string_view(bytes).substr(magic_and_version);
    const bool goes_on = (static_cast<unsigned char>(bytes[5]) & many_parts) != 0;
    // Headers of many parts end with an empty one.
    while (pass_header(rest) && goes_on && !rest.empty() && rest.front() != '\0') {}
}

}  // namespace caustics
