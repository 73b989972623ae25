#pragma once

#include <cstddef>
#include <vector>

namespace caustics::support {

/// Mean and spread of numbers as they come.
class Moments {
public:
    void add(double x) {
        ++count_;
        const double step = x - mean_;
        mean_ += step / static_cast<double>(count_);
        squares_ += step * (x - mean_);
    }
    std::size_t count() const { return count_; }
    double mean() const { return mean_; }
    /// Of one number.
    double deviation() const;
    /// Of the mean.
    double standard_error() const;

private:
    std::size_t count_ = 0;
    double mean_ = 0;
    double squares_ = 0;
};

/// P(Z > z) of the normal distribution.
double normal_upper_tail(double z);

/// The |z| that the largest of `count` independent z-scores stays below with probability
/// 1 - `risk`, if each is normal (Sidak's correction).
double sidak_bound(std::size_t count, double risk = 1e-3);

/// P(X > x) of the chi-square distribution by Wilson and Hilferty's cube root, good to 1e-3 in the
/// tail for ten degrees of freedom and more.
double chi_square_upper_tail(double x, double degrees);

/// A chi-square test of counts against their expected values; cells that expect fewer than 5 are
/// pooled. Returns the p-value. The expected values must sum to the counts' sum.
double chi_square_p_value(const std::vector<double>& counts, const std::vector<double>& expected);

}  // namespace caustics::support
