#pragma once

namespace caustics {

/// Maps of the unit square in plain code, for loops in wide registers as well (always inlined, see
/// core/math/philox.h): no branches, the same bits from every instruction set.

/// The concentric map of the square onto the unit disc [Shirley and Chiu 1997]: equal areas stay
/// equal and neighbours stay neighbours, so that strata of the square are compact on the disc.
[[gnu::always_inline]] inline void map_to_disc(float u0, float u1, float& x, float& y) {
    const float a = 2 * u0 - 1;
    const float b = 2 * u1 - 1;
    const bool wide = (a < 0 ? -a : a) > (b < 0 ? -b : b);
    const float r = wide ? a : b;
    const float q = wide ? b : a;
    // Within a quarter of pi the Taylor series are good to 3e-8. In the middle all is 0.
    const float angle = 3.14159265358979323846F / 4 * q / (r == 0 ? 1 : r);
    const float x2 = angle * angle;
    const float sine =
        angle * (1 - x2 * (1.0F / 6 - x2 * (1.0F / 120 - x2 * (1.0F / 5040 - x2 / 362880))));
    const float cosine = 1 - x2 * (0.5F - x2 * (1.0F / 24 - x2 * (1.0F / 720 - x2 / 40320)));
    x = r * (wide ? cosine : sine);
    y = r * (wide ? sine : cosine);
}

/// The equal-area map of the unit disc onto the directions within an angle of +z, given as 1 - cos
/// (Lambert's azimuthal projection). A point on the rim may lie a rounding outside of it.
[[gnu::always_inline]] inline void map_to_cap(float one_minus_cos, float x, float y,
                                              float (&direction)[3]) {
    const float rounded = one_minus_cos * (x * x + y * y);
    const float height = rounded < 2 ? rounded : 2;  // below the pole -z a root has no value
    const float scale = __builtin_sqrtf(one_minus_cos * (2 - height));
    direction[0] = scale * x;
    direction[1] = scale * y;
    direction[2] = 1 - height;
}

}  // namespace caustics
