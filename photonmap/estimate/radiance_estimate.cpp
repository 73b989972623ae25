#include "photonmap/estimate/radiance_estimate.h"

#include <algorithm>
#include <limits>

namespace caustics::photonmap {

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
    ChosenPhotons chosen{gathered, gathered.count == settings_.limits.nearest, 1};
    if (settings_.adaptive) chosen = adaptive_.choose(point, gathered, chosen.full, scratch.count);
    GatheredPhotons& photons = chosen.photons;

    const float max_radius = settings_.limits.max_radius;
    Disc disc{.photons = {.photons = photons},
              .squared_radius = static_cast<double>(max_radius) * static_cast<double>(max_radius),
              .factor = chosen.factor};
    if (chosen.full) {
        disc.squared_radius =
            std::max(static_cast<double>(photons.squared_distance[photons.farthest]),
                     resolvable_squared_radius(point.position, max_radius));
        if (settings_.estimator == PhotonMapParams::Estimator::unbiased)
            disc.photons.left_out = photons.farthest;
    }
    if (settings_.share < 1) {
        disc.squared_radius *= settings_.share;
        photons = scratch.count.near.within(photons, static_cast<float>(disc.squared_radius));
        disc.photons.left_out = WeightedPhotons::none;
    }
    disc.photons.photons = photons;
    scratch.used_photons += photons.count;
    if (settings_.filter.kind != FilterKind::none) {
        scratch.weight.reserve(photons.count + widest_register);
        shading_.weigh(filter_, photons, disc.squared_radius, scratch.weight.data());
        disc.photons.weight = scratch.weight.data();
    }
    return disc;
}

Spectrum RadianceEstimate::density(const SpectrumSum& sum, const Disc& disc) const {
    // [J96 (3)], and with the sum [J96 (4)]: over the disc's area.
    const SpectrumSum density =
        sum * settings_.flux_unit.cast<double>() * (disc.factor / (pi_d * disc.squared_radius));
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

}  // namespace caustics::photonmap
