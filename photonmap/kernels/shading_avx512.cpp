#include <immintrin.h>

#include "photonmap/kernels/disc_loop.h"
#include "photonmap/kernels/filter_loop.h"
#include "photonmap/kernels/phong_loop.h"
#include "photonmap/kernels/simd_avx512.h"
#include "photonmap/kernels/square_loop.h"

namespace caustics::photonmap {

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

__mmask16 has_bit(Words words, int bit) {
    return _mm512_test_epi32_mask(words, _mm512_set1_epi32(bit));
}

/// `words` with its lower bits turned round where `bit` is set: cells beyond the middle of the range
/// mirror those before it.
Words folded(Words words, int bit) {
    return _mm512_mask_xor_epi32(words, has_bit(words, bit), words, _mm512_set1_epi32(bit - 1));
}

/// Entries of a table of 32 floats by the lowest five bits.
Floats entry_of_32(const float* table, Words index) {
    return _mm512_permutex2var_ps(_mm512_load_ps(table), index, _mm512_load_ps(table + 16));
}
Floats entry_of_64(const float* table, Words index) {
    return _mm512_mask_blend_ps(has_bit(index, 32), entry_of_32(table, index),
                                entry_of_32(table + 32, index));
}
Floats entry_of_128(const float* table, Words index) {
    return _mm512_mask_blend_ps(has_bit(index, 64), entry_of_64(table, index),
                                entry_of_64(table + 64, index));
}

/// `values` with the sign turned where bit 7 of `words` is set.
Floats negated_by_bit_7(Floats values, Words words) {
    constexpr int first_xor_both_others = 0x78;
    return _mm512_castsi512_ps(_mm512_ternarylogic_epi32(
        _mm512_castps_si512(values), _mm512_slli_epi32(words, 24),
        _mm512_set1_epi32(static_cast<int>(0x80000000U)), first_xor_both_others));
}

/// Tables are looked up in registers: a gather loads its sixteen entries one by one.
[[gnu::always_inline]] inline Vectors directions(const DirectionTables& tables,
                                                 const uint16_t* code) {
    const Words cells =
        _mm512_cvtepu16_epi32(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(code)));
    const Words theta = folded(cells, 128);
    const Floats sine = entry_of_128(tables.theta_sine, theta);
    const Floats z = negated_by_bit_7(entry_of_128(tables.theta_cosine, theta), cells);
    const Words turn = _mm512_srli_epi32(cells, 8);
    const Words phi = folded(turn, 64);
    const Floats along_x = negated_by_bit_7(entry_of_64(tables.phi_cosine, phi),
                                            _mm512_xor_si512(turn, _mm512_slli_epi32(turn, 1)));
    const Floats along_y = negated_by_bit_7(entry_of_64(tables.phi_sine, phi), turn);
    return {product(sine, along_x), product(sine, along_y), z};
}

/// The lanes of photons that count.
__mmask16 counted(const ShadedPhotons& photons, size_t i) {
    const size_t left = photons.count - i;
    unsigned lanes = left >= 16 ? 0xFFFFU : (1U << left) - 1;
    if (photons.left_out - i < 16) lanes &= ~(1U << (photons.left_out - i));
    return static_cast<__mmask16>(lanes);
}

/// Of values in double: a lane for every eighth.
class Sum {
public:
    void add(Floats values) {
        eight_ = _mm512_add_pd(eight_, _mm512_cvtps_pd(_mm512_castps512_ps256(values)));
        eight_ = _mm512_add_pd(eight_, _mm512_cvtps_pd(_mm512_extractf32x8_ps(values, 1)));
    }
    double total() const {
        const __m256d four =
            _mm256_add_pd(_mm512_castpd512_pd256(eight_), _mm512_extractf64x4_pd(eight_, 1));
        const __m128d two =
            _mm_add_pd(_mm256_castpd256_pd128(four), _mm256_extractf128_pd(four, 1));
        return _mm_cvtsd_f64(_mm_add_sd(two, _mm_unpackhi_pd(two, two)));
    }

private:
    __m512d eight_ = _mm512_setzero_pd();
};

