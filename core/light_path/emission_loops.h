#pragma once

#include "core/light_path/emission_kernels.h"
#include "core/math/philox.h"
#include "core/math/warp.h"

namespace caustics {

/// The loops of emission, compiled once for each instruction set: over arrays and without branches,
/// so that the compiler puts as many paths into a register as fit. `static`, because every source
/// that includes them has its own. No two arrays overlap (ivdep).

static void first_words_of_paths(const ConsecutivePaths& paths, uint32_t* const words[4]) {
    const uint32_t key0 = static_cast<uint32_t>(paths.seed);
    const uint32_t key1 = static_cast<uint32_t>(paths.seed >> 32U);
    const uint32_t stage = paths.stage;
    const uint64_t first = paths.first;
    uint32_t* const word0 = words[0];
    uint32_t* const word1 = words[1];
    uint32_t* const word2 = words[2];
    uint32_t* const word3 = words[3];
    const size_t count = paths.count;
#pragma GCC ivdep
    for (size_t i = 0; i < count; ++i) {
        const uint64_t path = first + i;
        uint32_t counter[4] = {0, stage, static_cast<uint32_t>(path),
                               static_cast<uint32_t>(path >> 32U)};
        philox4x32(counter, key0, key1);
        word0[i] = counter[0];
        word1[i] = counter[1];
        word2[i] = counter[2];
        word3[i] = counter[3];
    }
}

static void aim_points(const EmissionAims& aims, const AimedPoints& aimed) {
    const double* const u0 = aims.x;
    const double* const u1 = aims.y;
    const uint32_t* const cone = aims.cone;
    const EmissionCone* const cones = aims.cones;
    float* const disc_x = aimed.disc[0];
    float* const disc_y = aimed.disc[1];
    float* const x = aimed.direction[0];
    float* const y = aimed.direction[1];
    float* const z = aimed.direction[2];
    const size_t count = aims.count;
#pragma GCC ivdep
    for (size_t i = 0; i < count; ++i) {
        float p = 0, q = 0;
        map_to_disc(static_cast<float>(u0[i]), static_cast<float>(u1[i]), p, q);
        disc_x[i] = p;
        disc_y[i] = q;
        const EmissionCone& at = cones[cone[i]];
        float local[3];
        map_to_cap(at.one_minus_cos, p, q, local);
        x[i] = at.s[0] * local[0] + at.t[0] * local[1] + at.n[0] * local[2];
        y[i] = at.s[1] * local[0] + at.t[1] * local[1] + at.n[1] * local[2];
        z[i] = at.s[2] * local[0] + at.t[2] * local[1] + at.n[2] * local[2];
    }
}

static constexpr EmissionKernels emission_loops{&first_words_of_paths, &aim_points};

}  // namespace caustics
