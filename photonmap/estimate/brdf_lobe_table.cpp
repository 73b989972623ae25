#include "photonmap/estimate/brdf_lobe_table.h"

#include <cstring>

#include "photonmap/photons/direction_code.h"

namespace caustics::photonmap {

namespace {

/// Whether the factors of all directions are the same.
bool same_factors(const BrdfLobe& a, const BrdfLobe& b) {
    return a.model == b.model && a.model != BrdfLobe::Model::other &&
           std::memcmp(&a.lobe, &b.lobe, sizeof(Lobe)) == 0;
}

}  // namespace

void BrdfLobeTable::turn_to(const ReceiverPoint& point, const BrdfLobe& reflection) {
    if (!same_factors(reflection, reflection_)) clear();
    point_ = point;
    reflection_ = reflection;
}

void BrdfLobeTable::clear() {
    reflection_ = {};
    if (++filling_ != 0) return;
    // The numbers are used up: no old entry may meet its number again.
    entries_.assign(entries_.size(), Entry{});
    filling_ = 1;
}

void BrdfLobeTable::fill(Entry& entry, std::uint16_t direction) {
    const auto theta = static_cast<std::uint8_t>(direction & 255U);
    const auto phi = static_cast<std::uint8_t>(direction >> 8U);
    Spectrum factor = black();
    switch (reflection_.model) {
        case BrdfLobe::Model::black: break;
        case BrdfLobe::Model::lambert:
            factor.setConstant(facing_factor(direction_tables(), reflection_.lobe, theta, phi));
            break;
        case BrdfLobe::Model::schlick:
            factor.setConstant(schlick_factor(direction_tables(), reflection_.lobe, theta, phi));
            break;
        case BrdfLobe::Model::phong:
            phong_factors(direction_tables(), reflection_.lobe, theta, phi, factor.data());
            break;
        case BrdfLobe::Model::other:
            factor = evaluate(*point_.bsdf, point_.uv, point_.shading_normal, point_.wo,
                              decode_direction(theta, phi));
            break;
    }
    for (int c = 0; c < 3; ++c) entry.rgb[c] = factor[c];
    entry.filling = filling_;
    ++fillings_;
}

}  // namespace caustics::photonmap
