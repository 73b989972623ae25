#pragma once

#include <immintrin.h>
#include <stddef.h>
#include <stdint.h>

namespace caustics::photonmap {

/// PlainSimd, sixteen at a time.
struct Avx512Lanes {
    static constexpr size_t width = 16;
    using Floats = __m512;
    using Words = __m512i;

    static Floats load(const float* from) { return _mm512_loadu_ps(from); }
    static Words load(const uint32_t* from) { return _mm512_loadu_si512(from); }
    static Words load_halves(const uint16_t* from) {
        return _mm512_cvtepu16_epi32(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(from)));
    }
    static Floats all(float value) { return _mm512_set1_ps(value); }
    static Words counting_from(uint32_t first) {
        return _mm512_add_epi32(
            _mm512_set1_epi32(static_cast<int>(first)),
            _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15));
    }
    static void store(float* to, Floats a) { _mm512_storeu_ps(to, a); }
    static void store(uint32_t* to, Words a) { _mm512_storeu_si512(to, a); }
    static Words whole(Floats a) { return _mm512_cvttps_epi32(a); }
    static Words no_words() { return _mm512_setzero_si512(); }
    static Words add_where(uint32_t mask, Words a, Words b) {
        return _mm512_mask_add_epi32(a, static_cast<__mmask16>(mask), a, b);
    }
    static uint32_t sum(Words a) { return static_cast<uint32_t>(_mm512_reduce_add_epi32(a)); }
    static Floats add(Floats a, Floats b) { return _mm512_add_ps(a, b); }
    static Floats sub(Floats a, Floats b) { return _mm512_sub_ps(a, b); }
    static Floats mul(Floats a, Floats b) { return _mm512_mul_ps(a, b); }
    static Floats div(Floats a, Floats b) { return _mm512_div_ps(a, b); }
    static Floats sqrt(Floats a) { return _mm512_sqrt_ps(a); }
    static Floats min(Floats a, Floats b) { return _mm512_min_ps(a, b); }
    static Floats max(Floats a, Floats b) { return _mm512_max_ps(a, b); }
    static uint32_t less(Floats a, Floats b) { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
    static uint32_t not_above(Floats a, Floats b) { return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ); }
    static Floats split(Floats a, Floats* mantissa) {
        const __m512i word = _mm512_castps_si512(a);
        const __m512i least = _mm512_castps_si512(all(0.70710678F));
        const __m512i e = _mm512_srai_epi32(_mm512_sub_epi32(word, least), 23);
        *mantissa = _mm512_castsi512_ps(_mm512_sub_epi32(word, _mm512_slli_epi32(e, 23)));
        return _mm512_cvtepi32_ps(e);
    }
    static Floats times_power_of_2(Floats a, Floats shifted) {
        const __m512i power = _mm512_slli_epi32(_mm512_castps_si512(shifted), 23);
        return _mm512_castsi512_ps(_mm512_add_epi32(_mm512_castps_si512(a), power));
    }
    static size_t count(uint32_t mask) { return static_cast<size_t>(_mm_popcnt_u32(mask)); }
    /// What comparisons say, where it chooses only.
    using Choice = __mmask16;
    static Choice is_less(Floats a, Floats b) { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
    static Choice is_equal(Floats a, Floats b) { return _mm512_cmp_ps_mask(a, b, _CMP_EQ_OQ); }
    static Floats chosen(Choice choice, Floats a, Floats b) {
        return _mm512_mask_blend_ps(choice, b, a);
    }
    static Floats where(uint32_t mask, Floats a, Floats b) {
        return _mm512_mask_blend_ps(static_cast<__mmask16>(mask), b, a);
    }
    static void compress(float* to, uint32_t mask, Floats a) {
        _mm512_storeu_ps(to, _mm512_maskz_compress_ps(static_cast<__mmask16>(mask), a));
    }
    static void compress(uint32_t* to, uint32_t mask, Words a) {
        _mm512_storeu_si512(to, _mm512_maskz_compress_epi32(static_cast<__mmask16>(mask), a));
    }
    static void compress_halves(uint16_t* to, uint32_t mask, Words a) {
        const __m512i side_by_side = _mm512_maskz_compress_epi32(static_cast<__mmask16>(mask), a);
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm512_cvtepi32_epi16(side_by_side));
    }
    static float least(Floats a) { return _mm512_reduce_min_ps(a); }
    static float greatest(Floats a) { return _mm512_reduce_max_ps(a); }
};

}  // namespace caustics::photonmap
