#include "experiments/sweep/cost_estimate.h"

#include <array>
#include <cmath>

namespace caustics::experiments {

namespace {

/// The groups a trial is in, the closest first.
std::array<std::string, 4> groups(const Trial& trial) {
    const std::string& method = trial.request.method.name;
    return {"cell " + trial.cell, "pair " + method + " " + trial.scene_name, "method " + method,
            "all"};
}

std::string pair_of(const Trial& trial) { return groups(trial)[1]; }

/// That time is linear in; none for a method without such a number.
std::optional<double> work_of(const Trial& trial) {
    const Method& method = trial.request.method;
    if (method.configured == nullptr) return {};
    const WorkParameter work = method.configured->work();
    for (const auto& [key, value] : method.configured->values())
        if (key == work.parameter)
            return std::pow(static_cast<double>(std::get<std::int64_t>(value)), work.power);
    return {};
}

}  // namespace

void CostEstimate::Line::add(double of_work, double of_seconds) {
    ++count;
    work += of_work;
    square += of_work * of_work;
    seconds += of_seconds;
    product += of_work * of_seconds;
}

std::optional<double> CostEstimate::Line::at(double of_work) const {
    const double spread = count * square - work * work;
    const double slope = (count * product - work * seconds) / spread;
    if (!(spread > 1e-9 * count * square) || !(slope > 0)) return {};
    const double start = (seconds - slope * work) / count;
    return start > 0 ? start + slope * of_work : product / square * of_work;
}

void CostEstimate::add(const Trial& trial, const Cost& cost) {
    for (const std::string& group : groups(trial)) {
        Mean& mean = means_[group];
        mean.sum.seconds += cost.seconds;
        mean.sum.bytes += cost.bytes;
        ++mean.count;
    }
    if (const std::optional<double> work = work_of(trial))
        lines_[pair_of(trial)].add(*work, cost.seconds);
}

std::optional<Cost> CostEstimate::of(const Trial& trial) const {
    for (const std::string& group : groups(trial)) {
        const auto found = means_.find(group);
        if (found == means_.end()) continue;
        const auto count = static_cast<double>(found->second.count);
        Cost cost{found->second.sum.seconds / count, found->second.sum.bytes / count};
        const auto line = lines_.find(group);
        if (line == lines_.end()) return cost;
        if (const std::optional<double> work = work_of(trial))
            cost.seconds = line->second.at(*work).value_or(cost.seconds);
        return cost;
    }
    return {};
}

}  // namespace caustics::experiments
