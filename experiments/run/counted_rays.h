#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/caustic_estimator.h"
#include "core/scene/scene.h"
#include "experiments/run/caustic_ledger.h"

namespace caustics::experiments {

/// How a method that searches for rays at points counts the light that arrives on receivers.
struct CountedRays {
    /// A share of the light of the rays that were asked about, with its standard error.
    struct Share {
        double value = 0;
        double error = 0;
    };
    Share missed;             ///< RayCount::missed
    Share spread;             ///< RayCount::spread
    std::uint64_t asked = 0;  ///< rays
};

/// Asks a built method about some hundreds of light paths of up to so many events, each where it arrives. Empty for methods
/// that do not search for rays, and where no light arrives. The same for any number of threads.
std::optional<CountedRays> counted_rays(const Scene& scene, const CausticEstimator& built,
                                        int max_bounces, int threads);

/// One line for light that is not found and that the ledger does not tell of, and one for light that is spread. A share below
/// 1 %, or below two standard errors, has no line.
std::vector<std::string> notes_on(const CountedRays& rays, const CausticLedger& ledger);

}  // namespace caustics::experiments
