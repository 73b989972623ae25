#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace caustics {

/// 64-bit FNV-1a (Fowler, Noll, Vo), continued from `state`.
constexpr std::uint64_t fnv1a(std::string_view bytes, std::uint64_t state = 0xcbf29ce484222325ULL) {
    for (const char c : bytes) {
        state ^= static_cast<unsigned char>(c);
        state *= 0x100000001b3ULL;
    }
    return state;
}

/// 16 hexadecimal digits.
std::string hex(std::uint64_t value);

}  // namespace caustics
