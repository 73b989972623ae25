#pragma once

#include <cstdint>
#include <cstdlib>

namespace caustics::cruel {

/// Which random scenes a test tries: `count` seeds from `first` on.
struct SceneRange {
    std::uint64_t first = 1;
    std::uint64_t count = 0;

    /// As the environment asks (CAUSTICS_CRUEL_FIRST, CAUSTICS_CRUEL_COUNT), else so few.
    static SceneRange asked(std::uint64_t few) {
        const auto setting = [](const char* name, std::uint64_t otherwise) {
            const char* const text = std::getenv(name);
            return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
        };
        return {setting("CAUSTICS_CRUEL_FIRST", 1), setting("CAUSTICS_CRUEL_COUNT", few)};
    }
};

}  // namespace caustics::cruel
