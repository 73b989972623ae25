#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/run/method.h"

namespace caustics::experiments {

/// A method with the parameters that were given for it ("key=value"), the others at their defaults.
struct MethodAsGiven {
    Method method;
    std::vector<std::string> params;

    MethodAsGiven(const std::string& name, std::vector<std::string> given);
    /// The same with `factor` times the work: the method's work parameter grows, and what refines its answer along
    /// with it. Throws InputError where it cannot.
    MethodAsGiven with_more_work(int factor) const;
    /// "photons=400000", or several of these.
    std::string work_text() const;
};

}  // namespace caustics::experiments
