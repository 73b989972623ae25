#include "core/geometry/box_view.h"

#include <array>
#include <cmath>

namespace caustics {
namespace {

using Side = std::array<Vec3d, 4>;

// What an edge adds to Lambert's integral over a polygon of which it is a part [Lambert 1760], twice.
double edge_term(const Vec3d& a, const Vec3d& b, const Vec3d& normal) {
    const Vec3d cross = a.cross(b);
    const double sine = cross.norm();
    return sine > 0 ? std::atan2(sine, a.dot(b)) / sine * normal.dot(cross) : 0;
}

// Over a side seen from the origin, without what lies below the horizon.
double cosine_over(const Side& side, const Vec3d& normal) {
    std::array<Vec3d, 8> above;
    std::size_t count = 0;
    for (std::size_t i = 0; i < side.size(); ++i) {
        const Vec3d& a = side[i];
        const Vec3d& b = side[(i + 1) % side.size()];
        const double height = normal.dot(a);
        const double next = normal.dot(b);
        if (height >= 0) above[count++] = a;
        if ((height > 0 && next < 0) || (height < 0 && next > 0))
            above[count++] = a + height / (height - next) * (b - a);
    }
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i)
        sum += edge_term(above[i], above[(i + 1) % count], normal);
    return std::abs(sum) / 2;
}

}  // namespace

// Over the sides whose fronts the point sees: they hide the others, and none of one another.
double cosine_over(const Box& box, const Vec3& position, const Vec3& normal) {
    const Vec3d low = (box.min() - position).cast<double>();
    const Vec3d high = (box.max() - position).cast<double>();
    double sum = 0;
    bool inside = true;
    for (int axis = 0; axis < 3; ++axis) {
        if (low[axis] <= 0 && high[axis] >= 0) continue;
        inside = false;
        const int u = (axis + 1) % 3;
        const int v = (axis + 2) % 3;
        Side side;
        side.fill(low[axis] > 0 ? low : high);
        for (std::size_t i = 0; i < 4; ++i) {
            side[i][u] = i == 1 || i == 2 ? high[u] : low[u];
            side[i][v] = i >= 2 ? high[v] : low[v];
        }
        sum += cosine_over(side, normal.cast<double>());
    }
    return inside ? pi_d : sum;
}

}  // namespace caustics
