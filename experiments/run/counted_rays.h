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
    /// Of the light of the rays that were asked about, with its standard error.
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

/// A line each where 1 % or more of the light is not found, beside what the ledger tells, or is spread; no more than
/// chance is not told.
std::vector<std::string> notes_on(const CountedRays& rays, const CausticLedger& ledger);

}  // namespace caustics::experiments
