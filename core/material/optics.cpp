#include "core/material/optics.h"

#include <algorithm>
#include <cmath>

namespace caustics {

std::optional<Vec3> refract(const Vec3& w, const Vec3& n, float eta) {
    const float cos_i = n.dot(w);
    const float sin2_t = (1 - cos_i * cos_i) / (eta * eta);
    if (sin2_t >= 1) return {};
    const float cos_t = std::sqrt(1 - sin2_t);
    const Vec3 t = (cos_i / eta - cos_t) * n - w / eta;
    return t.normalized();
}

namespace {

float fresnel_reflectance(float cos_i, float cos_t, float eta) {
    const float r_s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    const float r_p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    return 0.5F * (r_s * r_s + r_p * r_p);
}

}  // namespace

float fresnel_dielectric(float cos_i, float eta) {
    const float sin2_t = (1 - cos_i * cos_i) / (eta * eta);
    if (sin2_t >= 1) return 1;
    return fresnel_reflectance(cos_i, std::sqrt(1 - sin2_t), eta);
}

Spectrum transmittance(const Spectrum& absorption, float distance) {
    return (-absorption * distance).exp();
}

namespace {

SpecularSplit split_dielectric(const Dielectric& d, bool front, const Vec3& ng, const Vec3& n,
                               const Vec3& w, float nm) {
    SpecularSplit split;
    split.eta = d.relative_ior(front, nm);
    const float cos_i = std::min(n.dot(w), 1.0F);
    split.reflected = reflect(w, n);
    const float inverse_eta = 1 / split.eta;
    const float sin2_t = (1 - cos_i * cos_i) * inverse_eta * inverse_eta;
    const bool refracts = sin2_t < 1;
    const float cos_t = refracts ? std::sqrt(1 - sin2_t) : 0;
    const float reflectance = refracts ? fresnel_reflectance(cos_i, cos_t, split.eta) : 1;
    const Spectrum reflected = d.specular_reflectance * reflectance;
    ((ng.dot(split.reflected) > 0) == front ? split.reflected_weight : split.lost_weight) =
        reflected;
    if (refracts) {
        const Vec3 t = (cos_i * inverse_eta - cos_t) * n - inverse_eta * w;
        split.refracted = t * (1 / t.norm());
        const Spectrum refracted = d.specular_transmittance * (1 - reflectance);
        if ((ng.dot(t) > 0) != front)
            split.refracted_weight = refracted;
        else
            split.lost_weight += refracted;
    }
    return split;
}

// Of a conductor or a mirror part.
Spectrum mirror_reflectance(const Bsdf& bsdf) {
    if (bsdf.mirror) return bsdf.mirror->weight * bsdf.mirror->reflectance;
    return std::get<Conductor>(bsdf.model).specular_reflectance;
}

}  // namespace

SpecularSplit split_specular(const Bsdf& bsdf, const Vec3& ng, const Vec3& ns, const Vec3& w,
                             float nm) {
    const bool front = ng.dot(w) > 0;
    if ((ns.dot(w) > 0) != front) {
        SpecularSplit nothing;
        nothing.lost_weight = Spectrum::Ones();
        return nothing;
    }
    const Vec3 n = front ? ns : Vec3(-ns);
    if (const auto* dielectric = std::get_if<Dielectric>(&bsdf.model))
        return split_dielectric(*dielectric, front, ng, n, w, nm);
    SpecularSplit split;
    if (!is_caster(bsdf) || !scatters_from(bsdf, front)) return split;
    split.reflected = reflect(w, n);
    ((ng.dot(split.reflected) > 0) == front ? split.reflected_weight : split.lost_weight) =
        mirror_reflectance(bsdf);
    return split;
}

void PathWavelength::arrive_at(const Bsdf& bsdf, Rng& rng, Spectrum& carried) {
    if (nm != 0 || !is_dispersive(bsdf)) return;
    const SampledWavelength sampled = sample_wavelength(choice ? *choice : rng.next_fine());
    nm = sampled.nm;
    carried *= sampled.weight;
}

bool is_clear(const Spectrum* absorption) { return absorption == nullptr || is_black(*absorption); }

const Spectrum* medium_absorption(const Bsdf& bsdf, const Vec3& ng, const Vec3& w) {
    const auto* dielectric = std::get_if<Dielectric>(&bsdf.model);
    if (dielectric == nullptr) return nullptr;
    return ng.dot(w) > 0 ? &dielectric->ext_absorption : &dielectric->absorption;
}

Spectrum segment_transmittance(const Spectrum* start_absorption, const Spectrum* end_absorption,
                               float distance) {
    const Spectrum* const medium = end_absorption != nullptr ? end_absorption : start_absorption;
    return is_clear(medium) ? Spectrum(Spectrum::Ones()) : transmittance(*medium, distance);
}

}  // namespace caustics
