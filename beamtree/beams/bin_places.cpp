#include "beamtree/beams/bin_places.h"

#include <algorithm>
#include <cmath>

namespace caustics::beamtree {

BinPlaces::BinPlaces(const WavelengthBin& bin, const Ior& glass) {
    const double first = glass.at(bin.from);
    const double last = glass.at(bin.to);
    nm_.front() = static_cast<double>(bin.from);
    nm_.back() = static_cast<double>(bin.to);
    for (std::size_t i = 1; i < steps; ++i) {
        const double wanted = first + (last - first) * static_cast<double>(i) / steps;
        double low = nm_.front();
        double high = nm_.back();
        for (int k = 0; k < 50; ++k) {
            const double middle = (low + high) / 2;
            const bool before =
                (glass.at(static_cast<float>(middle)) - wanted) * (last - first) < 0;
            (before ? low : high) = middle;
        }
        nm_[i] = high;
    }
}

double BinPlaces::wavelength_at(double place) const {
    const double at = std::clamp((place + 1) / 2 * steps, 0.0, 1.0 * steps);
    const auto step = std::min(static_cast<std::size_t>(at), std::size_t{steps - 1});
    return nm_[step] + (at - static_cast<double>(step)) * (nm_[step + 1] - nm_[step]);
}

double BinPlaces::place_of(double wavelength) const {
    const auto above = std::upper_bound(nm_.begin() + 1, nm_.end() - 1, wavelength);
    const auto step = static_cast<std::size_t>(above - nm_.begin()) - 1;
    const double share = (wavelength - nm_[step]) / (nm_[step + 1] - nm_[step]);
    return 2 * (static_cast<double>(step) + share) / steps - 1;
}

}  // namespace caustics::beamtree
