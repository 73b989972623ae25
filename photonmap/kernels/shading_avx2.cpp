#include <immintrin.h>

#include "photonmap/kernels/disc_loop.h"
#include "photonmap/kernels/filter_loop.h"
#include "photonmap/kernels/phong_loop.h"
#include "photonmap/kernels/simd_avx2.h"
#include "photonmap/kernels/square_loop.h"

namespace caustics::photonmap {

namespace {

using Floats = __m256;
using Words = __m256i;

Floats all(float value) { return _mm256_set1_ps(value); }
Floats product(Floats a, Floats b) { return _mm256_mul_ps(a, b); }
Floats sum(Floats a, Floats b) { return _mm256_add_ps(a, b); }

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

/// Two entries of a table side by side.
__m128 pair(const SineCosine* table, unsigned first, unsigned second) {
    const __m128i low = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(table + first));
    return _mm_loadh_pi(_mm_castsi128_ps(low), reinterpret_cast<const __m64*>(table + second));
}

/// Eight entries, which are bytes 0, 2, 4, ... of `cells`. Loads one by one are faster than gathers
/// of eight on many processors, and never slower by much.
[[gnu::always_inline]] inline Angles look_up(const SineCosine* table, uint64_t low, uint64_t high) {
    const auto cell = [](uint64_t cells, int i) {
        return static_cast<unsigned>(cells >> (16 * i)) & 255U;
    };
    // Shuffles stay within a register's halves: photons 0 1 | 4 5 and 2 3 | 6 7 become 0 to 7.
    const Floats a = _mm256_set_m128(pair(table, cell(high, 0), cell(high, 1)),
                                     pair(table, cell(low, 0), cell(low, 1)));
    const Floats b = _mm256_set_m128(pair(table, cell(high, 2), cell(high, 3)),
                                     pair(table, cell(low, 2), cell(low, 3)));
    return {_mm256_shuffle_ps(a, b, _MM_SHUFFLE(2, 0, 2, 0)),
            _mm256_shuffle_ps(a, b, _MM_SHUFFLE(3, 1, 3, 1))};
}

[[gnu::always_inline]] inline Vectors directions(const DirectionTables& tables,
                                                 const uint16_t* code) {
    const __m128i codes = _mm_loadu_si128(reinterpret_cast<const __m128i*>(code));
    const auto low = static_cast<uint64_t>(_mm_cvtsi128_si64(codes));
    const auto high = static_cast<uint64_t>(_mm_extract_epi64(codes, 1));
    const Angles theta = look_up(tables.theta, low, high);
    const Angles phi = look_up(tables.phi, low >> 8, high >> 8);
    return {product(theta.sine, phi.cosine), product(theta.sine, phi.sine), theta.cosine};
}

/// All bits set in the lanes of photons that count.
Floats counted(const ShadedPhotons& photons, size_t i) {
    const size_t left = photons.count - i;
    const size_t left_out = photons.left_out - i;
    const Words lane = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    const Words end = _mm256_set1_epi32(left < 8 ? static_cast<int>(left) : 8);
    const Words hole = _mm256_set1_epi32(left_out < 8 ? static_cast<int>(left_out) : 8);
    return _mm256_castsi256_ps(
        _mm256_andnot_si256(_mm256_cmpeq_epi32(lane, hole), _mm256_cmpgt_epi32(end, lane)));
}

Floats facing(Floats lanes, Floats v_in) {
    return _mm256_and_ps(lanes, _mm256_cmp_ps(v_in, all(0), _CMP_GT_OQ));
}

/// Of values in double: a lane for every eighth.
class Sum {
public:
    void add(Floats values) {
        low_ = _mm256_add_pd(low_, _mm256_cvtps_pd(_mm256_castps256_ps128(values)));
        high_ = _mm256_add_pd(high_, _mm256_cvtps_pd(_mm256_extractf128_ps(values, 1)));
    }
    double total() const {
        const __m256d four = _mm256_add_pd(low_, high_);
        const __m128d two =
            _mm_add_pd(_mm256_castpd256_pd128(four), _mm256_extractf128_pd(four, 1));
        return _mm_cvtsd_f64(_mm_add_sd(two, _mm_unpackhi_pd(two, two)));
    }

private:
    __m256d low_ = _mm256_setzero_pd();
    __m256d high_ = _mm256_setzero_pd();
};

/// Sums of energies.
class Sums {
public:
    void add(const ShadedPhotons& photons, size_t i, Floats lanes, Floats factor) {
        add(photons, i, lanes, Vectors{factor, factor, factor});
    }
    /// A factor for each channel.
    void add(const ShadedPhotons& photons, size_t i, Floats lanes, const Vectors& factor) {
        const Words energy =
            _mm256_loadu_si256(reinterpret_cast<const __m256i*>(photons.energy + i));
        const Words byte = _mm256_set1_epi32(255);
        // 2^(exponent - 136) in two factors, because the smallest are no normal floats.
        const Words power = _mm256_slli_epi32(_mm256_srli_epi32(energy, 24), 23);
        const Floats scale = product(_mm256_castsi256_ps(power), all(0x1p-9F));
        const Floats weight =
            photons.weight != nullptr ? _mm256_loadu_ps(photons.weight + i) : all(1);
        const auto unit = [&](Floats by) {
            return _mm256_and_ps(lanes, product(product(by, weight), scale));
        };
        const Words red = _mm256_and_si256(energy, byte);
        const Words green = _mm256_and_si256(_mm256_srli_epi32(energy, 8), byte);
        const Words blue = _mm256_and_si256(_mm256_srli_epi32(energy, 16), byte);
        red_.add(product(unit(factor.x), _mm256_cvtepi32_ps(red)));
        green_.add(product(unit(factor.y), _mm256_cvtepi32_ps(green)));
        blue_.add(product(unit(factor.z), _mm256_cvtepi32_ps(blue)));
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
    for (size_t i = 0; i < photons.count; i += 8) sums.add(photons, i, counted(photons, i), all(1));
    sums.add_to(rgb);
}

void add_facing(const DirectionTables& tables, const Lobe& lobe, const ShadedPhotons& photons,
                double* rgb) {
    const Vectors n = all_of(lobe.normal);
    Sums sums;
    for (size_t i = 0; i < photons.count; i += 8) {
        const Floats v_in = dot(n, directions(tables, photons.direction + i));
        sums.add(photons, i, facing(counted(photons, i), v_in), all(1));
    }
    sums.add_to(rgb);
}

/// The formula of schlick_factor.
void add_schlick(const DirectionTables& tables, const Lobe& lobe, const ShadedPhotons& photons,
                 double* rgb) {
    const Vectors n = all_of(lobe.normal), tangent = all_of(lobe.tangent);
    const Vectors bitangent = all_of(lobe.bitangent), wo = all_of(lobe.wo);
    const Floats alpha = all(lobe.alpha), one = all(1);
    const Floats u = all(1 - lobe.cosine);
    const Floats d = all(lobe.cosine + lobe.alpha * (1 - lobe.cosine));
    Sums sums;
    for (size_t i = 0; i < photons.count; i += 8) {
        const Vectors wi = directions(tables, photons.direction + i);
        const Floats v_in = dot(n, wi);
        const Vectors s{sum(wo.x, wi.x), sum(wo.y, wi.y), sum(wo.z, wi.z)};
        const Floats across = dot(tangent, s);
        const Floats aside = dot(bitangent, s);
        const Floats along = dot(n, s);
        const Floats sine2 = sum(product(across, across), product(aside, aside));
        const Floats square = sum(sine2, product(along, along));
        const Floats spread =
            sum(product(alpha, square), product(_mm256_sub_ps(one, alpha), sine2));
        const Floats peak = _mm256_div_ps(square, sum(spread, spread));
        const Floats u_in = _mm256_sub_ps(one, v_in);
        const Floats d_in = sum(v_in, product(alpha, u_in));
        const Floats numerator = sum(sum(product(u, v_in), product(u_in, d)), product(peak, peak));
        sums.add(photons, i, facing(counted(photons, i), v_in), _mm256_div_ps(numerator, d_in));
    }
    sums.add_to(rgb);
}

/// What PhongLoop asks for.
struct PhongSet {
    using Lanes = Avx2Lanes;
    using Vectors = photonmap::Vectors;
    using Sums = photonmap::Sums;
    using Mask = Floats;
    [[gnu::always_inline]] static Vectors directions(const DirectionTables& tables,
                                                     const uint16_t* code) {
        return photonmap::directions(tables, code);
    }
    static Mask facing(const ShadedPhotons& photons, size_t i, Floats v_in) {
        return photonmap::facing(counted(photons, i), v_in);
    }
};

}  // namespace

const ShadingKernels avx2_shading{add_arriving,
                                  add_facing,
                                  add_schlick,
                                  PhongLoop<PhongSet>::add,
                                  weigh_photons<Avx2Lanes>,
                                  SquareLoop<Avx2Lanes>::weigh,
                                  DiscLoop<Avx2Lanes>::weigh,
                                  DiscLoop<Avx2Lanes>::weigh_on_cell};

}  // namespace caustics::photonmap
