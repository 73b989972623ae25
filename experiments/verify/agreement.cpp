#include "experiments/verify/agreement.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace caustics::experiments {

namespace {

constexpr double least_order = 0.25;

/// The log of a difference; what is below its own standard error is known no better than that.
double log_size(const Difference& d) {
    constexpr double rounding = 1e-6;
    return std::log(std::max({std::abs(d.value), d.error, rounding}));
}

/// Aitken's limit of a sequence of three.
double aitken(const std::array<double, work_steps>& x) {
    const double step = x[2] - x[1];
    return x[2] - step * step / (step - (x[1] - x[0]));
}

/// Empty where the second step is not the smaller one: nothing then tells of a limit.
std::optional<Difference> remaining(std::span<const Difference, work_steps> d) {
    const std::array<double, work_steps> x = {d[0].value, d[1].value, d[2].value};
    const double first = x[1] - x[0], second = x[2] - x[1];
    if (first * second <= 0 || std::abs(second) >= std::abs(first)) return {};
    Difference rest{aitken(x), 0};
    for (std::size_t i = 0; i < x.size(); ++i) {
        auto moved = x;
        moved[i] += 0.01 * std::abs(second);
        const double slope = (aitken(moved) - rest.value) / (0.01 * std::abs(second));
        rest.error = std::hypot(rest.error, slope * d[i].error);
    }
    return rest;
}

bool grows(const Difference& from, const Difference& to) {
    return std::abs(to.value) - std::abs(from.value) >
           Limit::errors * std::hypot(from.error, to.error);
}

}  // namespace

const char* word(Agreement agreement) {
    switch (agreement) {
        case Agreement::holds: return "holds";
        case Agreement::converges: return "converges";
        case Agreement::fails: return "fails";
        default: return "unsure";
    }
}

bool Limit::is_exceeded(const Difference& d) const {
    return std::abs(d.value) > share + errors * d.error;
}

bool Limit::is_known(const Difference& d) const {
    return can_judge(d) || std::abs(d.value) >= errors * d.error;
}

Limit limit_of_part(Limit whole, std::size_t parts) {
    return {whole.share * std::sqrt(static_cast<double>(parts))};
}

std::string Convergence::text() const {
    std::string text = fmt::format("order {:.2f}", order);
    if (remaining)
        text += fmt::format(", extrapolated to {:.4f} +- {:.4f}", 1 + remaining->value,
                            remaining->error);
    return text;
}

Convergence convergence(std::span<const Difference, work_steps> differences, const Limit& limit) {
    const double decades = std::log(std::pow(work_factor, work_steps - 1));
    Convergence found;
    found.order = (log_size(differences.front()) - log_size(differences.back())) / decades;
    found.remaining = remaining(differences);
    const bool goes_to_zero = !found.remaining || !limit.is_exceeded(*found.remaining);
    found.shrinks = found.order >= least_order && goes_to_zero &&
                    !grows(differences[0], differences[1]) &&
                    !grows(differences[1], differences[2]);
    return found;
}

}  // namespace caustics::experiments
