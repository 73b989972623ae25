#pragma once

#include <algorithm>
#include <cmath>
#include <compare>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "core/math/rng.h"
#include "photonmap/tree/arrival_directions.h"
#include "photonmap/tree/photon_tree.h"

namespace caustics::photonmap::test {

/// A photon of energy 1 that came from straight above.
inline Photon photon_at(const Vec3& x) {
    const DirectionCode up = encode_direction(Vec3::UnitZ());
    return {{x.x(), x.y(), x.z()}, encode_rgbe(Spectrum::Ones()), up.theta, up.phi, 0};
}

struct PhotonSet {
    std::string name;
    std::vector<Photon> photons;
};

/// Sets of `count` photons that are easy and hard for a tree.
inline std::vector<PhotonSet> photon_sets(std::size_t count, std::uint64_t seed) {
    Rng rng(seed, Stage::test, count);
    const auto uniform = [&rng] { return 2 * rng.next() - 1; };
    const auto cube = [&] {
        const float x = uniform(), y = uniform(), z = uniform();
        return Vec3(x, y, z);
    };
    const auto lattice = [&] { return Vec3((4 * cube()).array().round()); };
    std::vector<PhotonSet> sets{{"uniform", {}},     {"clustered", {}},      {"one point", {}},
                                {"line", {}},        {"lattice", {}},        {"tiny", {}},
                                {"huge", {}},        {"negative", {}},       {"plane", {}},
                                {"tilted line", {}}, {"half coincident", {}}};
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 positions[] = {cube(),
                                  Vec3(cube().array().cube().cube()),
                                  Vec3(0.1F, -0.2F, 0.3F),
                                  Vec3(uniform(), 0, 0),
                                  lattice(),
                                  1e-6F * cube(),
                                  1e6F * cube(),
                                  cube() - Vec3(5, 6, 7),
                                  Vec3(uniform(), uniform(), 0),
                                  Vec3(uniform() * Vec3(1, 2, -1)),
                                  i % 2 == 0 ? Vec3(0.25F, 0.25F, 0.25F) : cube()};
        for (std::size_t s = 0; s < sets.size(); ++s) {
            Photon photon = photon_at(positions[s]);
            photon.theta = static_cast<std::uint8_t>(rng.next_word());
            photon.phi = static_cast<std::uint8_t>(rng.next_word());
            sets[s].photons.push_back(photon);
        }
    }
    return sets;
}

inline PhotonStore store_of(std::span<const Photon> photons) {
    PhotonStore store(photons.size());
    store.append(photons);
    return store;
}

/// Each operation rounded to float.
inline float squared_distance(const Photon& photon, const Vec3& point) {
    const float x = photon.position[0] - point.x();
    const float y = photon.position[1] - point.y();
    const float z = photon.position[2] - point.z();
    return x * x + y * y + z * z;
}

/// A gathered photon; energy and direction are compared as PhotonTree orders them.
struct Found {
    float squared_distance;
    std::uint32_t energy;
    std::uint16_t direction;

    auto operator<=>(const Found&) const = default;
};

inline Found found(const Photon& photon, const Vec3& point) {
    Found f{squared_distance(photon, point), 0, 0};
    std::memcpy(&f.energy, &photon.energy, sizeof f.energy);
    std::memcpy(&f.direction, &photon.theta, sizeof f.direction);
    return f;
}

/// Whether the photon's surface is not known, or faces within 60 degrees of the normal.
inline bool may_be_on(const Photon& photon, const Vec3& normal) {
    if ((photon.flags & facing_mask) == 0) return true;
    const Facing at = facing_of(photon.flags);
    return Vec3d(at.x, at.y, at.z).normalized().dot(normal.cast<double>()) > 0.5;
}

/// How many of these photons, nearest first, belong to the answer.
inline std::size_t count_within(const std::vector<Found>& all, const GatherLimits& limits) {
    const auto not_beyond = [&all](float squared_distance) {
        return static_cast<std::size_t>(
            std::ranges::upper_bound(all, squared_distance, {}, &Found::squared_distance) -
            all.begin());
    };
    const bool unlimited = limits.nearest == GatherLimits::all;
    const float radius = limits.max_radius + (unlimited ? limits.margin : 0);
    const std::size_t within = not_beyond(radius * radius);
    if (unlimited || limits.margin == 0) return std::min(within, limits.nearest);
    const float nth = within < limits.nearest ? limits.max_radius
                                              : std::sqrt(all[limits.nearest - 1].squared_distance);
    return not_beyond(reached(nth + limits.margin));
}

/// The answer at a point by looking at all photons, nearest first.
inline std::vector<Found> linear_scan(std::span<const Photon> photons, const ReceiverPoint& point,
                                      const GatherLimits& limits) {
    const float farthest = reached(limits.max_radius + limits.margin);
    std::vector<Found> all;
    for (const Photon& photon : photons) {
        const Found f = found(photon, point.position);
        if (f.squared_distance <= farthest && incoming(photon).dot(point.geometric_normal) > 0 &&
            may_be_on(photon, point.geometric_normal))
            all.push_back(f);
    }
    std::ranges::sort(all);
    all.resize(count_within(all, limits));
    return all;
}

}  // namespace caustics::photonmap::test
