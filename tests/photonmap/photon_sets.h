#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "core/rng.h"
#include "photonmap/kd_tree.h"
#include "photonmap/photon.h"

namespace caustics::test {

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

/// The nearest by looking at all photons, in order.
template <typename Accept>
std::vector<Neighbour> linear_scan(const std::vector<Photon>& photons, const Vec3& point,
                                   std::size_t count, float max_squared_distance,
                                   const Accept& accept) {
    std::vector<Neighbour> all;
    for (std::uint32_t i = 0; i < photons.size(); ++i) {
        const float distance2 = squared_distance(photons[i], point);
        if (distance2 <= max_squared_distance && accept(photons[i])) all.push_back({distance2, i});
    }
    std::ranges::sort(all, [](const Neighbour& a, const Neighbour& b) { return a < b; });
    if (all.size() > count) all.resize(count);
    return all;
}

}  // namespace caustics::test
