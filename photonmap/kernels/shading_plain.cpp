#include <bit>
#include <cstring>

#include "photonmap/kernels/cosine_power.h"
#include "photonmap/kernels/disc_loop.h"
#include "photonmap/kernels/filter_loop.h"
#include "photonmap/kernels/simd_plain.h"
#include "photonmap/kernels/square_loop.h"

namespace caustics::photonmap {

namespace {

struct Direction {
    float x, y, z;
};

Direction decode(const DirectionTables& tables, uint8_t theta, uint8_t phi) {
    const SineCosine t = tables.theta[theta];
    const SineCosine p = tables.phi[phi];
    return {t.sine * p.cosine, t.sine * p.sine, t.cosine};
}

float dot(const float* a, const Direction& b) { return a[0] * b.x + (a[1] * b.y + a[2] * b.z); }

/// Adds up by halves.
double total(double* lanes) {
    for (size_t half = 4; half > 0; half /= 2)
        for (size_t i = 0; i < half; ++i) lanes[i] += lanes[i + half];
    return lanes[0];
}

/// A photon's factors by a function of (tables, lobe, theta, phi, rgb), which writes them.
template <typename Factors>
void add_coloured(const DirectionTables& tables, const Lobe& lobe, const ShadedPhotons& photons,
                  double* rgb, const Factors& write_factors) {
    double sums[3][8] = {};
    for (size_t i = 0; i < photons.count; ++i) {
        if (i == photons.left_out) continue;
        uint8_t energy[4], direction[2];
        std::memcpy(energy, photons.energy + i, 4);
        std::memcpy(direction, photons.direction + i, 2);
        // 2^(exponent - 136) in two factors, because the smallest are no normal floats.
        const float scale = std::bit_cast<float>(static_cast<uint32_t>(energy[3]) << 23U) * 0x1p-9F;
        const float weight = photons.weight != nullptr ? photons.weight[i] : 1.0F;
        float factor[3];
        write_factors(tables, lobe, direction[0], direction[1], factor);
        for (size_t c = 0; c < 3; ++c) {
            const float unit = factor[c] * weight * scale;
            sums[c][i % 8] += static_cast<double>(unit * static_cast<float>(energy[c]));
        }
    }
    for (size_t c = 0; c < 3; ++c) rgb[c] += total(sums[c]);
}

/// A photon's factor by a function of (tables, lobe, theta, phi).
template <typename Factor>
void add(const DirectionTables& tables, const Lobe& lobe, const ShadedPhotons& photons, double* rgb,
         const Factor& factor_of) {
    add_coloured(
        tables, lobe, photons, rgb,
        [&](const DirectionTables& t, const Lobe& l, uint8_t theta, uint8_t phi, float* factor) {
            factor[0] = factor[1] = factor[2] = factor_of(t, l, theta, phi);
        });
}

void add_arriving(const DirectionTables& tables, const Lobe& lobe, const ShadedPhotons& photons,
                  double* rgb) {
    add(tables, lobe, photons, rgb,
        [](const DirectionTables&, const Lobe&, uint8_t, uint8_t) { return 1.0F; });
}

void add_facing(const DirectionTables& tables, const Lobe& lobe, const ShadedPhotons& photons,
                double* rgb) {
    add(tables, lobe, photons, rgb, facing_factor);
}

void add_schlick(const DirectionTables& tables, const Lobe& lobe, const ShadedPhotons& photons,
                 double* rgb) {
    add(tables, lobe, photons, rgb, schlick_factor);
}

void add_phong(const DirectionTables& tables, const Lobe& lobe, const ShadedPhotons& photons,
               double* rgb) {
    add_coloured(tables, lobe, photons, rgb, phong_factors);
}

}  // namespace

// [J96 (5)], [J96 (6)] with D(v) = v / G(v) = v + alpha (1 - v), s = wo + wi and t^2 = (n.s)^2 / |s|^2:
//   pi f_r = (1 - G G') + Z / (4 D D'), and D D' - v v' = alpha ((1-v) v' + (1-v') D),
//   Z = alpha / (1 - (1-alpha) t^2)^2 = alpha |s|^4 / (alpha |s|^2 + (1-alpha) |n x s|^2)^2.
// Nothing here cancels, however small alpha is, and nothing is divided by v or v'.
float schlick_factor(const DirectionTables& tables, const Lobe& lobe, uint8_t theta, uint8_t phi) {
    const Direction wi = decode(tables, theta, phi);
    const float v_in = dot(lobe.normal, wi);
    if (!(v_in > 0)) return 0;
    const Direction s{lobe.wo[0] + wi.x, lobe.wo[1] + wi.y, lobe.wo[2] + wi.z};
    const float across = dot(lobe.tangent, s);
    const float aside = dot(lobe.bitangent, s);
    const float along = dot(lobe.normal, s);
    const float sine2 = across * across + aside * aside;  // |n x s|^2
    const float square = sine2 + along * along;           // |s|^2
    const float spread = lobe.alpha * square + (1 - lobe.alpha) * sine2;
    const float peak = square / (spread + spread);
    const float u = 1 - lobe.cosine;
    const float u_in = 1 - v_in;
    const float d = lobe.cosine + lobe.alpha * u;
    const float d_in = v_in + lobe.alpha * u_in;
    return (u * v_in + u_in * d + peak * peak) / d_in;
}

void phong_factors(const DirectionTables& tables, const Lobe& lobe, uint8_t theta, uint8_t phi,
                   float* rgb) {
    const Direction wi = decode(tables, theta, phi);
    rgb[0] = rgb[1] = rgb[2] = 0;
    if (!(dot(lobe.normal, wi) > 0)) return;
    const Direction apart{lobe.mirrored[0] - wi.x, lobe.mirrored[1] - wi.y,
                          lobe.mirrored[2] - wi.z};
    // |a - b|^2 / 2 of unit vectors: the cosine itself would be rounded where it is near 1.
    const float square = apart.x * apart.x + (apart.y * apart.y + apart.z * apart.z);
    const float power = cosine_power<PlainSimd>(0.5F * square, lobe.exponent);
    for (size_t c = 0; c < 3; ++c) rgb[c] = lobe.diffuse[c] + lobe.specular[c] * power;
}

float facing_factor(const DirectionTables& tables, const Lobe& lobe, uint8_t theta, uint8_t phi) {
    return dot(lobe.normal, decode(tables, theta, phi)) > 0 ? 1.0F : 0.0F;
}

const ShadingKernels plain_shading{add_arriving,
                                   add_facing,
                                   add_schlick,
                                   add_phong,
                                   weigh_photons<PlainSimd>,
                                   SquareLoop<PlainSimd>::weigh,
                                   DiscLoop<PlainSimd>::weigh,
                                   DiscLoop<PlainSimd>::weigh_on_cell};

}  // namespace caustics::photonmap
