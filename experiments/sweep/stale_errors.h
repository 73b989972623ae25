#pragma once

#include <string>
#include <vector>

#include "experiments/sweep/sweep_status.h"

namespace caustics::experiments {

/// Whether two means of a reference's caustics, as records keep them, may be those of one picture.
bool are_of_one_picture(double mean, double other);

/// The trials whose errors were taken against another picture than the one that stands for their reference now, by
/// their references: `--references rebuild` and `extend` make others of the same name. Known by the mean of what the
/// reference has of caustics, which records keep.
struct StaleErrors {
    std::vector<const Trial*> trials;
    std::vector<std::string> unreadable;  ///< what is wrong with references that cannot be compared
};
StaleErrors stale_errors(const SweepPlan& plan, const SweepStatus& status,
                         ReferenceCache& references);

/// What came of taking a trial's errors anew.
enum class ErrorsAnew {
    picture_is_gone,  ///< nothing
    taken,
    taken_but_flip,  ///< which tools/flip_column.py has to fill again
};

/// Takes the errors of a trial's kept picture anew. Throws InputError when the store cannot be written.
ErrorsAnew take_errors_anew(const Trial& trial, const TrialStore& store,
                            const Reference& reference);

}  // namespace caustics::experiments
