#include "photonmap/estimate/cell_kernel.h"

#include <cmath>

namespace caustics::photonmap {
namespace {

/// Half of the kernel's width whose scatter along an axis is that of the filter over the unit disc: the mean of x^2 is
/// that of r^2 / 2 over the disc, and that of z^2 over the profile.
double width_of(const DensityFilter& filter) {
    constexpr int steps = 1024;
    double on_disc = 0, disc = 0, on_profile = 0, profile = 0;
    for (int i = 0; i < steps; ++i) {
        const double z = (i + 0.5) / steps;
        const double weight = filter.weight(z * z);
        disc += weight * z;
        on_disc += weight * z * z * z / 2;
        profile += weight;
        on_profile += weight * z * z;
    }
    return std::sqrt(on_disc / disc / (on_profile / profile));
}

}  // namespace

CellKernel::CellKernel(const DensityFilter& filter)
    : profile_(filter.profile_integral()), width_(width_of(filter)) {}

double CellKernel::reach() const { return std::sqrt(2.0) * width_; }

double CellKernel::width(double cosine) const { return width_ / std::sqrt(1 + std::abs(cosine)); }

}  // namespace caustics::photonmap
