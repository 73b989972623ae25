#pragma once

#include "beamtree/cones/cone.h"

namespace caustics::beamtree {

/// Nine rays from a square of 3 x 3 places that go down, and the eight triangles of its four cells.
struct RayBundle {
    Vec3d centre = Vec3d::Zero();
    double half = 1;    ///< of the square's side [m]
    double apart = 0;   ///< slope of the rays in the middles of its sides: away from the centre
    double around = 0;  ///< and round it, so that rays that come together miss each other
    double lifted = 0;  ///< height of its corners above its centre [m]
    double turned = 0;  ///< all of it, about the y axis through the centre [rad]

    NodeRays rays() const {
        NodeRays made;
        const Eigen::AngleAxisd turn(turned, Vec3d::UnitY());
        for (int i = -1; i <= 1; ++i)
            for (int j = -1; j <= 1; ++j) {
                const Vec3d at(half * i, half * j, i * j == 0 ? 0 : lifted);
                const Vec3d way(apart * i - around * j, apart * j + around * i, -1);
                made.positions.emplace_back(centre + turn * at);
                made.directions.emplace_back(turn * way.normalized());
            }
        for (std::uint32_t i = 0; i < 2; ++i)
            for (std::uint32_t j = 0; j < 2; ++j) {
                const std::uint32_t a = 3 * i + j;
                made.triangles.push_back({a, a + 3, a + 4});
                made.triangles.push_back({a, a + 4, a + 1});
            }
        return made;
    }
};

}  // namespace caustics::beamtree
