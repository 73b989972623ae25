#pragma once

#include "core/caustic_estimator.h"
#include "photonmap/photon_map.h"
#include "photonmap/photon_tree.h"
#include "photonmap/shading.h"

namespace caustics {

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
        GatherLimits limits;
        PhotonMapParams::Estimator estimator = PhotonMapParams::Estimator::unbiased;
        Spectrum flux_unit = Spectrum::Ones();  ///< [W] for an energy of 1
    };

    RadianceEstimate(const Settings& settings, Isa isa) : settings_(settings), shading_(isa) {}

    /// [W m^-2 sr^-1] leaving along the point's `wo`, from what a tree gathered at it.
    Spectrum radiance(const ReceiverPoint& point, const GatheredPhotons& gathered) const;
    /// The same by a table of f_r.
    Spectrum radiance(const ReceiverPoint& point, const GatheredPhotons& gathered,
                      ReflectionTable& table) const;
    /// [W m^-2], the same with f_r = 1.
    Spectrum irradiance(const ReceiverPoint& point, const GatheredPhotons& gathered) const;

private:
    WeightedPhotons counted(const GatheredPhotons& gathered) const;
    Spectrum density(const SpectrumSum& sum, const ReceiverPoint& point,
                     const GatheredPhotons& gathered) const;

    Settings settings_;
    Shading shading_;
};

}  // namespace caustics
