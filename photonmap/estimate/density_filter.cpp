#include "photonmap/estimate/density_filter.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace caustics::photonmap {

namespace {

// What exp(-b u / 2) - exp(-b) is divided by: its mean, or what is printed.
double gaussian_divisor(const DensityFilter& filter) {
    const double b = filter.beta;
    if (filter.alpha > 0) return (1 - std::exp(-b)) / filter.alpha;
    return 2 * (1 - std::exp(-b / 2)) / b - std::exp(-b);
}

// The least degree of Taylor's series whose error at u = 0 and 1 is below 1e-7.
std::size_t gaussian_degree(double beta) {
    std::size_t degree = 0;
    for (double term = beta / 4; term > 1e-7; term *= beta / 4 / static_cast<double>(degree + 1))
        ++degree;
    return std::min(degree, FilterPolynomial::most_coefficients - 1);
}

/// Taylor's series of the exponential round u = 1/2, where its error is least at both ends, as powers
/// of u.
FilterPolynomial gaussian_polynomial(const DensityFilter& filter) {
    FilterPolynomial polynomial{};
    polynomial.degree = gaussian_degree(filter.beta);
    std::array<double, FilterPolynomial::most_coefficients> power{};
    for (std::size_t n = polynomial.degree + 1; n-- > 0;) {
        // Horner's rule on polynomials: times (u - 1/2), plus the next coefficient.
        for (std::size_t i = polynomial.degree; i > 0; --i)
            power[i] = power[i - 1] - 0.5 * power[i];
        power[0] *= -0.5;
        power[0] += std::pow(-filter.beta / 2, static_cast<double>(n)) /
                    std::tgamma(static_cast<double>(n) + 1);
    }
    for (std::size_t i = 0; i <= polynomial.degree; ++i) {
        const double constant = i == 0 ? std::exp(-filter.beta) : 0;
        polynomial.coefficient[i] = static_cast<float>(
            (std::exp(-filter.beta / 4) * power[i] - constant) / gaussian_divisor(filter));
    }
    return polynomial;
}

}  // namespace

double DensityFilter::weight(double u) const {
    switch (kind) {
        case FilterKind::cone: return (1 - std::sqrt(u) / k) / (1 - 2 / (3 * k));
        case FilterKind::gaussian:
            return (std::exp(-beta * u / 2) - std::exp(-beta)) / gaussian_divisor(*this);
        case FilterKind::epanechnikov: return 2 * (1 - u);
        case FilterKind::none: break;
    }
    return 1;
}

FilterPolynomial DensityFilter::polynomial() const {
    switch (kind) {
        case FilterKind::cone: {
            const double mean = 1 - 2 / (3 * k);
            return {{static_cast<float>(1 / mean), static_cast<float>(-1 / (k * mean))}, 1, true};
        }
        case FilterKind::gaussian: return gaussian_polynomial(*this);
        case FilterKind::epanechnikov: return {{2, -2}, 1, false};
        case FilterKind::none: break;
    }
    return {{1}, 0, false};
}

FilterPolynomial DensityFilter::profile_integral() const {
    FilterPolynomial profile = polynomial();
    // The power of z in the integral of the n-th term.
    const auto power = [&profile](std::size_t n) {
        return static_cast<double>(profile.of_distance ? n + 1 : 2 * n + 1);
    };
    double end = 0;
    for (std::size_t n = 0; n <= profile.degree; ++n)
        end += static_cast<double>(profile.coefficient[n]) / power(n);
    for (std::size_t n = 0; n <= profile.degree; ++n)
        profile.coefficient[n] =
            static_cast<float>(static_cast<double>(profile.coefficient[n]) / (2 * end * power(n)));
    return profile;
}

}  // namespace caustics::photonmap
