#include "photonmap/estimate/square_kernel.h"

#include <algorithm>
#include <cmath>

namespace caustics::photonmap {

namespace {

// Squares below this share of h are enlarged to it, so that differences of F in floats keep their digits; the
// kernel's variance grows by a part in three thousand at most.
constexpr double least_share = 1.0 / 64;

constexpr std::size_t rim_steps = 256;
constexpr int rim_angles = 128;

/// Of z in the integral of the polynomial's n-th term.
double power_of(const FilterPolynomial& polynomial, std::size_t n) {
    return static_cast<double>(polynomial.of_distance ? n + 1 : 2 * n + 1);
}

/// The profile k, its integral F from the middle and F's own, H, in double.
struct Profile {
    const FilterPolynomial& integral;

    double k(double z) const {
        return std::abs(z) > 1 ? 0 : sum(std::abs(z), [](double power) { return power; });
    }
    double F(double z) const {
        const double inside = std::clamp(z, -1.0, 1.0);
        return inside * sum(std::abs(inside), [](double) { return 1.0; });
    }
    double H(double z) const {
        const double inside = std::min(std::abs(z), 1.0);
        return inside * inside * sum(inside, [](double power) { return 1 / (power + 1); }) +
               (std::abs(z) - inside) / 2;
    }

private:
    /// Of coefficient x factor(power) x z^(power - 1), power being that of z in F.
    template <typename Factor>
    double sum(double z, const Factor& factor) const {
        const double step = integral.of_distance ? z : z * z;
        double total = 0;
        for (std::size_t n = integral.degree + 1; n-- > 0;)
            total = total * step +
                    static_cast<double>(integral.coefficient[n]) * factor(power_of(integral, n));
        return total;
    }
};

/// g'(a) (2 s)^2 for s = 1, r = p, by the derivative under the integral over the disc,
/// g = int t(p sin u) T(p cos u) p cos u du, T(y) = int of t from -y to y, over (2 s)^2.
double rim_at(const Profile& profile, double p, double narrowing) {
    const double h = narrowing * p;
    double derivative = 0;
    for (int i = 0; i < rim_angles; ++i) {
        const double u = (i + 0.5) / rim_angles * pi_d / 2;
        const double sine = std::sin(u), cosine = std::cos(u);
        const double right = (p * sine + 1) / h, left = (p * sine - 1) / h;
        const double above = (p * cosine + 1) / h, below = (p * cosine - 1) / h;
        const double t = profile.F(right) - profile.F(left);
        const double T = 2 * h * (profile.H(above) - profile.H(below));
        const double dt = -(profile.k(right) + profile.k(left)) / (h * p);
        const double dT = T / p - 2 * (profile.F(above) + profile.F(below)) / p;
        derivative += (dt * T * p + t * dT * p + t * T) * cosine;
    }
    // Both halves of the disc; da = 2 pi p dp.
    return 2 * derivative * (pi_d / 2 / rim_angles) / (2 * pi_d * p);
}

}  // namespace

SquareKernel::SquareKernel(const DensityFilter& filter, double side, double share)
    : profile_(filter.profile_integral()),
      half_(side / 2),
      narrowing_(std::sqrt(share / 2) / (1 + least_share)),
      rim_(rim_steps + 1, 1) {
    const Profile profile{profile_};
    for (std::size_t i = 1; i < rim_steps; ++i) {
        const double x = static_cast<double>(i) / rim_steps;
        rim_[i] = rim_at(profile, x / (1 - x), narrowing_);
    }
    rim_[rim_steps] = 0;
}

double SquareKernel::rim_weight(double p) const {
    const double place = p / (1 + p) * rim_steps;
    const auto before = std::min(static_cast<std::size_t>(place), rim_steps - 1);
    const double way = place - static_cast<double>(before);
    return (1 - way) * rim_[before] + way * rim_[before + 1];
}

SquareKernel::Reach SquareKernel::reach(double radius) const {
    Reach found{half_, narrowing_ * radius, 0};
    // The square grows with r then, and g is the same for every r.
    if (half_ < least_share * found.reach)
        found.half = least_share * found.reach;
    else
        found.rim = rim_weight(radius / half_);
    return found;
}

}  // namespace caustics::photonmap
