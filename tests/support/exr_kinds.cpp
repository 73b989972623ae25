#include "tests/support/exr_kinds.h"

#include <cstdint>
#include <cstring>

namespace caustics::support {

namespace {

constexpr std::int32_t side = 2;

template <typename Value>
std::string raw(const Value& value) {
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    return bytes;
}

std::string terminated(const std::string& text) { return text + '\0'; }

std::string attribute(const std::string& name, const std::string& type, const std::string& value) {
    return terminated(name) + terminated(type) + raw(static_cast<std::int32_t>(value.size())) +
           value;
}

std::string channel_list(const ExrKind& kind) {
    std::string list;
    for (const std::string& name : kind.channels)
        list += terminated(name) + raw(std::int32_t{kind.whole_numbers ? 0 : 2}) +
                std::string(4, '\0') + raw(std::int32_t{1}) + raw(std::int32_t{1});
    return list + '\0';
}

std::string header(const ExrKind& kind, int part) {
    const std::string window = raw(std::array<std::int32_t, 4>{0, 0, side - 1, side - 1});
    std::string bytes = attribute("channels", "chlist", channel_list(kind)) +
                        attribute("compression", "compression", std::string(1, '\0')) +
                        attribute("dataWindow", "box2i", window) +
                        attribute("displayWindow", "box2i", window) +
                        attribute("lineOrder", "lineOrder", std::string(1, '\0')) +
                        attribute("pixelAspectRatio", "float", raw(1.0F)) +
                        attribute("screenWindowCenter", "v2f", raw(std::array<float, 2>{})) +
                        attribute("screenWindowWidth", "float", raw(1.0F));
    if (kind.chromaticities)
        bytes += attribute("chromaticities", "chromaticities", raw(*kind.chromaticities));
    if (kind.parts > 1)
        bytes += attribute("name", "string", "part" + std::to_string(part)) +
                 attribute("type", "string", "scanlineimage") +
                 attribute("chunkCount", "int", raw(side));
    return bytes + '\0';
}

}  // namespace

std::string exr_of_kind(const ExrKind& kind) {
    constexpr std::int32_t magic = 20000630;
    constexpr std::int32_t version = 2;
    constexpr std::int32_t many_parts = 0x1000;
    std::string bytes = raw(magic) + raw(kind.parts > 1 ? version | many_parts : version);
    for (int part = 0; part < kind.parts; ++part) bytes += header(kind, part);
    if (kind.parts > 1) bytes += '\0';

    const std::string one = kind.whole_numbers ? raw(std::int32_t{1}) : raw(1.0F);
    std::string line;
    for (std::size_t value = 0; value < kind.channels.size() * side; ++value) line += one;
    std::string chunks;
    std::string places;
    const std::size_t first =
        bytes.size() + static_cast<std::size_t>(kind.parts * side) * sizeof(std::uint64_t);
    for (std::int32_t part = 0; part < kind.parts; ++part)
        for (std::int32_t y = 0; y < side; ++y) {
            places += raw(std::uint64_t{first + chunks.size()});
            if (kind.parts > 1) chunks += raw(part);
            chunks += raw(y) + raw(static_cast<std::int32_t>(line.size())) + line;
        }
    return bytes + places + chunks;
}

}  // namespace caustics::support
