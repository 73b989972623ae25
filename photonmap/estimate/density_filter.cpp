#include "photonmap/estimate/density_filter.h"

#include <array>
#include <cmath>

namespace caustics {

namespace {

constexpr double cone_constant = 1.1;
constexpr double gaussian_constant = 1.953;

double gaussian_mean() {
    const double b = gaussian_constant;
    return 2 * (1 - std::exp(-b / 2)) / b - std::exp(-b);
}

/// Taylor's series of the exponential round u = 1/2, where its error is 1e-7 at both ends, as
/// powers of u.
FilterPolynomial gaussian_polynomial() {
    FilterPolynomial polynomial{};
    polynomial.degree = FilterPolynomial::most_coefficients - 1;
    std::array<double, FilterPolynomial::most_coefficients> power{};
    for (std::size_t n = polynomial.degree + 1; n-- > 0;) {
        // Horner's rule on polynomials: times (u - 1/2), plus the next coefficient.
        for (std::size_t i = polynomial.degree; i > 0; --i)
            power[i] = power[i - 1] - 0.5 * power[i];
        power[0] *= -0.5;
        power[0] += std::pow(-gaussian_constant / 2, static_cast<double>(n)) /
                    std::tgamma(static_cast<double>(n) + 1);
    }
    for (std::size_t i = 0; i <= polynomial.degree; ++i) {
        const double constant = i == 0 ? std::exp(-gaussian_constant) : 0;
        polynomial.coefficient[i] = static_cast<float>(
            (std::exp(-gaussian_constant / 4) * power[i] - constant) / gaussian_mean());
    }
    return polynomial;
}

FilterPolynomial cone_polynomial() {
    const double mean = 1 - 2 / (3 * cone_constant);
    return {
        {static_cast<float>(1 / mean), static_cast<float>(-1 / (cone_constant * mean))}, 1, true};
}

}  // namespace

double filter_weight(FilterKind kind, double u) {
    switch (kind) {
        case FilterKind::cone:
            return (1 - std::sqrt(u) / cone_constant) / (1 - 2 / (3 * cone_constant));
        case FilterKind::gaussian:
            return (std::exp(-gaussian_constant * u / 2) - std::exp(-gaussian_constant)) /
                   gaussian_mean();
        case FilterKind::epanechnikov: return 2 * (1 - u);
        case FilterKind::none: break;
    }
    return 1;
}

const FilterPolynomial& filter_polynomial(FilterKind kind) {
    static const FilterPolynomial none{{1}, 0, false};
    static const FilterPolynomial cone = cone_polynomial();
    static const FilterPolynomial gaussian = gaussian_polynomial();
    static const FilterPolynomial epanechnikov{{2, -2}, 1, false};
    switch (kind) {
        case FilterKind::cone: return cone;
        case FilterKind::gaussian: return gaussian;
        case FilterKind::epanechnikov: return epanechnikov;
        case FilterKind::none: break;
    }
    return none;
}

}  // namespace caustics
