#include "beamtree/light/test_plane.h"

#include <cmath>

namespace caustics::beamtree {

TestPlane::TestPlane(const Vec3& point, const Vec3& normal)
    : point_(point.cast<double>()), normal_(normal.cast<double>()) {
    int longest = 0;
    normal_.cwiseAbs().maxCoeff(&longest);
    u_ = (longest + 1) % 3;
    v_ = (longest + 2) % 3;
    area_scale_ = normal_.norm() / std::abs(normal_[longest]);
}

}  // namespace caustics::beamtree
