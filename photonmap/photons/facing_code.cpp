#include "photonmap/photons/facing_code.h"

#include <cmath>

namespace caustics::photonmap {

uint16_t facing_flags(const float (&normal)[3]) {
    constexpr float half = 44;
    const float sum = std::abs(normal[0]) + std::abs(normal[1]) + std::abs(normal[2]);
    if (!(sum > 0 && sum < 10)) return 0;
    float x = normal[0] / sum;
    float y = normal[1] / sum;
    if (normal[2] < 0) {
        const float folded = std::copysign(1 - std::abs(y), x);
        y = std::copysign(1 - std::abs(x), y);
        x = folded;
    }
    const auto u = static_cast<unsigned>(x * half + half + 0.5F);
    const auto v = static_cast<unsigned>(y * half + half + 0.5F);
    return static_cast<uint16_t>((1 + 89 * u + v) << facing_shift);
}

}  // namespace caustics::photonmap
