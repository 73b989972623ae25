#pragma once

#include <bit>
#include <cmath>
#include <vector>

#include "core/math/rng.h"
#include "photonmap/estimate/shading.h"
#include "photonmap/photons/photon.h"

namespace caustics::photonmap::test {

/// Gathered photons that own their arrays.
class PhotonArrays {
public:
    explicit PhotonArrays(std::size_t count)
        : energy_(padded(count)),
          direction_(padded(count)),
          weight_(padded(count)),
          count_(count) {}

    void set(std::size_t i, const Rgbe& energy, DirectionCode wi, float weight = 1) {
        energy_[i] = std::bit_cast<std::uint32_t>(energy);
        direction_[i] = std::bit_cast<std::uint16_t>(wi);
        weight_[i] = weight;
    }
    Rgbe energy(std::size_t i) const { return std::bit_cast<Rgbe>(energy_[i]); }
    DirectionCode direction(std::size_t i) const {
        return std::bit_cast<DirectionCode>(direction_[i]);
    }
    float weight(std::size_t i) const { return weight_[i]; }
    std::size_t size() const { return count_; }

    WeightedPhotons photons(bool weighted = false,
                            std::size_t left_out = WeightedPhotons::none) const {
        return {{nullptr, energy_.data(), direction_.data(), count_, 0},
                weighted ? weight_.data() : nullptr,
                left_out};
    }

private:
    static std::size_t padded(std::size_t count) { return (count + 15) / 16 * 16; }

    std::vector<std::uint32_t> energy_;
    std::vector<std::uint16_t> direction_;
    std::vector<float> weight_;
    std::size_t count_;
};

inline Vec3 random_direction(Rng& rng) {
    const float z = 2 * rng.next() - 1, angle = 2 * pi * rng.next();
    const float sine = std::sqrt(1 - z * z);
    return Vec3(sine * std::cos(angle), sine * std::sin(angle), z).normalized();
}

/// Photons from everywhere, of energies over six powers of ten, some of them black.
inline PhotonArrays random_photons(std::size_t count, std::uint64_t seed) {
    Rng rng(seed, Stage::test, count);
    PhotonArrays photons(count);
    for (std::size_t i = 0; i < count; ++i) {
        const float size = std::pow(10.0F, 6 * rng.next() - 3);
        const float red = rng.next(), green = rng.next(), blue = rng.next();
        const Spectrum energy = i % 11 == 5 ? black() : Spectrum(Spectrum(red, green, blue) * size);
        photons.set(i, encode_rgbe(energy), encode_direction(random_direction(rng)), rng.next());
    }
    return photons;
}

/// A point seen from a direction above its shading normal, which leans away from the geometric one.
inline ReceiverPoint random_point(Rng& rng, const Bsdf& bsdf) {
    ReceiverPoint point{};
    point.geometric_normal = random_direction(rng);
    point.shading_normal = (point.geometric_normal + 0.3F * random_direction(rng)).normalized();
    do point.wo = random_direction(rng);
    while (point.shading_normal.dot(point.wo) <= 0.01F);
    point.uv = Vec2(0.25F, 0.75F);
    point.bsdf = &bsdf;
    return point;
}

/// f_r of [J96 (5)], [J96 (6)] as printed but for t = n.h, in double.
inline double schlick_as_printed(double alpha, const Vec3d& n, const Vec3d& wo, const Vec3d& wi) {
    const double v = n.dot(wo), v_in = n.dot(wi);
    const auto shadowing = [alpha](double cosine) {
        return cosine / (alpha - alpha * cosine + cosine);
    };
    const double t = n.dot((wo + wi).normalized());
    const double g = shadowing(v) * shadowing(v_in);
    const double lobe = 1 + alpha * t * t - t * t;
    return (1 - g) / pi_d + g / (4 * pi_d * v * v_in) * alpha / (lobe * lobe);
}

}  // namespace caustics::photonmap::test
