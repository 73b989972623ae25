#pragma once

#include <optional>

#include "core/caustic_estimator.h"
#include "photonmap/estimate/adaptive_n.h"
#include "photonmap/estimate/density_filter.h"
#include "photonmap/estimate/shading.h"
#include "photonmap/kernels/aligned_array.h"
#include "photonmap/photons/photon_map_params.h"
#include "photonmap/tree/photon_tree.h"

namespace caustics::photonmap {

/// A thread's arrays for estimates, and how many photons they were made from.
struct EstimateScratch {
    AlignedArray<float> weight;
    NScratch count;
    std::uint64_t used_photons = 0;
    std::optional<BrdfLobeTable> table;  ///< of f_r, where reflection is to be looked up
};

/// Radiance from the N nearest photons, [J96 (1)], [J96 (2)]: the sum of f_r times flux over the area
/// pi r^2 of the disc that holds them; each photon weighs as the filter says (density_filter.h).
///
/// `raw` is [J96 (4)]: r is the distance of the N-th photon. It reads high by w(1) / (N-1), w(1) being
/// the filter's weight at the rim, because the disc is drawn through a photon. `unbiased` leaves
/// that outermost photon out of the sum. When fewer than N lie within the maximum radius R, both
/// sum all over pi R^2. In a uniform field `unbiased` is exactly so for any N, R and filter: given
/// r, or given how many lie within R, the photons inside are spread evenly over the disc, where
/// weights have a mean of 1, so that the filter changes no mean; and without a filter, with the
/// density 1 and a = pi r^2, the mean of (N-1)/a over the N-th photons inside the disc of area A =
/// pi R^2 is P(at least N-1 in A), that of the number n < N in A over A is P(at most N-2 in A).
///
/// With a share below 1 the disc found so is drawn closer, and photons left outside do not count;
/// so neither does the outermost one, for `raw` as for `unbiased`, and the mean stays what it is
/// for `unbiased`.
///
/// With a footprint it is the mean over a square (square_kernel.h), again without bias in a uniform field, where
/// the maximum radius sets the kernel too: with A its area, the two parts bring d P(a_N < A) + g(A) f_N(A) and
/// d P(a_N > A) - g(A) f_N(A). f_r is the point's everywhere on the square.
///
/// Where the photons have discs of their own (photon_discs.h), each weighs by the filter over its own disc, and the
/// estimate is their sum: unbiased in a uniform field for any N and filter, and for photons that depend on each other,
/// because a photon's disc does not depend on the point. The discs' area goes as one over the density, which leaves
/// a bias of the fourth order of their width [Abramson 1982; Silverman 1986, sec. 5.3]. Photons may be gathered for a
/// cell in place of the point: then it is the mean over that (cell_kernel.h).
///
/// Photons that came from behind the point's geometric normal do not count, and neither do those of
/// surfaces that face elsewhere: the floor's at the foot of a wall (same_surface.h). Photons carry flux,
/// so density is per area of the geometric surface, and f_r is taken about the shading normal.
/// A photon that grazes within the direction code's error may be taken for the other side.
class RadianceEstimate {
public:
    struct Settings {
        GatherLimits limits;
        PhotonMapParams::Estimator estimator = PhotonMapParams::Estimator::unbiased;
        DensityFilter filter = {};
        bool adaptive = false;  ///< whether N is the largest number (AdaptiveN)
        double share = 1;       ///< of the squared radius within which photons count (pass_share)
        Spectrum flux_unit = Spectrum::Ones();  ///< [W] for an energy of 1
        /// Side of the square round a point that the estimate is averaged over [m]; 0: the point's. Not with
        /// adaptive, nor `raw`; limits ask for positions and margin_of(footprint).
        double footprint = 0;
    };

    RadianceEstimate(const Settings& settings, Isa isa);

    /// How far beyond the N-th photon others may weigh on a square of that side [m].
    static double margin_of(double footprint);

    /// [W m^-2 sr^-1] leaving along the point's `wo`, from what a tree gathered at it.
    Spectrum radiance(const ReceiverPoint& point, const GatheredPhotons& gathered,
                      EstimateScratch& scratch) const;
    /// [W m^-2], the same with f_r = 1.
    Spectrum irradiance(const ReceiverPoint& point, const GatheredPhotons& gathered,
                        EstimateScratch& scratch) const;

private:
    /// The photons that count, and the area over which their flux is spread.
    struct Spread {
        WeightedPhotons photons;
        double area = 0;    ///< [m^2]
        double factor = 1;  ///< of the density
    };
    Spread spread(const ReceiverPoint& point, const GatheredPhotons& gathered,
                  EstimateScratch& scratch) const;
    Spread over_disc(const ReceiverPoint& point, const GatheredPhotons& gathered,
                     EstimateScratch& scratch) const;
    Spread over_own_discs(const ReceiverPoint& point, const GatheredPhotons& gathered,
                          EstimateScratch& scratch) const;
    Spread over_square(const ReceiverPoint& point, const GatheredPhotons& gathered,
                       EstimateScratch& scratch) const;
    double squared_radius(const ReceiverPoint& point, const GatheredPhotons& photons,
                          bool full) const;
    Spectrum density(const SpectrumSum& sum, const Spread& spread) const;

    Settings settings_;
    Shading shading_;
    AdaptiveN adaptive_;
    FilterPolynomial filter_;
    std::optional<SquareKernel> square_;
    CellKernel cell_;
};

}  // namespace caustics::photonmap
