#pragma once

#include <stdint.h>

namespace caustics {

/// Philox4x32-10, the counter-based generator of Salmon et al., "Parallel Random Numbers: As Easy
/// as 1, 2, 3" (SC'11): turns a counter into four random words, a pure function of it and the key.
/// Plain code, for loops in wide registers as well; always inlined, so that no copy compiled for
/// those is left for the linker to take for all of the program.
[[gnu::always_inline]] inline void philox4x32(uint32_t (&counter)[4], uint32_t key0,
                                              uint32_t key1) {
    const uint64_t multiplier0 = 0xD2511F53U;
    const uint64_t multiplier1 = 0xCD9E8D57U;
    const uint32_t weyl0 = 0x9E3779B9U;
    const uint32_t weyl1 = 0xBB67AE85U;
#pragma GCC unroll 10
    for (int round = 0; round < 10; ++round) {
        const uint64_t product0 = multiplier0 * counter[0];
        const uint64_t product1 = multiplier1 * counter[2];
        counter[0] = static_cast<uint32_t>(product1 >> 32U) ^ counter[1] ^ key0;
        counter[1] = static_cast<uint32_t>(product1);
        counter[2] = static_cast<uint32_t>(product0 >> 32U) ^ counter[3] ^ key1;
        counter[3] = static_cast<uint32_t>(product0);
        key0 += weyl0;
        key1 += weyl1;
    }
}

}  // namespace caustics
