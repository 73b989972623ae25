#pragma once

#include <span>

#include "core/caustic_estimator.h"
#include "photonmap/nearest_set.h"
#include "photonmap/photon.h"
#include "photonmap/photon_map.h"

namespace caustics {

/// What a query found.
struct Gathered {
    Spectrum value = black();
    std::size_t photons = 0;
};

/// Radiance from the N nearest photons, [J96] eqs. 1-4: the sum of f_r times flux over the area
/// pi r^2 of the disc that holds them.
///
/// `raw` is eq. 4: r is the distance of the N-th photon. It reads high by N/(N-1), because the
/// disc is drawn through a photon; `unbiased` leaves that outermost photon out of the sum. When
/// fewer than N lie within the maximum radius R, both sum all over pi R^2. In a uniform field
/// `unbiased` is exactly so for any N and R.
///
/// Photons that came from behind the point's geometric normal do not count. Photons carry flux,
/// so density is per area of the geometric surface, and f_r is taken about the shading normal.
/// A photon that grazes within the direction code's error may be taken for the other side.
class RadianceEstimate {
public:
    struct Settings {
        std::size_t nearest = 50;  ///< N
        float max_radius = 1;      ///< R [m], > 0
        PhotonMapParams::Estimator estimator = PhotonMapParams::Estimator::unbiased;
        Spectrum flux_unit = Spectrum::Ones();  ///< [W] for an energy of 1
    };

    /// `tree` is balanced and outlives this.
    RadianceEstimate(std::span<const Photon> tree, const Settings& settings)
        : tree_(tree), settings_(settings) {}

    /// [W m^-2 sr^-1] leaving along the point's `wo`.
    Gathered radiance(const ReceiverPoint& point, NearestSet& scratch) const;
    /// [W m^-2], the same with f_r = 1.
    Gathered irradiance(const ReceiverPoint& point, NearestSet& scratch) const;

private:
    template <typename Weight>
    Gathered gather(const ReceiverPoint& point, NearestSet& scratch, const Weight& weight) const;

    std::span<const Photon> tree_;
    Settings settings_;
};

}  // namespace caustics
