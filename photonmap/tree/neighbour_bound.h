#pragma once

#include <algorithm>
#include <cmath>

#include "core/math/vec.h"
#include "photonmap/kernels/tree_kernels.h"

namespace caustics::photonmap {

/// What one query's answer gives the next: the distance of the N-th nearest photon changes by no more than
/// the point moves, so that it bounds the next search exactly.
class NeighbourBound {
public:
    /// Squared distance within which the N nearest of `point` lie [m^2], at most `max`.
    /// `tested` says whether photons that do not count at `normal` are left out; then only an answer
    /// for the same normal is of use, because all of its photons count.
    float at(const Vec3& point, const Vec3& normal, bool tested, float max) const {
        if (!known_ || (tested && normal != normal_)) return max;
        return std::min(max, reached(distance_ + (point - point_).norm()));
    }

    /// The largest squared distance of an answer that has all N photons.
    void set(const Vec3& point, const Vec3& normal, float squared_distance) {
        known_ = true;
        point_ = point;
        normal_ = normal;
        distance_ = std::sqrt(squared_distance);
    }
    void forget() { known_ = false; }
    bool known() const { return known_; }
    float distance() const { return distance_; }
    /// Whether a search met photons that do not count at its point, so that further ones will: they
    /// had better test each photon.
    bool met_foreign() const { return met_foreign_; }
    void meet_foreign() { met_foreign_ = true; }

private:
    bool known_ = false;
    bool met_foreign_ = false;
    Vec3 point_ = Vec3::Zero();
    Vec3 normal_ = Vec3::UnitZ();
    float distance_ = 0;
};

}  // namespace caustics::photonmap
