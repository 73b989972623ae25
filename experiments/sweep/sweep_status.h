#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "experiments/plan/reference_cache.h"
#include "experiments/plan/sweep_plan.h"
#include "experiments/plan/trial_store.h"
#include "experiments/sweep/cost_estimate.h"
#include "experiments/sweep/sweep_options.h"

namespace caustics::experiments {

/// How far a sweep is, from its plan and what its folder holds.
struct SweepStatus {
    std::vector<const Trial*> share;              ///< the shard's trials, in the order to run
    std::vector<const Trial*> todo;               ///< those of them to run
    std::map<std::string, std::string> statuses;  ///< by id, of the trials with a record
    std::map<std::string, std::string> broken;    ///< ids of broken records, with what is wrong
    /// Means of the references that trials were judged by, by id.
    std::map<std::string, double> judged_by;
    std::map<std::string, std::size_t> other_code;  ///< records by another code version
    std::set<int> threads;                          ///< of the records that are done
    std::set<std::string> isas;                     ///< of the same
    CostEstimate costs;                             ///< from the records

    /// Of the shard's trials.
    std::size_t count(const std::string& status) const;
    /// The references of `todo` that have to be rendered, each once. With everything done, a cache that makes all
    /// anew still remakes what the trials stand on.
    std::vector<const ReferenceRequest*> references(const ReferenceCache& cache) const;
    /// Seconds and bytes of `todo`, one after the other; empty when not known.
    std::optional<Cost> cost() const;
    /// A line on results by other code; empty when there are none.
    std::string code_warning() const;
    /// The same on threads and instruction sets, whose times do not compare.
    std::string times_warning(const SweepOptions& options) const;
};

/// Looks at every trial once (TrialRows).
SweepStatus sweep_status(const SweepPlan& plan, const SweepOptions& options,
                         const TrialStore& store);

}  // namespace caustics::experiments
