#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include "experiments/plan/sweep_plan.h"

namespace caustics::experiments {

/// What a trial costs.
struct Cost {
    double seconds = 0;  ///< on the wall, from its start until its files are there
    double bytes = 0;    ///< of its picture
};

/// Guesses what trials will cost from those that ran: the mean over the same cell, or else the same
/// scene and method, the same method, all.
class CostEstimate {
public:
    void add(const Trial& trial, const Cost& cost);
    /// Empty before anything was added.
    std::optional<Cost> of(const Trial& trial) const;

private:
    struct Mean {
        Cost sum;
        std::size_t count = 0;
    };
    std::map<std::string, Mean> means_;
};

}  // namespace caustics::experiments
