#include "core/material/optics.h"

namespace caustics {

Spectrum transmittance(const Spectrum& absorption, float distance) {
    return (-absorption * distance).exp();
}

SpecularSplit split_specular(const Bsdf& bsdf, const Vec3& ng, const Vec3& ns, const Vec3& w,
                             float nm) {
    const bool front = ng.dot(w) > 0;
    SpecularSplit nothing;
    if ((ns.dot(w) > 0) != front) {
        nothing.lost_weight = Spectrum::Ones();
        return nothing;
    }
    if (!scatters_from(bsdf, front)) return nothing;
    const SpecularArrival light{front, ng, front ? ns : Vec3(-ns), w, nm};
    if (bsdf.mirror) return Conductor{bsdf.mirror->weight * bsdf.mirror->reflectance}.split(light);
    return std::visit(
        [&](const auto& model) {
            if constexpr (requires { model.split(light); })
                return model.split(light);
            else
                return nothing;
        },
        bsdf.model);
}

void PathWavelength::arrive_at(const Bsdf& bsdf, Rng& rng, Spectrum& carried) {
    if (nm != 0 || !is_dispersive(bsdf)) return;
    const SampledWavelength sampled = sample_wavelength(choice ? *choice : rng.next_fine());
    nm = sampled.nm;
    carried *= sampled.weight;
}

bool is_clear(const Spectrum* absorption) { return absorption == nullptr || is_black(*absorption); }

const Spectrum* medium_absorption(const Bsdf& bsdf, const Vec3& ng, const Vec3& w) {
    return std::visit(
        [&](const auto& model) -> const Spectrum* {
            if constexpr (requires { model.medium(true); })
                return &model.medium(ng.dot(w) > 0);
            else
                return nullptr;
        },
        bsdf.model);
}

const Spectrum* medium_after(const Bsdf& bsdf, const Vec3& ng, const Vec3& w,
                             const Spectrum* before) {
    const Spectrum* const own = medium_absorption(bsdf, ng, w);
    return own != nullptr ? own : before;
}

Spectrum segment_transmittance(const Spectrum* start_absorption, const Spectrum* end_absorption,
                               float distance) {
    const Spectrum* const medium = end_absorption != nullptr ? end_absorption : start_absorption;
    return is_clear(medium) ? Spectrum(Spectrum::Ones()) : transmittance(*medium, distance);
}

}  // namespace caustics
