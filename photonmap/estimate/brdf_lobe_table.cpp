#include "photonmap/estimate/brdf_lobe_table.h"

#include <cstring>

#include "photonmap/photons/direction_code.h"

namespace caustics {

namespace {

/// Whether the factors of all directions are the same.
bool same_factors(const Reflection& a, const Reflection& b) {
    return a.model == b.model && a.model != Reflection::Model::other &&
           std::memcmp(&a.lobe, &b.lobe, sizeof(Lobe)) == 0;
}

}  // namespace

void ReflectionTable::turn_to(const ReceiverPoint& point, const Reflection& reflection) {
    if (!same_factors(reflection, reflection_)) clear();
    point_ = point;
    reflection_ = reflection;
}

void ReflectionTable::clear() {
    reflection_ = {};
    if (++filling_ != 0) return;
    // The numbers are used up: no old entry may meet its number again.
    entries_.assign(entries_.size(), Entry{});
    filling_ = 1;
}

void ReflectionTable::fill(Entry& entry, std::uint16_t direction) {
    const auto theta = static_cast<std::uint8_t>(direction & 255U);
    const auto phi = static_cast<std::uint8_t>(direction >> 8U);
    Spectrum factor = black();
    switch (reflection_.model) {
        case Reflection::Model::black: break;
        case Reflection::Model::lambert:
            factor.setConstant(facing_factor(direction_tables(), reflection_.lobe, theta, phi));
            break;
        case Reflection::Model::schlick:
            factor.setConstant(schlick_factor(direction_tables(), reflection_.lobe, theta, phi));
            break;
        case Reflection::Model::other:
            factor = evaluate(*point_.bsdf, point_.uv, point_.shading_normal, point_.wo,
                              decode_direction(theta, phi));
            break;
    }
    for (int c = 0; c < 3; ++c) entry.rgb[c] = factor[c];
    entry.filling = filling_;
    ++fillings_;
}

}  // namespace caustics
