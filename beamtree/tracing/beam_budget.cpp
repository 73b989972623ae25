#include "beamtree/tracing/beam_budget.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace caustics::beamtree {
namespace {

// Into which each factor of two is divided.
constexpr int steps = 16;

// Exact in doubles, so that a step's beams are those from its least to the next one's.
int step_of(double light) {
    int exponent = 0;
    const double mantissa = std::frexp(light, &exponent);
    return exponent * steps + static_cast<int>(std::floor((2 * mantissa - 1) * steps));
}

double least_of(int step) {
    const int exponent = static_cast<int>(std::floor(static_cast<double>(step) / steps));
    return std::ldexp((1 + static_cast<double>(step - exponent * steps) / steps) / 2, exponent);
}

}  // namespace

BeamBudget::BeamBudget(std::uint64_t most, double least) : most_(most), least_(least) {}

void BeamBudget::count(double light) {
    if (!(light > 0) || light < least_) return;
    // Infinite where media leave less than floats hold.
    ++counts_[step_of(std::min(light, std::numeric_limits<double>::max()))];
    ++total_;
    if (total_ > most_) leave_out_weakest();
}

void BeamBudget::add(const BeamBudget& other) {
    for (const auto& [step, count] : other.counts_) {
        counts_[step] += count;
        total_ += count;
    }
    while (total_ > most_) leave_out_weakest();
}

bool BeamBudget::all_have(double light) const {
    return counts_.empty() || least_of(counts_.begin()->first) >= light;
}

void BeamBudget::leave_out_weakest() {
    const auto weakest = counts_.begin();
    total_ -= weakest->second;
    least_ = std::max(least_, least_of(weakest->first + 1));
    counts_.erase(weakest);
    is_over_ = true;
}

}  // namespace caustics::beamtree
