#include "photonmap/progressive.h"

#include "core/math/rng.h"

namespace caustics::photonmap {

double pass_share(int pass) {
    constexpr double a = 2.0 / 3;
    double share = 1;
    for (int j = 1; j <= pass; ++j) share *= (j + a) / (j + 1);
    return share;
}

std::uint64_t pass_seed(std::uint64_t seed, int pass) {
    if (pass == 0) return seed;
    // No stage has this number, so that the words serve nothing else.
    constexpr std::uint32_t stage = 0xFFFFFFFFU;
    const auto words =
        philox4x32({static_cast<std::uint32_t>(pass), stage, 0, 0},
                   {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32U)});
    return std::uint64_t{words[1]} << 32U | words[0];
}

}  // namespace caustics::photonmap