/// Sums of energies.
class Sums {
public:
    void add(const ShadedPhotons& photons, size_t i, __mmask16 lanes, Floats factor) {
        add(photons, i, lanes, Vectors{factor, factor, factor});
    }
    /// A factor for each channel.
    void add(const ShadedPhotons& photons, size_t i, __mmask16 lanes, const Vectors& factor) {
        const Words energy = _mm512_loadu_si512(photons.energy + i);
        const Words byte = _mm512_set1_epi32(255);
        // 2^(exponent - 136) in two factors, because the smallest are no normal floats.
        const Words power = _mm512_slli_epi32(_mm512_srli_epi32(energy, 24), 23);
        const Floats scale = product(_mm512_castsi512_ps(power), all(0x1p-9F));
        const Floats weight =
            photons.weight != nullptr ? _mm512_loadu_ps(photons.weight + i) : all(1);
        const auto unit = [&](Floats by) {
            return _mm512_maskz_mul_ps(lanes, product(by, weight), scale);
        };
        const Words red = _mm512_and_si512(energy, byte);
        const Words green = _mm512_and_si512(_mm512_srli_epi32(energy, 8), byte);
        const Words blue = _mm512_and_si512(_mm512_srli_epi32(energy, 16), byte);
        red_.add(product(unit(factor.x), _mm512_cvtepi32_ps(red)));
        green_.add(product(unit(factor.y), _mm512_cvtepi32_ps(green)));
        blue_.add(product(unit(factor.z), _mm512_cvtepi32_ps(blue)));
    }
    void add_to(double* rgb) const {
        rgb[0] += red_.total();
        rgb[1] += green_.total();
        rgb[2] += blue_.total();
    }

private:
    Sum red_, green_, blue_;
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
    const Floats alpha = all(lobe.alpha), one = all(1), zero = all(0);
    const Floats twice_alpha = all(2 * lobe.alpha), twice_rest = all(2 * (1 - lobe.alpha));
    const Vectors wo = all_of(lobe.wo);
    const Floats u = all(1 - lobe.cosine);
    const Floats d = all(lobe.cosine + lobe.alpha * (1 - lobe.cosine));
    Sums sums;
    for (size_t i = 0; i < photons.count; i += 16) {
        const Vectors wi = directions(tables, photons.direction + i);
        const Floats v_in = dot(n, wi);
        const Vectors s{sum(wo.x, wi.x), sum(wo.y, wi.y), sum(wo.z, wi.z)};
        const Floats across = dot(tangent, s);
        const Floats aside = dot(bitangent, s);
        const Floats along = dot(n, s);
        const Floats sine2 = sum(product(across, across), product(aside, aside));
        const Floats square = sum(sine2, product(along, along));
        const Floats twice_spread = sum(product(twice_alpha, square), product(twice_rest, sine2));
        const Floats peak = _mm512_div_ps(square, twice_spread);
        const Floats u_in = _mm512_sub_ps(one, v_in);
        const Floats d_in = sum(v_in, product(alpha, u_in));
        const Floats numerator = sum(sum(product(u, v_in), product(u_in, d)), product(peak, peak));
        const __mmask16 lanes =
            _mm512_mask_cmp_ps_mask(counted(photons, i), v_in, zero, _CMP_GT_OQ);
        sums.add(photons, i, lanes, _mm512_div_ps(numerator, d_in));
    }
    sums.add_to(rgb);
}

/// What PhongLoop asks for.
struct PhongSet {
    using Lanes = Avx512Lanes;
    using Vectors = photonmap::Vectors;
    using Sums = photonmap::Sums;
    using Mask = __mmask16;
    [[gnu::always_inline]] static Vectors directions(const DirectionTables& tables,
                                                     const uint16_t* code) {
        return photonmap::directions(tables, code);
    }
    static Mask facing(const ShadedPhotons& photons, size_t i, Floats v_in) {
        return _mm512_mask_cmp_ps_mask(counted(photons, i), v_in, all(0), _CMP_GT_OQ);
    }
};

}  // namespace

const ShadingKernels avx512_shading{add_arriving,
                                    add_facing,
                                    add_schlick,
                                    PhongLoop<PhongSet>::add,
                                    weigh_photons<Avx512Lanes>,
                                    SquareLoop<Avx512Lanes>::weigh,
                                    DiscLoop<Avx512Lanes>::weigh,
                                    DiscLoop<Avx512Lanes>::weigh_on_cell};

}  // namespace caustics::photonmap
