#include "core/math/polygon.h"

#include <numeric>
#include <string>

#include "core/base/error.h"

namespace caustics {

namespace {

/// Twice the signed area of a triangle, positive when it turns left.
double turn(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// The corners in the plane that sees the polygon's sum of areas [Newell] largest, turning left.
std::vector<Vec2d> project(const std::vector<Vec3d>& corners) {
    Vec3d normal = Vec3d::Zero();
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3d a = corners[i] - corners[0];
        const Vec3d b = corners[(i + 1) % corners.size()] - corners[0];
        normal += a.cross(b);
    }
    Vec3d::Index dropped = 0;
    normal.cwiseAbs().maxCoeff(&dropped);
    const Vec3d::Index u = (dropped + 1) % 3, v = (dropped + 2) % 3;
    const double side = normal[dropped] < 0 ? -1 : 1;
    std::vector<Vec2d> flat;
    for (const Vec3d& corner : corners) flat.emplace_back(side * corner[u], corner[v]);
    return flat;
}

class EarClipping {
public:
    explicit EarClipping(const std::vector<Vec3d>& corners)
        : flat_(project(corners)), left_(corners.size()) {
        std::iota(left_.begin(), left_.end(), 0U);
    }

    std::vector<std::array<std::uint32_t, 3>> run() {
        // From the second corner on, so that a convex polygon is a fan about the first.
        std::size_t at = 1;
        for (std::size_t refused = 0; left_.size() > 3;) {
            if (tests_ > most_tests_per_corner * flat_.size())
                throw InputError("a polygon of " + std::to_string(flat_.size()) +
                                 " corners is too large or too winding: cut it into smaller ones");
            if (at >= left_.size()) at = 0;
            // When no corner is an ear, one that turns nowhere may go, and then any.
            const bool desperate = refused >= 2 * left_.size();
            if (is_ear(at, refused >= left_.size()) || desperate) {
                cut(at);
                refused = 0;
            } else {
                ++refused;
                ++at;
            }
        }
        if (left_.size() == 3) triangles_.push_back({left_[0], left_[1], left_[2]});
        return std::move(triangles_);
    }

private:
    std::uint32_t before(std::size_t at) const {
        return left_[at == 0 ? left_.size() - 1 : at - 1];
    }
    std::uint32_t after(std::size_t at) const { return left_[at + 1 < left_.size() ? at + 1 : 0]; }

    /// Whether the corner turns left (or, if `flat` will do, nowhere) and the triangle with its
    /// neighbours holds no other corner.
    bool is_ear(std::size_t at, bool flat) {
        ++tests_;
        const Vec2d &a = flat_[before(at)], &b = flat_[left_[at]], &c = flat_[after(at)];
        const double area = turn(a, b, c);
        if (area < 0 || (area == 0 && !flat)) return false;
        for (const std::uint32_t other : left_) {
            const Vec2d& p = flat_[other];
            ++tests_;
            if (p == a || p == b || p == c) continue;
            if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
        }
        return true;
    }

    void cut(std::size_t at) {
        triangles_.push_back({before(at), left_[at], after(at)});
        left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(at));
    }

    // Enough for 8,000 convex corners; what crosses itself may take the third power of its corners. With it, 1 MB of
    // corners takes 5 s at most (AMD EPYC).
    static constexpr std::size_t most_tests_per_corner = 4096;

    std::size_t tests_ = 0;
    std::vector<Vec2d> flat_;
    std::vector<std::uint32_t> left_;  ///< corners not cut off
    std::vector<std::array<std::uint32_t, 3>> triangles_;
};

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangulate_polygon(const std::vector<Vec3d>& corners) {
    if (corners.size() == 3) return {{0, 1, 2}};
    return EarClipping(corners).run();
}

}  // namespace caustics
