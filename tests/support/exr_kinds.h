#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace caustics::support {

/// What an OpenEXR file may say of its values.
struct ExrKind {
    std::vector<std::string> channels = {"B", "G", "R"};  ///< in the order of their names
    bool whole_numbers = false;                           ///< UINT rather than FLOAT
    std::optional<std::array<float, 8>> chromaticities = {};
    int parts = 1;
};

/// An OpenEXR file of 2 x 2 pixels, every value of which is 1, without compression.
std::string exr_of_kind(const ExrKind& kind);

}  // namespace caustics::support
