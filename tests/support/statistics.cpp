#include "tests/support/statistics.h"

#include <cmath>

namespace caustics::support {

double Moments::deviation() const {
    return count_ > 1 ? std::sqrt(squares_ / static_cast<double>(count_ - 1)) : 0;
}

double Moments::standard_error() const {
    return deviation() / std::sqrt(static_cast<double>(count_));
}

double normal_upper_tail(double z) { return 0.5 * std::erfc(z / std::sqrt(2.0)); }

double sidak_bound(std::size_t count, double risk) {
    const double each = -std::expm1(std::log1p(-risk) / static_cast<double>(count));
    double low = 0;
    double high = 40;
    for (int i = 0; i < 100; ++i) {
        const double middle = (low + high) / 2;
        (2 * normal_upper_tail(middle) > each ? low : high) = middle;
    }
    return high;
}

double chi_square_upper_tail(double x, double degrees) {
    const double variance = 2 / (9 * degrees);
    return normal_upper_tail((std::cbrt(x / degrees) - (1 - variance)) / std::sqrt(variance));
}

double chi_square_p_value(const std::vector<double>& counts, const std::vector<double>& expected) {
    double sum = 0;
    double pooled_count = 0;
    double pooled_expected = 0;
    int cells = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (expected[i] < 5) {
            pooled_count += counts[i];
            pooled_expected += expected[i];
            continue;
        }
        sum += (counts[i] - expected[i]) * (counts[i] - expected[i]) / expected[i];
        ++cells;
    }
    if (pooled_expected >= 5) {
        sum +=
            (pooled_count - pooled_expected) * (pooled_count - pooled_expected) / pooled_expected;
        ++cells;
    } else if (pooled_count > pooled_expected + 5 * std::sqrt(pooled_expected) + 5) {
        return 0;  // Hits where hardly any belong.
    }
    return chi_square_upper_tail(sum, cells - 1);
}

}  // namespace caustics::support
