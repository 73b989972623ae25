#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "beamtree/beams/light_sample.h"
#include "beamtree/pencils/pencil_print.h"
#include "core/light_path/bounce_limit.h"
#include "core/run_options.h"

namespace caustics::beamtree {

struct PencilSettings {
    std::uint64_t count = 0;  ///< about, over all lights and casters
    int max_bounces = most_bounces;
};

/// The prints of pencils, in an order that does not depend on threads.
struct TracedPencils {
    std::vector<PencilPrint> prints;
    std::uint64_t traced = 0;  ///< pencils
};

/// Pencils: light paths with the derivatives of place and direction by the two sides of a stratum. Each light sample and
/// caster has a grid of strata, shifted at random as a whole, and a path from the middle of each. The strata's images, by
/// those derivatives, tile what the light falls on, so that a pencil is the beam of its stratum (photon differentials:
/// Igehy 1999, Schjoth et al. 2007). Both branches of an interface are followed while they have light; a faint one goes
/// on by chance, for as many strata as it then stands for. A pencil of an earlier caster's light is not followed: that
/// caster's own grid has it.
TracedPencils trace_pencils(const Scene& scene, std::span<const LightSample> lights,
                            const PencilSettings& settings, const RunOptions& options);

}  // namespace caustics::beamtree
