#pragma once

#include <stddef.h>
#include <stdint.h>

namespace caustics {

/// What the loops of emission share, which are written for several instruction sets: plain data, so
/// that a source compiled for wide registers includes no inline code of Eigen or the standard library.

/// Paths first, first + 1, ... of a stage (core/math/rng.h).
struct ConsecutivePaths {
    uint64_t seed;
    uint32_t stage;
    uint64_t first;
    size_t count;
};

/// A cone of directions round n, with the frame (s, t, n).
struct EmissionCone {
    float one_minus_cos;  ///< of its half angle
    float s[3], t[3], n[3];
};

/// Points of the unit square, each aimed at a cone of its own.
struct EmissionAims {
    size_t count;
    const double* x;
    const double* y;
    const EmissionCone* cones;
    const uint32_t* cone;  ///< of each point
};

/// On the unit disc, and within the cone in the world's frame.
struct AimedPoints {
    float* disc[2];
    float* direction[3];
};

/// The loops, for one instruction set. Every set gives the same bits.
struct EmissionKernels {
    /// The first four words of the paths' random numbers.
    void (*first_words)(const ConsecutivePaths&, uint32_t* const words[4]);
    void (*aim)(const EmissionAims&, const AimedPoints&);
};

const EmissionKernels& plain_emission_kernels();
const EmissionKernels& avx2_emission_kernels();
const EmissionKernels& avx512_emission_kernels();

}  // namespace caustics
