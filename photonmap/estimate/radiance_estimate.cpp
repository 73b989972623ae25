#include "photonmap/estimate/radiance_estimate.h"

#include <algorithm>
#include <cmath>

#include "photonmap/tree/resolvable_radius.h"

namespace caustics::photonmap {

namespace {

double resolvable_squared_radius(const Vec3& point, float max_radius) {
    const auto radius = static_cast<double>(resolvable_radius(point, max_radius));
    return radius * radius;
}

}  // namespace

RadianceEstimate::RadianceEstimate(const Settings& settings, Isa isa)
    : settings_(settings),
      shading_(isa),
      adaptive_(isa),
      filter_(settings.filter.polynomial()),
      cell_(settings.filter) {
    if (settings.footprint > 0)
        square_.emplace(settings.filter, settings.footprint, settings.share);
}

double RadianceEstimate::margin_of(double footprint) { return std::sqrt(0.5) * footprint; }

double RadianceEstimate::squared_radius(const ReceiverPoint& point, const GatheredPhotons& photons,
                                        bool full) const {
    const float max_radius = settings_.limits.max_radius;
    if (!full) return static_cast<double>(max_radius) * static_cast<double>(max_radius);
    return std::max(static_cast<double>(photons.squared_distance[photons.farthest]),
                    resolvable_squared_radius(point.position, max_radius));
}

RadianceEstimate::Spread RadianceEstimate::spread(const ReceiverPoint& point,
                                                  const GatheredPhotons& gathered,
                                                  EstimateScratch& scratch) const {
    if (gathered.radius != nullptr) return over_own_discs(point, gathered, scratch);
    return square_ ? over_square(point, gathered, scratch) : over_disc(point, gathered, scratch);
}

// The weights are per area already.
RadianceEstimate::Spread RadianceEstimate::over_own_discs(const ReceiverPoint& point,
                                                          const GatheredPhotons& gathered,
                                                          EstimateScratch& scratch) const {
    scratch.weight.reserve(gathered.count + widest_register);
    float* const weight = scratch.weight.data();
    if (gathered.cell != nullptr)
        shading_.weigh_on_cell(cell_, point, gathered, weight);
    else
        shading_.weigh_discs(filter_, gathered, weight);
    scratch.used_photons += gathered.count;
    return {{.photons = gathered, .weight = weight}, 1};
}

RadianceEstimate::Spread RadianceEstimate::over_square(const ReceiverPoint& point,
                                                       const GatheredPhotons& gathered,
                                                       EstimateScratch& scratch) const {
    const SquareKernel::Reach reach =
        square_->reach(std::sqrt(squared_radius(point, gathered, gathered.full)));
    scratch.weight.reserve(gathered.count + widest_register);
    shading_.weigh_on_square(*square_, reach, point, gathered, scratch.weight.data());
    if (gathered.full) scratch.weight[gathered.farthest] = static_cast<float>(reach.rim);
    scratch.used_photons += gathered.count;
    return {{.photons = gathered, .weight = scratch.weight.data()}, 4 * reach.half * reach.half};
}

RadianceEstimate::Spread RadianceEstimate::over_disc(const ReceiverPoint& point,
                                                     const GatheredPhotons& gathered,
                                                     EstimateScratch& scratch) const {
    ChosenPhotons chosen{gathered, gathered.full, 1};
    if (settings_.adaptive) chosen = adaptive_.choose(point, gathered, chosen.full, scratch.count);
    GatheredPhotons& photons = chosen.photons;

    double squared = squared_radius(point, photons, chosen.full);
    WeightedPhotons weighted{.photons = photons};
    if (chosen.full && settings_.estimator == PhotonMapParams::Estimator::unbiased)
        weighted.left_out = photons.farthest;
    if (settings_.share < 1) {
        squared *= settings_.share;
        photons = scratch.count.near.within(photons, static_cast<float>(squared));
        weighted.left_out = WeightedPhotons::none;
    }
    weighted.photons = photons;
    scratch.used_photons += photons.count;
    if (settings_.filter.kind != FilterKind::none) {
        scratch.weight.reserve(photons.count + widest_register);
        shading_.weigh(filter_, photons, squared, scratch.weight.data());
        weighted.weight = scratch.weight.data();
    }
    return {weighted, pi_d * squared, chosen.factor};  // [J96 (3)]
}

Spectrum RadianceEstimate::density(const SpectrumSum& sum, const Spread& spread) const {
    // [J96 (2)], [J96 (4)]: the sum over the area.
    const SpectrumSum density =
        sum * settings_.flux_unit.cast<double>() * (spread.factor / spread.area);
    return density.cast<float>();
}

Spectrum RadianceEstimate::radiance(const ReceiverPoint& point, const GatheredPhotons& gathered,
                                    EstimateScratch& scratch) const {
    const Spread around = spread(point, gathered, scratch);
    // [J96 (1)]: f_r times the light that arrives.
    if (scratch.table)
        return density(shading_.reflected(point, around.photons, *scratch.table), around);
    return density(shading_.reflected(point, around.photons), around);
}

Spectrum RadianceEstimate::irradiance(const ReceiverPoint& point, const GatheredPhotons& gathered,
                                      EstimateScratch& scratch) const {
    const Spread around = spread(point, gathered, scratch);
    return density(shading_.arriving(around.photons), around);
}

}  // namespace caustics::photonmap
