#include "core/base/hash.h"

namespace caustics {

std::string hex(std::uint64_t value) {
    constexpr char digits[] = "0123456789abcdef";
    std::string text(16, '0');
    for (std::size_t i = 0; i < 16; ++i) text[15 - i] = digits[value >> (4 * i) & 0xFU];
    return text;
}

}  // namespace caustics
