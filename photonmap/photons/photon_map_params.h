#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/light_path/light_path.h"

namespace caustics::photonmap {

/// How a map's photons are ordered for finding the nearest; all give the same answers.
enum class TreeKind {
    balanced,    ///< the left-balanced heap of [J96 sec. 2], 20 bytes a photon
    unbalanced,  ///< photons inserted in the order of arrival, with child pointers, 28 bytes
    packed       ///< buckets of photons, searched a register at a time, 20.1 bytes
};

/// "balanced", "unbalanced", "packed".
const char* name(TreeKind kind);

/// How photons weigh by their distance (density_filter.h).
enum class FilterKind { none, cone, gaussian, epanechnikov };

/// "none", "cone", "gaussian", "epanechnikov".
const char* name(FilterKind kind);

/// Whose disc spreads a photon's light.
enum class KernelKind {
    photon,  ///< each photon's own, up to its N-th neighbour: the light's sum is kept (photon_discs.h)
    point  ///< the point's, up to its N-th photon [J96 (3)]: too much light where it is uneven
};

/// `photonmap` [J96]: photons traced from the lights through the casters, stored 20 bytes each in
/// a kd-tree, radiance from discs of the photons' own, from the N nearest [J96 (4)] or from all within a radius.
struct PhotonMapParams {
    enum class Estimator {
        unbiased,  ///< the outermost photon only sets the radius: mean (N-1)/(pi r_N^2)
        raw        ///< [J96 (4)] as printed; reads high by N/(N-1) in a uniform field
    };
    enum class Emission {
        random,
        stratified  ///< one jittered particle a stratum, in Morton order: less noise, and faster
    };
    std::string preset = {};  ///< name of the settings that were taken in place of the defaults
    std::uint64_t photons = 100'000;  ///< to store; 0 when `emitted` is given instead
    std::uint64_t emitted = 0;        ///< to emit; 0 when `photons` is given
    Emission emission = Emission::random;
    Interaction interaction = Interaction::roulette;
    KernelKind kernel = KernelKind::photon;
    TreeKind tree = TreeKind::packed;  ///< with `photon` packed
    static constexpr int default_adaptive_nearest = 200;
    static constexpr int least_adaptive_nearest = 20;  ///< for AdaptiveN's ladder to have room
    static constexpr int most_adaptive_nearest = 100'000;
    int nearest = 50;  ///< N; at least 2 for `unbiased`, also where it counts a photon's neighbours
    bool adaptive = false;  ///< N is the largest number, each point takes its own (AdaptiveN)
    double max_radius = 0;  ///< [m]; 0: chosen from the photons, see the report
    double radius = 0;  ///< [m], of every estimate, in place of nearest and max_radius; 0: those
    /// Side of the square round each point, along PlaneAxes, over which the estimate is averaged [m]; 0: the point's.
    float footprint = 0;
    /// With `photon`: the estimate is averaged over the pixels' cells (ReceiverPoint::cell) where points have one.
    bool pixel_footprint = true;
    /// The table of parameters takes `epanechnikov` with `kernel: photon` where none is given.
    FilterKind filter = FilterKind::none;
    double filter_k = 1.1;       ///< of the cone
    double filter_beta = 1.953;  ///< of the Gaussian
    double filter_alpha = 0;     ///< of the Gaussian as printed; 0: normalised
    /// Progressive: so many maps of that size, one after another, whose estimates are averaged
    /// (progressive.h).
    int passes = 1;
    Estimator estimator = Estimator::unbiased;
    /// Shade by tables of f_r over the directions that stored photons can have [J96 sec. 5],
    /// one photon after another, instead of a register of photons at a time.
    bool tables = false;
    int max_bounces = most_bounces;  ///< specular events between light and receiver
    /// File that the traced photons are written to; empty: none. See photon_map_file.h.
    std::filesystem::path save = {};
    /// File that the photons come from instead of being traced; empty: none. Then photons and
    /// emitted are 0, and the file says how the photons were traced.
    std::filesystem::path load = {};

    bool averages_pixels() const {
        return kernel == KernelKind::photon && pixel_footprint && footprint == 0;
    }

    /// The settings of [J96]: light paths at random, a balanced tree, and the estimate as printed. The
    /// paper does not say N.
    static PhotonMapParams jensen1996() {
        PhotonMapParams params;
        params.kernel = KernelKind::point;
        params.tree = TreeKind::balanced;
        params.estimator = Estimator::raw;
        params.max_bounces = preset_bounces;
        return params;
    }
};

}  // namespace caustics::photonmap
