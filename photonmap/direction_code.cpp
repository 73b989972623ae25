#include "photonmap/direction_code.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace caustics {

namespace {

constexpr int cells = 256;

struct SineCosine {
    float sine;
    float cosine;
};

/// Sine and cosine at the centres of 256 cells of [0, range].
std::array<SineCosine, cells> tabulate(double range) {
    std::array<SineCosine, cells> table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
        const double angle = (static_cast<double>(i) + 0.5) * range / cells;
        table[i] = {static_cast<float>(std::sin(angle)), static_cast<float>(std::cos(angle))};
    }
    return table;
}

const std::array<SineCosine, cells> theta_table = tabulate(pi_d);
const std::array<SineCosine, cells> phi_table = tabulate(2 * pi_d);

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
    const SineCosine t = theta_table[theta];
    const SineCosine p = phi_table[phi];
    return {t.sine * p.cosine, t.sine * p.sine, t.cosine};
}

}  // namespace caustics
