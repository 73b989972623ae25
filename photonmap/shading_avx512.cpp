#include <immintrin.h>

#include "photonmap/shading_kernel.h"

namespace caustics {

namespace {

using Floats = __m512;
using Words = __m512i;

Floats all(float value) { return _mm512_set1_ps(value); }
Floats product(Floats a, Floats b) { return _mm512_mul_ps(a, b); }
Floats sum(Floats a, Floats b) { return _mm512_add_ps(a, b); }

struct Vectors {
    Floats x, y, z;
};

Vectors all_of(const float* v) { return {all(v[0]), all(v[1]), all(v[2])}; }

Floats dot(const Vectors& a, const Vectors& b) {
    return sum(product(a.x, b.x), sum(product(a.y, b.y), product(a.z, b.z)));
}

struct Angles {
    Floats sine, cosine;
};

/// Sixteen entries, a pair at a time: half the loads of two gathers of floats.
Angles look_up(const SineCosine* table, Words cell) {
    const __m512i low = _mm512_i32gather_epi64(_mm512_castsi512_si256(cell), table, 8);
    const __m512i high = _mm512_i32gather_epi64(_mm512_extracti64x4_epi64(cell, 1), table, 8);
    const Words even = _mm512_setr_epi32(0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
    const Words odd = _mm512_add_epi32(even, _mm512_set1_epi32(1));
    const Floats a = _mm512_castsi512_ps(low);
    const Floats b = _mm512_castsi512_ps(high);
    return {_mm512_permutex2var_ps(a, even, b), _mm512_permutex2var_ps(a, odd, b)};
}

Vectors directions(const DirectionTables& tables, const uint16_t* code) {
    const Words cells =
        _mm512_cvtepu16_epi32(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(code)));
    const Angles theta = look_up(tables.theta, _mm512_and_si512(cells, _mm512_set1_epi32(255)));
    const Angles phi = look_up(tables.phi, _mm512_srli_epi32(cells, 8));
    return {product(theta.sine, phi.cosine), product(theta.sine, phi.sine), theta.cosine};
}

/// The lanes of photons that count.
__mmask16 counted(const ShadedPhotons& photons, size_t i) {
    const size_t left = photons.count - i;
    unsigned lanes = left >= 16 ? 0xFFFFU : (1U << left) - 1;
    if (photons.left_out - i < 16) lanes &= ~(1U << (photons.left_out - i));
    return static_cast<__mmask16>(lanes);
}

double total(Floats lanes) {
    const __m256 eight =
        _mm256_add_ps(_mm512_castps512_ps256(lanes), _mm512_extractf32x8_ps(lanes, 1));
    const __m128 four = _mm_add_ps(_mm256_castps256_ps128(eight), _mm256_extractf128_ps(eight, 1));
    const __m128 two = _mm_add_ps(four, _mm_movehl_ps(four, four));
    return static_cast<double>(_mm_cvtss_f32(_mm_add_ss(two, _mm_movehdup_ps(two))));
}

/// Sums of energies, a lane for every sixteenth photon.
class Sums {
public:
    void add(const ShadedPhotons& photons, size_t i, __mmask16 lanes, Floats factor) {
        const Words energy = _mm512_loadu_si512(photons.energy + i);
        const Words byte = _mm512_set1_epi32(255);
        // 2^(exponent - 136) in two factors, because the smallest are no normal floats.
        const Words power = _mm512_slli_epi32(_mm512_srli_epi32(energy, 24), 23);
        if (photons.weight != nullptr)
            factor = product(factor, _mm512_loadu_ps(photons.weight + i));
        const Floats scale = product(_mm512_castsi512_ps(power), all(0x1p-9F));
        const Floats unit = _mm512_maskz_mul_ps(lanes, factor, scale);
        const Words red = _mm512_and_si512(energy, byte);
        const Words green = _mm512_and_si512(_mm512_srli_epi32(energy, 8), byte);
        const Words blue = _mm512_and_si512(_mm512_srli_epi32(energy, 16), byte);
        red_ = sum(red_, product(unit, _mm512_cvtepi32_ps(red)));
        green_ = sum(green_, product(unit, _mm512_cvtepi32_ps(green)));
        blue_ = sum(blue_, product(unit, _mm512_cvtepi32_ps(blue)));
    }
    void add_to(double* rgb) const {
        rgb[0] += total(red_);
        rgb[1] += total(green_);
        rgb[2] += total(blue_);
    }

private:
    Floats red_ = _mm512_setzero_ps();
    Floats green_ = _mm512_setzero_ps();
    Floats blue_ = _mm512_setzero_ps();
};

void add_arriving(const DirectionTables&, const Lobe&, const ShadedPhotons& photons, double* rgb) {
    Sums sums;
    for (size_t i = 0; i < photons.count; i += 16)
        sums.add(photons, i, counted(photons, i), all(1));
    sums.add_to(rgb);
}

void add_facing(const DirectionTables& tables, const Lobe& lobe, const ShadedPhotons& photons,
                double* rgb) {
    const Vectors n = all_of(lobe.normal);
    Sums sums;
    for (size_t i = 0; i < photons.count; i += 16) {
        const Floats v_in = dot(n, directions(tables, photons.direction + i));
        sums.add(photons, i, _mm512_mask_cmp_ps_mask(counted(photons, i), v_in, all(0), _CMP_GT_OQ),
                 all(1));
    }
    sums.add_to(rgb);
}

/// The formula of schlick_factor.
void add_schlick(const DirectionTables& tables, const Lobe& lobe, const ShadedPhotons& photons,
                 double* rgb) {
    const Vectors n = all_of(lobe.normal), tangent = all_of(lobe.tangent);
    const Vectors bitangent = all_of(lobe.bitangent);
    const Floats alpha = all(lobe.alpha), one = all(1);
    const Floats u = all(1 - lobe.cosine);
    const Floats d = all(lobe.cosine + lobe.alpha * (1 - lobe.cosine));
    Sums sums;
    for (size_t i = 0; i < photons.count; i += 16) {
        const Vectors wi = directions(tables, photons.direction + i);
        const Floats v_in = dot(n, wi);
        const Floats across = sum(dot(tangent, wi), all(lobe.sine));
        const Floats aside = dot(bitangent, wi);
        const Floats along = sum(all(lobe.cosine), v_in);
        const Floats sine2 = sum(product(across, across), product(aside, aside));
        const Floats square = sum(sine2, product(along, along));
        const Floats spread =
            sum(product(alpha, square), product(_mm512_sub_ps(one, alpha), sine2));
        const Floats peak = _mm512_div_ps(square, sum(spread, spread));
        const Floats u_in = _mm512_sub_ps(one, v_in);
        const Floats d_in = sum(v_in, product(alpha, u_in));
        const Floats numerator = sum(sum(product(u, v_in), product(u_in, d)), product(peak, peak));
        const __mmask16 lanes =
            _mm512_mask_cmp_ps_mask(counted(photons, i), v_in, all(0), _CMP_GT_OQ);
        sums.add(photons, i, lanes, _mm512_div_ps(numerator, d_in));
    }
    sums.add_to(rgb);
}

}  // namespace

const ShadingKernels avx512_shading{add_arriving, add_facing, add_schlick};

}  // namespace caustics
