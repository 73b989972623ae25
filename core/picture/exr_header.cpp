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

/// Nothing where the value is no list of channels.
std::optional<std::size_t> count_channels(std::string_view value) {
    for (std::size_t count = 0;; ++count) {
        const std::optional<std::string_view> name = take_word(value);
        if (!name) return {};
        if (name->empty()) return value.empty() ? std::optional(count) : std::nullopt;
        if (value.size() < channel_bytes) return {};
        std::uint32_t type = 0;  // whole number, half, float
        std::memcpy(&type, value.data(), sizeof type);
        // OpenImageIO ends the program.
        if (type > 2)
            throw std::runtime_error("its channel " + one_line(*name) +
                                     " has values of an unknown type, " + std::to_string(type));
        value.remove_prefix(channel_bytes);
    }
}

bool has_its_length(std::string_view type, std::string_view value) {
    if (type == "chlist") return count_channels(value).has_value();
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

/// What a header says of the picture's size.
struct Declared {
    std::array<std::int32_t, 4> window{0, 0, -1, -1};  ///< least x and y, most x and y
    std::size_t channels = 0;
    unsigned char compression = 0;

    void take(std::string_view name, std::string_view type, std::string_view value) {
        if (name == "dataWindow" && type == "box2i")
            std::memcpy(window.data(), value.data(), sizeof window);
        if (name == "channels" && type == "chlist") channels = *count_channels(value);
        if (type == "compression") compression = static_cast<unsigned char>(value[0]);
    }
};

/// A small file that declares many channels or pixels is broken or hostile: they would fill the memory before the
/// first missing line is met.
void require_room_for(const Declared& picture, std::size_t bytes) {
    constexpr double always_taken = 1 << 27;
    // Deflate makes 1,032 bytes of one at most, of half values that become twice as large. What is one colour takes no
    // room at all by wavelets and cosines (PIZ, DWAA, DWAB).
    constexpr double most_of_one = 2100;
    constexpr double most_of_one_by_waves = 1 << 16;
    const bool by_waves = picture.compression == 4 || picture.compression >= 8;
    const std::int64_t width = std::int64_t{1} + picture.window[2] - picture.window[0];
    const std::int64_t height = std::int64_t{1} + picture.window[3] - picture.window[1];
    const double room = sizeof(float) * static_cast<double>(picture.channels) *
                        static_cast<double>(width) * static_cast<double>(height);
    if (room > always_taken &&
        room > (by_waves ? most_of_one_by_waves : most_of_one) * static_cast<double>(bytes))
        throw std::runtime_error("it declares " + std::to_string(width) + " x " +
                                 std::to_string(height) + " pixels, more than its " +
                                 std::to_string(bytes) + " bytes can hold");
}

/// Up to the empty name that ends the header of a file of so many bytes. Whether it is there.
bool pass_header(std::string_view& rest, std::size_t file_bytes) {
    for (Declared picture;;) {
        const std::optional<std::string_view> name = take_word(rest);
        if (name && name->empty()) require_room_for(picture, file_bytes);
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
        picture.take(*name, *type, rest.substr(0, bytes));
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
    while (pass_header(rest, bytes.size()) && goes_on && !rest.empty() && rest.front() != '\0') {}
}

}  // namespace caustics
