#include "photonmap/direction_code.h"

#include <algorithm>
#include <cmath>

#include "photonmap/direction_tables.h"

namespace caustics {

namespace {

constexpr int cells = 256;

}  // namespace

DirectionCode encode_direction(const Vec3& direction) {
    const double theta = std::acos(std::clamp(static_cast<double>(direction.z()), -1.0, 1.0));
    const double phi =
        std::atan2(static_cast<double>(direction.y()), static_cast<double>(direction.x()));
    // theta = pi belongs to the last cell; phi in (-pi, pi] wraps round.
    const int theta_cell = std::min(static_cast<int>(theta / pi_d * cells), cells - 1);
    const int phi_cell = static_cast<int>(std::floor(phi / (2 * pi_d) * cells));
    return {static_cast<std::uint8_t>(theta_cell),
            static_cast<std::uint8_t>((phi_cell + cells) % cells)};
}

Vec3 decode_direction(std::uint8_t theta, std::uint8_t phi) {
    const SineCosine t = direction_tables().theta[theta];
    const SineCosine p = direction_tables().phi[phi];
    return {t.sine * p.cosine, t.sine * p.sine, t.cosine};
}

}  // namespace caustics
