#include "tests/bench/scalar_shading.h"

#include <cmath>

namespace caustics::bench {

namespace {

constexpr float pi = 3.14159265358979323846F;

float theta_of(unsigned cell) { return (static_cast<float>(cell) + 0.5F) * (pi / 256); }
float phi_of(unsigned cell) { return (static_cast<float>(cell) + 0.5F) * (2 * pi / 256); }

struct Tables {
    float sin_theta[256], cos_theta[256], sin_phi[256], cos_phi[256], power[256];

    Tables() {
        for (unsigned i = 0; i < 256; ++i) {
            sin_theta[i] = std::sin(theta_of(i));
            cos_theta[i] = std::cos(theta_of(i));
            sin_phi[i] = std::sin(phi_of(i));
            cos_phi[i] = std::cos(phi_of(i));
            power[i] = i == 0 ? 0.0F : std::ldexp(1.0F, static_cast<int>(i) - 136);
        }
    }
};
const Tables tables;

float dot(const float* a, const float* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

float shadowing(float v, float alpha) { return v / (alpha - alpha * v + v); }

float schlick(const ScalarQuery& query, const float* wi, float v, float v_in) {
    const float sum[3] = {query.wo[0] + wi[0], query.wo[1] + wi[1], query.wo[2] + wi[2]};
    const float t = (v + v_in) / std::sqrt(dot(sum, sum));
    const float g = shadowing(v, query.alpha) * shadowing(v_in, query.alpha);
    const float lobe = 1 + query.alpha * t * t - t * t;
    return (1 - g) / pi + g / (4 * pi * v * v_in) * query.alpha / (lobe * lobe);
}

float phong(const ScalarQuery& query, const float* wi, float v, float v_in) {
    const float cosine = 2 * v * v_in - dot(query.wo, wi);
    const float lobe = cosine > 0 ? std::pow(cosine, query.alpha) : 0;
    return 0.5F / pi + 0.5F * (query.alpha + 2) / (2 * pi) * lobe;
}

template <typename Law, typename Direction, typename Power>
void shade(const ScalarQuery& query, float* rgb, const Law& law, const Direction& direction,
           const Power& power) {
    const float v = dot(query.normal, query.wo);
    float red = 0, green = 0, blue = 0;
    for (std::size_t i = 0; i < query.count; ++i) {
        float wi[3];
        direction(query.direction[i] & 255U, static_cast<unsigned>(query.direction[i]) >> 8U, wi);
        const float v_in = dot(query.normal, wi);
        if (v_in <= 0) continue;
        const std::uint32_t energy = query.energy[i];
        const float factor = law(query, wi, v, v_in) * power(energy >> 24U);
        red += factor * static_cast<float>(energy & 255U);
        green += factor * static_cast<float>((energy >> 8U) & 255U);
        blue += factor * static_cast<float>((energy >> 16U) & 255U);
    }
    rgb[0] = red;
    rgb[1] = green;
    rgb[2] = blue;
}

}  // namespace

void shade_by_libm(const ScalarQuery& query, float* rgb) {
    shade(
        query, rgb, schlick,
        [](unsigned theta, unsigned phi, float* wi) {
            const float t = theta_of(theta), p = phi_of(phi);
            wi[0] = std::sin(t) * std::cos(p);
            wi[1] = std::sin(t) * std::sin(p);
            wi[2] = std::cos(t);
        },
        [](unsigned exponent) {
            return exponent == 0 ? 0.0F : std::ldexp(1.0F, static_cast<int>(exponent) - 136);
        });
}

namespace {

void direction_by_tables(unsigned theta, unsigned phi, float* wi) {
    wi[0] = tables.sin_theta[theta] * tables.cos_phi[phi];
    wi[1] = tables.sin_theta[theta] * tables.sin_phi[phi];
    wi[2] = tables.cos_theta[theta];
}

float power_by_table(unsigned exponent) { return tables.power[exponent]; }

}  // namespace

void shade_by_tables(const ScalarQuery& query, float* rgb) {
    shade(query, rgb, schlick, direction_by_tables, power_by_table);
}

void shade_phong(const ScalarQuery& query, float* rgb) {
    shade(query, rgb, phong, direction_by_tables, power_by_table);
}

}  // namespace caustics::bench
