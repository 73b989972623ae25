#include "photonmap/direction_code.h"

#include <algorithm>
#include <cmath>

#include "photonmap/direction_tables.h"

namespace caustics {

namespace {

constexpr int cells = 256;

// The angle of (x, y) from +x in units of pi/128, in (-128, 128], good to 1e-5: a polynomial for an
// eighth of a turn, the rest by symmetry, so that multiples of a quarter turn are exact.
float angle_in_cells(float y, float x) {
    const float across = std::abs(y);
    const float along = std::abs(x);
    const float larger = std::max(across, along);
    if (larger == 0) return 0;
    const float t = std::min(across, along) / larger;
    const float t2 = t * t;
    float angle = 0.100093545F;
    for (const float c : {-0.586753924F, 1.62081524F, -2.94772993F, 4.27764705F, -5.76980136F,
                          8.1429906F, -13.5809218F, 40.7436608F})
        angle = angle * t2 + c;
    angle *= t;
    if (across > along) angle = 64 - angle;
    if (x < 0) angle = 128 - angle;
    return y < 0 ? -angle : angle;
}

}  // namespace

DirectionCode encode_direction(const Vec3& direction) {
    const float x = direction.x();
    const float y = direction.y();
    const float theta = 2 * angle_in_cells(std::sqrt(x * x + y * y), direction.z());
    const float phi = angle_in_cells(y, x);
    // theta = pi belongs to the last cell; phi wraps round.
    const int theta_cell = std::min(static_cast<int>(theta), cells - 1);
    const int phi_cell = static_cast<int>(phi + cells) % cells;
    return {static_cast<std::uint8_t>(theta_cell), static_cast<std::uint8_t>(phi_cell)};
}

Vec3 decode_direction(std::uint8_t theta, std::uint8_t phi) {
    const SineCosine t = direction_tables().theta[theta];
    const SineCosine p = direction_tables().phi[phi];
    return {t.sine * p.cosine, t.sine * p.sine, t.cosine};
}

}  // namespace caustics
