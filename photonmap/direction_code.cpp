#include "photonmap/direction_code.h"

#include <algorithm>
#include <cmath>

#include "photonmap/direction_tables.h"

namespace caustics {

namespace {

constexpr int cells = 256;

/// Sine and cosine at the centres of 256 cells of [0, range].
void tabulate(double range, SineCosine (&table)[cells]) {
    for (int i = 0; i < cells; ++i) {
        const double angle = (i + 0.5) * range / cells;
        table[i] = {static_cast<float>(std::sin(angle)), static_cast<float>(std::cos(angle))};
    }
}

DirectionTables tabulate() {
    DirectionTables tables;
    tabulate(pi_d, tables.theta);
    tabulate(2 * pi_d, tables.phi);
    return tables;
}

const DirectionTables tables = tabulate();

}  // namespace

const DirectionTables& direction_tables() { return tables; }

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
    const SineCosine t = tables.theta[theta];
    const SineCosine p = tables.phi[phi];
    return {t.sine * p.cosine, t.sine * p.sine, t.cosine};
}

}  // namespace caustics
