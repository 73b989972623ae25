#pragma once

#include <cstddef>
#include <cstdint>

namespace caustics::bench {

/// One receiver point and its photons, as plain numbers.
struct ScalarQuery {
    const std::uint32_t* energy;     ///< rgbe, red in the lowest byte
    const std::uint16_t* direction;  ///< theta in the lower byte, phi in the upper
    std::size_t count;
    float normal[3];
    float wo[3];
    float alpha;  ///< of Schlick's law; the exponent of Phong's
};

/// Sum over the photons of Schlick's f_r x flux, [J96, eqs. 5-6] written down as they are read:
/// sine and cosine by libm, powers by ldexp, the half vector normalised.
void shade_by_libm(const ScalarQuery& query, float* rgb);

/// The same with sines and cosines from two tables of 256 entries, powers of two from a third.
void shade_by_tables(const ScalarQuery& query, float* rgb);

/// Phong's law with k_d = k_s = 1/2 and the exponent `alpha`: directions by tables, powers by libm.
void shade_phong(const ScalarQuery& query, float* rgb);

}  // namespace caustics::bench
