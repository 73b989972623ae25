#include "photonmap/photons/faint_channels.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace caustics::photonmap {

double faint_flux_share(std::span<const Photon> photons) {
    std::array<double, 3> all{}, faint{};
    for (const Photon& photon : photons) {
        const double unit = std::ldexp(1.0, photon.energy.exponent - 136);
        for (std::size_t c = 0; c < 3; ++c) {
            const unsigned mantissa = photon.energy.mantissa[c];
            all[c] += unit * mantissa;
            faint[c] += mantissa == 1 ? unit : 0;
        }
    }
    double largest = 0;
    for (std::size_t c = 0; c < 3; ++c)
        if (all[c] > 0) largest = std::max(largest, faint[c] / all[c]);
    return largest;
}

}  // namespace caustics::photonmap
