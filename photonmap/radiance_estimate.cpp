#include "photonmap/radiance_estimate.h"

#include <algorithm>
#include <limits>

#include "photonmap/density_filter.h"

namespace caustics {

namespace {

/// Squared radius below which distances between float positions mean nothing. Where N photons
/// fall into one point, at a perfect focus, their density has no finite value; over this disc it
/// is large, and finite.
double resolvable_squared_radius(const Vec3& point, float max_radius) {
    const float scale = std::max(point.cwiseAbs().maxCoeff(), max_radius);
    const auto radius = static_cast<double>(std::numeric_limits<float>::epsilon() * scale);
    return radius * radius;
}

}  // namespace

RadianceEstimate::Disc RadianceEstimate::disc(const ReceiverPoint& point,
                                              const GatheredPhotons& gathered,
                                              EstimateScratch& scratch) const {
    const float max_radius = settings_.limits.max_radius;
    Disc disc{.photons = {.photons = gathered},
              .squared_radius = static_cast<double>(max_radius) * static_cast<double>(max_radius)};
    if (gathered.count == settings_.limits.nearest) {
        disc.squared_radius =
            std::max(static_cast<double>(gathered.squared_distance[gathered.farthest]),
                     resolvable_squared_radius(point.position, max_radius));
        if (settings_.estimator == PhotonMapParams::Estimator::unbiased)
            disc.photons.left_out = gathered.farthest;
    }
    if (settings_.filter != FilterKind::none) {
        constexpr std::size_t widest_register = 16;
        scratch.weight.reserve(gathered.count + widest_register);
        shading_.weigh(filter_polynomial(settings_.filter), gathered, disc.squared_radius,
                       scratch.weight.data());
        disc.photons.weight = scratch.weight.data();
    }
    return disc;
}

Spectrum RadianceEstimate::density(const SpectrumSum& sum, const Disc& disc) const {
    const SpectrumSum density =
        sum * settings_.flux_unit.cast<double>() / (pi_d * disc.squared_radius);
    return density.cast<float>();
}

Spectrum RadianceEstimate::radiance(const ReceiverPoint& point, const GatheredPhotons& gathered,
                                    EstimateScratch& scratch) const {
    const Disc around = disc(point, gathered, scratch);
    if (scratch.table)
        return density(shading_.reflected(point, around.photons, *scratch.table), around);
    return density(shading_.reflected(point, around.photons), around);
}

Spectrum RadianceEstimate::irradiance(const ReceiverPoint& point, const GatheredPhotons& gathered,
                                      EstimateScratch& scratch) const {
    const Disc around = disc(point, gathered, scratch);
    return density(shading_.arriving(around.photons), around);
}

}  // namespace caustics
