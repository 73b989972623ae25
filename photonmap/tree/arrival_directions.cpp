#include "photonmap/tree/arrival_directions.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <optional>
#include <sstream>
#include <vector>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace caustics::photonmap {

namespace {

constexpr std::size_t codes = 65'536;
/// More than what the arithmetic of a cosine takes off.
constexpr float rounding = 1e-5F;

[[noreturn]] void fail_of_photon(std::size_t index, const Photon& photon) {
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

Vec3d direction_of_code(std::size_t code) {
    return decode_direction(static_cast<std::uint8_t>(code / 256),
                            static_cast<std::uint8_t>(code % 256))
        .cast<double>()
        .normalized();
}

Vec3d facing_direction(std::size_t flags) {
    const Facing at = facing_of(static_cast<unsigned>(flags));
    return Vec3d(at.x, at.y, at.z).normalized();
}

/// A cone round directions; the cosine is -1 where they point all ways.
struct Cone {
    Vec3 axis = Vec3::UnitZ();
    double cosine = -1;  ///< of half its opening angle
};

template <typename Codes, typename DirectionOf>
Cone cone_of(const Codes& seen, const DirectionOf& direction_of) {
    Vec3d sum = Vec3d::Zero();
    for (std::size_t code = 0; code < seen.size(); ++code)
        if (seen[code]) sum += direction_of(code);
    Cone cone;
    if (sum.norm() == 0) return cone;
    cone.axis = sum.normalized().template cast<float>();
    const Vec3d axis = cone.axis.template cast<double>().normalized();
    cone.cosine = 1;
    for (std::size_t code = 0; code < seen.size(); ++code)
        if (seen[code]) cone.cosine = std::min(cone.cosine, axis.dot(direction_of(code)));
    return cone;
}

/// What some of the photons show.
struct Seen {
    std::bitset<codes> directions;
    std::bitset<(facing_mask >> facing_shift) + 1> facings;
    std::optional<std::size_t> not_finite;  ///< the first
};

Seen seen_in(std::span<const Photon> photons, const Chunk& chunk) {
    Seen seen;
    for (std::size_t i = chunk.first; i < chunk.end && !seen.not_finite; ++i) {
        if (!is_finite(photons[i])) seen.not_finite = i;
        seen.directions.set(photons[i].theta * 256U + photons[i].phi);
        seen.facings.set((photons[i].flags & facing_mask) >> facing_shift);
    }
    return seen;
}

}  // namespace

ArrivalDirections::ArrivalDirections(std::span<const Photon> photons, int threads)
    : empty_(photons.empty()) {
    constexpr std::size_t together = 262'144;
    std::vector<Seen> parts(chunk_count(photons.size(), together));
    parallel_chunks(threads, photons.size(), together,
                    [&](const Chunk& chunk) { parts[chunk.index] = seen_in(photons, chunk); });
    Seen all;
    for (const Seen& part : parts) {
        if (part.not_finite) fail_of_photon(*part.not_finite, photons[*part.not_finite]);
        all.directions |= part.directions;
        all.facings |= part.facings;
    }
    const Cone from = cone_of(all.directions, direction_of_code);
    axis_ = from.axis;
    if (from.cosine > 0) sine_ = static_cast<float>(std::sqrt(1 - from.cosine * from.cosine));
    all.facings.reset(0);  // what is not known counts everywhere
    if (all.facings.none()) return;
    const Cone on = cone_of(
        all.facings, [](std::size_t code) { return facing_direction(code << facing_shift); });
    facing_ = on.axis;
    const double room = std::acos(static_cast<double>(same_surface_cosine)) -
                        std::acos(std::clamp(on.cosine, -1.0, 1.0));
    facing_cosine_ = room > 0 ? static_cast<float>(std::cos(room)) + rounding : 2;
}

bool ArrivalDirections::all_count(const Vec3& normal) const {
    return empty_ || (normal.dot(axis_) > sine_ + rounding && normal.dot(facing_) > facing_cosine_);
}

SideTest side_test(const Vec3& normal) {
    return {&direction_tables(), {normal.x(), normal.y(), normal.z()}};
}

namespace {

/// Whether photons of all these direction codes came from the side of the test's normal.
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

/// Whether photons of all these flags landed on a surface that may be the test's. Those of a flat one
/// are alike.
bool all_on_same_surface(const SideTest& side, std::span<const std::uint16_t> flags) {
    unsigned last = 0;
    return std::ranges::all_of(flags, [&](std::uint16_t own) {
        const unsigned facing = own & facing_mask;
        if (facing == last) return true;
        last = facing;
        return is_same_surface(facing, side.normal);
    });
}

}  // namespace

bool all_count(const SideTest& side, const CopiedPhotons& photons, std::size_t count) {
    return all_in_front(side, {photons.direction, count}) &&
           all_on_same_surface(side, {photons.flags, count});
}

}  // namespace caustics::photonmap
