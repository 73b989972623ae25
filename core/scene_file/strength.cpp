#include "core/scene_file/strength.h"

#include <fmt/format.h>

#include "core/scene_file/values.h"

namespace caustics::scene_file {
namespace {

// Of a number or of each in an array.
void require_strong(const JsonNode& node) {
    constexpr double faintest = 1e-30;
    if (node.is_array())
        for (const JsonNode& channel : node.as_array()) require_strong(channel);
    else if (const double value = node.as_number(); value > 0 && value < faintest)
        node.fail(
            fmt::format("{} is out of range (0, or from {} to {})", value, faintest, unlimited));
}

}  // namespace

Spectrum read_strength(const JsonNode& parent, const std::string& key) {
    const Spectrum value = read_colour(parent, key, 1, unlimited);
    if (const auto node = parent.find(key))
        require_strong(node->is_object() ? node->at("value") : *node);
    return value;
}

KeyText strength(const std::string& key, const std::string& meaning, const std::string& unit) {
    return colour(key, meaning, unit, "1", "0, or 1e-30 to 1e+30");
}

}  // namespace caustics::scene_file
