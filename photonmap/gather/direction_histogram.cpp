#include "photonmap/gather/direction_histogram.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/math/spectrum.h"
#include "photonmap/photons/direction_code.h"
#include "photonmap/photons/rgbe.h"

namespace caustics::photonmap {

DirectionHistogram::DirectionHistogram(const Vec3& normal, const GatheredPhotons& photons)
    : frame_(normal) {
    std::array<double, cells> flux{};
    double total = 0;
    for (std::size_t i = 0; i < photons.count; ++i) {
        const auto code = std::bit_cast<DirectionCode>(photons.direction[i]);
        const Vec3 wi = decode_direction(code.theta, code.phi);
        const float x = wi.dot(frame_.s);
        const float y = wi.dot(frame_.t);
        if (!(wi.dot(frame_.n) > 0)) continue;
        const double turn = std::atan2(static_cast<double>(y), static_cast<double>(x)) / (2 * pi_d);
        const auto ring = static_cast<std::size_t>(std::min(x * x + y * y, 0.999999F) * rings);
        const auto sector =
            std::min(static_cast<std::size_t>((turn < 0 ? turn + 1 : turn) * sectors), sectors - 1);
        const auto energy =
            static_cast<double>(decode_rgbe(std::bit_cast<Rgbe>(photons.energy[i])).mean());
        flux[ring * sectors + sector] += energy;
        total += energy;
    }
    double sum = 0;
    for (std::size_t i = 0; i < cells; ++i) {
        const double even = 1.0 / cells;
        cumulative_[i] = sum += total > 0 ? 0.5 * even + 0.5 * flux[i] / total : even;
    }
}

DirectionHistogram::Sample DirectionHistogram::sample(double u0, double u1) const {
    const double at = u0 * cumulative_.back();
    const auto found = std::ranges::upper_bound(cumulative_, at);
    const std::size_t cell =
        std::min(static_cast<std::size_t>(found - cumulative_.begin()), cells - 1);
    const double before = cell == 0 ? 0 : cumulative_[cell - 1];
    const double chance = (cumulative_[cell] - before) / cumulative_.back();
    const double rest = std::clamp((at - before) / (cumulative_[cell] - before), 0.0, 1.0);
    const double square = (static_cast<double>(cell / sectors) + rest) / rings;
    const double angle = 2 * pi_d * (static_cast<double>(cell % sectors) + u1) / sectors;
    const double radius = std::sqrt(square);
    const Vec3d local(radius * std::cos(angle), radius * std::sin(angle),
                      std::sqrt(std::max(0.0, 1 - square)));
    return {frame_.to_world(local.cast<float>()).normalized(),
            static_cast<float>(1 / (chance * cells))};
}

}  // namespace caustics::photonmap
