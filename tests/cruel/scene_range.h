#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <cstdlib>
#include <fstream>

namespace caustics::cruel {

/// Which random scenes a test tries: `count` seeds from `first` on.
struct SceneRange {
    std::uint64_t first = 1;
    std::uint64_t count = 0;
    const char* table = nullptr;  ///< a file for what was found, or none

    /// As the environment asks (CAUSTICS_CRUEL_FIRST, CAUSTICS_CRUEL_COUNT, CAUSTICS_CRUEL_TABLE), else so few.
    static SceneRange asked(std::uint64_t few) {
        const auto setting = [](const char* name, std::uint64_t otherwise) {
            const char* const text = std::getenv(name);
            return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
        };
        return {setting("CAUSTICS_CRUEL_FIRST", 1), setting("CAUSTICS_CRUEL_COUNT", few),
                std::getenv("CAUSTICS_CRUEL_TABLE")};
    }

    /// Adds a line to the table.
    template <class... Args>
    void note(fmt::format_string<Args...> line, Args&&... args) const {
        if (table == nullptr) return;
        std::ofstream(table, std::ios::app)
            << fmt::format(line, std::forward<Args>(args)...) << '\n';
    }
};

}  // namespace caustics::cruel
