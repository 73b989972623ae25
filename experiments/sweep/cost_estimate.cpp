#include "experiments/sweep/cost_estimate.h"

#include <array>

namespace caustics::experiments {

namespace {

/// The groups a trial is in, the closest first.
std::array<std::string, 4> groups(const Trial& trial) {
    const std::string& method = trial.request.method.name;
    return {"cell " + trial.cell, "pair " + method + " " + trial.scene_name, "method " + method,
            "all"};
}

}  // namespace

void CostEstimate::add(const Trial& trial, const Cost& cost) {
    for (const std::string& group : groups(trial)) {
        Mean& mean = means_[group];
        mean.sum.seconds += cost.seconds;
        mean.sum.bytes += cost.bytes;
        ++mean.count;
    }
}

std::optional<Cost> CostEstimate::of(const Trial& trial) const {
    for (const std::string& group : groups(trial)) {
        const auto found = means_.find(group);
        if (found == means_.end()) continue;
        const auto count = static_cast<double>(found->second.count);
        return Cost{found->second.sum.seconds / count, found->second.sum.bytes / count};
    }
    return {};
}

}  // namespace caustics::experiments
