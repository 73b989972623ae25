#include "photonmap/photons/direction_code.h"

#include <algorithm>
#include <cmath>

#include "photonmap/photons/direction_tables.h"

namespace caustics::photonmap {

namespace {

constexpr int cells = 256;

// Numbers side by side in a register that every processor has.
using Lanes = float __attribute__((vector_size(16)));

// The angles of (x, y) from +x in units of pi/128, in (-128, 128], good to 1e-5: a polynomial for an
// eighth of a turn, the rest by symmetry, so that multiples of a quarter turn are exact.
Lanes angles_in_cells(const Lanes& y, const Lanes& x) {
    const Lanes across = y < 0 ? -y : y;
    const Lanes along = x < 0 ? -x : x;
    const Lanes larger = across < along ? along : across;
    const Lanes t = (across < along ? across : along) / larger;
    const Lanes t2 = t * t;
    Lanes angle = t2 * 0.100093545F + -0.586753924F;
    for (const float c : {1.62081524F, -2.94772993F, 4.27764705F, -5.76980136F, 8.1429906F,
                          -13.5809218F, 40.7436608F})
        angle = angle * t2 + c;
    angle *= t;
    angle = across > along ? 64 - angle : angle;
    angle = x < 0 ? 128 - angle : angle;
    angle = y < 0 ? -angle : angle;
    return larger == 0 ? Lanes{} : angle;
}

}  // namespace

DirectionCode encode_direction(const Vec3& direction) {
    const float x = direction.x();
    const float y = direction.y();
    const Lanes angles =
        angles_in_cells(Lanes{std::sqrt(x * x + y * y), y}, Lanes{direction.z(), x});
    const float theta = 2 * angles[0];
    const float phi = angles[1];
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

}  // namespace caustics::photonmap
