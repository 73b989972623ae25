#pragma once

#include "core/caustic_estimator.h"
#include "photonmap/kernels/aligned_array.h"
#include "photonmap/kernels/tree_kernels.h"
#include "photonmap/tree/gathered_photons.h"
#include "photonmap/tree/radius_filter.h"

namespace caustics::photonmap {

/// A thread's arrays for choosing.
struct NScratch {
    AlignedArray<std::uint32_t> direction[4];
    RadiusFilter near;
};

/// The photons that were chosen.
struct ChosenPhotons {
    GatheredPhotons photons;
    bool full = false;  ///< whether the disc is drawn through the farthest of them
    double factor = 1;  ///< of the density that they give
};

/// How many of the N nearest photons to take, by where they lie round the point [J96 sec. 5:
/// "an adaptive method that based upon the local density of the photons determined how many photons
/// to use"].
///
/// Only directions decide. On the tangent plane each photon lies in some direction from the point;
/// where light is even the directions are too, and do not depend on the distances. For K = 5, 7, 8,
/// 11, 14, ... up to N the resultant of the K nearest photons' unit vectors is tested (Rayleigh's
/// test [Mardia & Jupp 2000]), and that of the vectors at twice their angles, which shows a ridge.
/// The first K that leans too far for chance, |sum|^2 > 6 K or 9 K, is too many: the light changes
/// within its disc. Significance lags behind the change; so the K two steps before is taken.
///
/// A point in the dark sees all its photons on one side, however few are taken, and a point in the
/// light sees some all round. So the density is multiplied by min(1, 3/2 (1 - lean)), lean being
/// the length of the mean direction of the chosen K: at the edge of a half plane of light it is
/// 2/pi.
///
/// In a uniform field the estimate stays unbiased, exactly, whatever the filter: given the
/// directions, K and the S photons that the test looked at are fixed; given the area a of the S-th
/// photon's disc, the mean of (K-1) / a_K is (S-1) / a, that of a fixed N = S (RadianceEstimate).
/// What the factor takes away by chance, up to 0.28 %, is given back by its known mean for as many
/// steps as could be tested.
class AdaptiveN {
public:
    explicit AdaptiveN(Isa isa);

    /// Chooses among the photons gathered at the point, with their positions; `full` says whether
    /// they are the N nearest, or all within the maximum radius.
    ChosenPhotons choose(const ReceiverPoint& point, const GatheredPhotons& gathered, bool full,
                         NScratch& scratch) const;

private:
    NChooser* chooser_;
};

}  // namespace caustics::photonmap
