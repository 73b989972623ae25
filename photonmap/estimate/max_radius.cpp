#include "photonmap/estimate/max_radius.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace caustics::photonmap {

namespace {

/// Distance between the 1st and 99th percentile of a coordinate of at most some 10,000 photons.
double middle_extent(std::span<const Photon> photons, int axis) {
    const std::size_t stride = photons.size() / 10'000 + 1;
    std::vector<float> values;
    for (std::size_t i = 0; i < photons.size(); i += stride)
        values.push_back(photons[i].position[axis]);
    std::ranges::sort(values);
    const std::size_t cut = values.size() / 100;
    return static_cast<double>(values[values.size() - 1 - cut]) - static_cast<double>(values[cut]);
}

double projected_area(const Vec3d& sides) {
    return sides.x() * sides.y() + sides.y() * sides.z() + sides.z() * sides.x();
}

}  // namespace

double default_max_radius(std::span<const Photon> photons, const Box& scene_bounds, int nearest) {
    double area = 0;
    if (!photons.empty())
        area = projected_area(
            {middle_extent(photons, 0), middle_extent(photons, 1), middle_extent(photons, 2)});
    if (area == 0) area = projected_area(scene_bounds.sizes().cast<double>());
    const double count = std::max(1.0, static_cast<double>(photons.size()));
    return 3 * std::sqrt(nearest * area / (pi_d * count));
}

}  // namespace caustics::photonmap
