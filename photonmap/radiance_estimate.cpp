#include "photonmap/radiance_estimate.h"

#include <algorithm>
#include <limits>

#include "photonmap/kd_tree.h"

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

template <typename Weight>
Gathered RadianceEstimate::gather(const ReceiverPoint& point, NearestSet& scratch,
                                  const Weight& weight) const {
    const float max_radius = settings_.max_radius;
    scratch.reset(max_radius * max_radius);
    find_nearest(tree_, point.position, scratch, [&point](const Photon& photon) {
        return incoming(photon).dot(point.geometric_normal) > 0;
    });
    std::span<const Neighbour> neighbours = scratch.found();
    double squared_radius = static_cast<double>(max_radius) * static_cast<double>(max_radius);
    if (neighbours.size() == settings_.nearest) {
        squared_radius = std::max(static_cast<double>(neighbours.front().squared_distance),
                                  resolvable_squared_radius(point.position, max_radius));
        if (settings_.estimator == PhotonMapParams::Estimator::unbiased)
            neighbours = neighbours.subspan(1);
    }
    SpectrumSum sum = SpectrumSum::Zero();
    for (const Neighbour& neighbour : neighbours) {
        const Photon& photon = tree_[neighbour.index];
        sum += (weight(incoming(photon)) * decode_rgbe(photon.energy)).template cast<double>();
    }
    const SpectrumSum density = sum * settings_.flux_unit.cast<double>() / (pi_d * squared_radius);
    return {density.cast<float>(), scratch.found().size()};
}

Gathered RadianceEstimate::radiance(const ReceiverPoint& point, NearestSet& scratch) const {
    return gather(point, scratch, [&point](const Vec3& wi) {
        return evaluate(*point.bsdf, point.uv, point.shading_normal, point.wo, wi);
    });
}

Gathered RadianceEstimate::irradiance(const ReceiverPoint& point, NearestSet& scratch) const {
    return gather(point, scratch, [](const Vec3&) { return Spectrum(Spectrum::Ones()); });
}

}  // namespace caustics
