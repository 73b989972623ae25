#include "photonmap/arrival_directions.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <sstream>

#include "core/error.h"

namespace caustics {

namespace {

constexpr std::size_t codes = 65'536;
/// More than what the arithmetic of a cosine takes off.
constexpr float rounding = 1e-5F;

[[noreturn]] void fail_not_finite(std::size_t index, const Photon& photon) {
    std::ostringstream message;
    message << "photonmap: photon " << index << " is at (" << photon.position[0] << ", "
            << photon.position[1] << ", " << photon.position[2]
            << "): positions must be finite numbers";
    throw InputError(message.str());
}

bool is_finite(const Photon& photon) {
    // A difference that is no number stays so in the sum.
    const float x = photon.position[0], y = photon.position[1], z = photon.position[2];
    return (x - x) + (y - y) + (z - z) == 0;
}

Vec3 direction_of_code(std::size_t code) {
    return decode_direction(static_cast<std::uint8_t>(code / 256),
                            static_cast<std::uint8_t>(code % 256));
}

}  // namespace

ArrivalDirections::ArrivalDirections(std::span<const Photon> photons) {
    std::bitset<codes> seen;
    for (std::size_t i = 0; i < photons.size(); ++i) {
        if (!is_finite(photons[i])) fail_not_finite(i, photons[i]);
        seen.set(photons[i].theta * 256U + photons[i].phi);
    }
    Vec3d sum = Vec3d::Zero();
    for (std::size_t code = 0; code < codes; ++code)
        if (seen[code]) sum += direction_of_code(code).cast<double>();
    empty_ = photons.empty();
    if (empty_ || sum.norm() == 0) return;
    axis_ = sum.normalized().cast<float>();
    const Vec3d axis = axis_.cast<double>().normalized();
    double cosine = 1;
    for (std::size_t code = 0; code < codes; ++code)
        if (seen[code])
            cosine =
                std::min(cosine, axis.dot(direction_of_code(code).cast<double>().normalized()));
    if (cosine > 0) sine_ = static_cast<float>(std::sqrt(std::max(0.0, 1 - cosine * cosine)));
}

bool ArrivalDirections::all_in_front(const Vec3& normal) const {
    return empty_ || normal.dot(axis_) > sine_ + rounding;
}

SideTest side_test(const Vec3& normal) {
    return {&direction_tables(), {normal.x(), normal.y(), normal.z()}};
}

bool all_in_front(const SideTest& side, std::span<const std::uint16_t> directions) {
    std::uint16_t largest = 0;
    for (const std::uint16_t code : directions)
        largest = std::max<std::uint16_t>(largest, code & 0xFFU);
    // Above the horizon, the least cosine among a theta's directions falls as theta grows.
    const SineCosine theta = side.tables->theta[largest];
    const float across =
        std::sqrt(side.normal[0] * side.normal[0] + side.normal[1] * side.normal[1]);
    if (theta.cosine > 0 && theta.cosine * side.normal[2] > theta.sine * across + rounding)
        return true;
    return std::ranges::all_of(directions, [&side](std::uint16_t code) {
        return on_front_side(side, code & 0xFFU, code >> 8U);
    });
}

bool came_from_front(const Photon& photon, const Vec3& normal) {
    return on_front_side(side_test(normal), photon.theta, photon.phi);
}

}  // namespace caustics
