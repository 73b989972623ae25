#include "photonmap/radiance_estimate.h"

#include <algorithm>
#include <limits>

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

WeightedPhotons RadianceEstimate::counted(const GatheredPhotons& gathered) const {
    WeightedPhotons photons{.photons = gathered};
    if (gathered.count == settings_.limits.nearest &&
        settings_.estimator == PhotonMapParams::Estimator::unbiased)
        photons.left_out = gathered.farthest;
    return photons;
}

Spectrum RadianceEstimate::density(const SpectrumSum& sum, const ReceiverPoint& point,
                                   const GatheredPhotons& gathered) const {
    const float max_radius = settings_.limits.max_radius;
    double squared_radius = static_cast<double>(max_radius) * static_cast<double>(max_radius);
    if (gathered.count == settings_.limits.nearest)
        squared_radius = std::max(static_cast<double>(gathered.squared_distance[gathered.farthest]),
                                  resolvable_squared_radius(point.position, max_radius));
    const SpectrumSum density = sum * settings_.flux_unit.cast<double>() / (pi_d * squared_radius);
    return density.cast<float>();
}

Spectrum RadianceEstimate::radiance(const ReceiverPoint& point,
                                    const GatheredPhotons& gathered) const {
    return density(shading_.reflected(point, counted(gathered)), point, gathered);
}

Spectrum RadianceEstimate::radiance(const ReceiverPoint& point, const GatheredPhotons& gathered,
                                    ReflectionTable& table) const {
    return density(shading_.reflected(point, counted(gathered), table), point, gathered);
}

Spectrum RadianceEstimate::irradiance(const ReceiverPoint& point,
                                      const GatheredPhotons& gathered) const {
    return density(shading_.arriving(counted(gathered)), point, gathered);
}

}  // namespace caustics
