#pragma once

#include <immintrin.h>
#include <stddef.h>
#include <stdint.h>

namespace caustics::photonmap {

/// PlainSimd, eight at a time.
struct Avx2Lanes {
    static constexpr size_t width = 8;
    using Floats = __m256;
    using Words = __m256i;

    static Floats load(const float* from) { return _mm256_loadu_ps(from); }
    static Words load(const uint32_t* from) {
        return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
    }
    static Words load_halves(const uint16_t* from) {
        return _mm256_cvtepu16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(from)));
    }
    static Floats all(float value) { return _mm256_set1_ps(value); }
    static Words counting_from(uint32_t first) {
        return _mm256_add_epi32(_mm256_set1_epi32(static_cast<int>(first)),
                                _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7));
    }
    static void store(float* to, Floats a) { _mm256_storeu_ps(to, a); }
    static void store(uint32_t* to, Words a) {
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), a);
    }
    static Words whole(Floats a) { return _mm256_cvttps_epi32(a); }
    static Words no_words() { return _mm256_setzero_si256(); }
    static Words add_where(uint32_t mask, Words a, Words b) {
        return _mm256_add_epi32(a, _mm256_and_si256(all_bits(mask), b));
    }
    static uint32_t sum(Words a) {
        __m128i b = _mm_add_epi32(_mm256_castsi256_si128(a), _mm256_extracti128_si256(a, 1));
        b = _mm_add_epi32(b, _mm_shuffle_epi32(b, _MM_SHUFFLE(1, 0, 3, 2)));
        b = _mm_add_epi32(b, _mm_shuffle_epi32(b, _MM_SHUFFLE(2, 3, 0, 1)));
        return static_cast<uint32_t>(_mm_cvtsi128_si32(b));
    }
    static Floats add(Floats a, Floats b) { return _mm256_add_ps(a, b); }
    static Floats sub(Floats a, Floats b) { return _mm256_sub_ps(a, b); }
    static Floats mul(Floats a, Floats b) { return _mm256_mul_ps(a, b); }
    static Floats div(Floats a, Floats b) { return _mm256_div_ps(a, b); }
    static Floats sqrt(Floats a) { return _mm256_sqrt_ps(a); }
    static Floats min(Floats a, Floats b) { return _mm256_min_ps(a, b); }
    static Floats max(Floats a, Floats b) { return _mm256_max_ps(a, b); }
    static uint32_t less(Floats a, Floats b) { return bits(_mm256_cmp_ps(a, b, _CMP_LT_OQ)); }
    static uint32_t not_above(Floats a, Floats b) { return bits(_mm256_cmp_ps(a, b, _CMP_LE_OQ)); }
    static Floats split(Floats a, Floats* mantissa) {
        const __m256i word = _mm256_castps_si256(a);
        const __m256i least = _mm256_castps_si256(all(0.70710678F));
        const __m256i e = _mm256_srai_epi32(_mm256_sub_epi32(word, least), 23);
        *mantissa = _mm256_castsi256_ps(_mm256_sub_epi32(word, _mm256_slli_epi32(e, 23)));
        return _mm256_cvtepi32_ps(e);
    }
    static Floats times_power_of_2(Floats a, Floats shifted) {
        const __m256i power = _mm256_slli_epi32(_mm256_castps_si256(shifted), 23);
        return _mm256_castsi256_ps(_mm256_add_epi32(_mm256_castps_si256(a), power));
    }
    static size_t count(uint32_t mask) { return static_cast<size_t>(_mm_popcnt_u32(mask)); }
    /// What comparisons say, where it chooses only: its bits need not leave the registers.
    using Choice = __m256;
    static Choice is_less(Floats a, Floats b) { return _mm256_cmp_ps(a, b, _CMP_LT_OQ); }
    static Choice is_equal(Floats a, Floats b) { return _mm256_cmp_ps(a, b, _CMP_EQ_OQ); }
    static Floats chosen(Choice choice, Floats a, Floats b) {
        return _mm256_blendv_ps(b, a, choice);
    }
    static Floats where(uint32_t mask, Floats a, Floats b) {
        return _mm256_blendv_ps(b, a, _mm256_castsi256_ps(all_bits(mask)));
    }
    static void compress(float* to, uint32_t mask, Floats a) {
        _mm256_storeu_ps(to, _mm256_permutevar8x32_ps(a, lanes_of(mask)));
    }
    static void compress(uint32_t* to, uint32_t mask, Words a) {
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(to),
                            _mm256_permutevar8x32_epi32(a, lanes_of(mask)));
    }
    static void compress_halves(uint16_t* to, uint32_t mask, Words a) {
        const __m256i low = _mm256_and_si256(_mm256_permutevar8x32_epi32(a, lanes_of(mask)),
                                             _mm256_set1_epi32(0xFFFF));
        _mm_storeu_si128(
            reinterpret_cast<__m128i*>(to),
            _mm_packus_epi32(_mm256_castsi256_si128(low), _mm256_extracti128_si256(low, 1)));
    }
    static float least(Floats a) {
        __m128 b = _mm_min_ps(_mm256_castps256_ps128(a), _mm256_extractf128_ps(a, 1));
        b = _mm_min_ps(b, _mm_movehl_ps(b, b));
        return _mm_cvtss_f32(_mm_min_ss(b, _mm_shuffle_ps(b, b, 1)));
    }
    static float greatest(Floats a) {
        __m128 b = _mm_max_ps(_mm256_castps256_ps128(a), _mm256_extractf128_ps(a, 1));
        b = _mm_max_ps(b, _mm_movehl_ps(b, b));
        return _mm_cvtss_f32(_mm_max_ss(b, _mm_shuffle_ps(b, b, 1)));
    }

private:
    /// All bits of the masked lanes.
    static __m256i all_bits(uint32_t mask) {
        const __m256i lane_bits = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
        return _mm256_cmpeq_epi32(
            _mm256_and_si256(_mm256_set1_epi32(static_cast<int>(mask)), lane_bits), lane_bits);
    }
    static uint32_t bits(__m256 mask) { return static_cast<uint32_t>(_mm256_movemask_ps(mask)); }

    /// For each mask its lanes in order.
    struct CompressTable {
        alignas(8) uint8_t lanes[256][8];
        constexpr CompressTable() : lanes{} {
            for (unsigned mask = 0; mask < 256; ++mask) {
                unsigned count = 0;
                for (unsigned lane = 0; lane < 8; ++lane)
                    if ((mask >> lane & 1U) != 0) lanes[mask][count++] = static_cast<uint8_t>(lane);
            }
        }
    };
    static __m256i lanes_of(uint32_t mask) {
        static constexpr CompressTable table;
        return _mm256_cvtepu8_epi32(
            _mm_loadl_epi64(reinterpret_cast<const __m128i*>(table.lanes[mask])));
    }
};

}  // namespace caustics::photonmap
