#include "core/reference/gather_grid.h"

#include <algorithm>
#include <cmath>

#include "core/scene/same_surface.h"

namespace caustics {

GatherGrid::GatherGrid(std::span<const ReceiverPoint> points, std::span<const float> radii)
    : points_(points), radii_(radii) {
    if (points.empty()) return;
    cell_size_ = 2 * *std::max_element(radii.begin(), radii.end());
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        // The thick disc lies in a ball of sqrt(2) radii.
        const Vec3 half = Vec3::Constant(1.4143F * radii[i]);
        const Cell low = cell_of(points[i].position - half);
        const Cell high = cell_of(points[i].position + half);
        for (int x = low.x(); x <= high.x(); ++x)
            for (int y = low.y(); y <= high.y(); ++y)
                for (int z = low.z(); z <= high.z(); ++z) cells_[key(Cell(x, y, z))].push_back(i);
    }
}

GatherGrid::Cell GatherGrid::cell_of(const Vec3& p) const {
    // Far cells share a key anyway (see key): clamped before the numbers leave int's range.
    return (p / cell_size_).array().floor().max(-1e9F).min(1e9F).cast<int>();
}

std::uint64_t GatherGrid::key(const Cell& cell) {
    // Cells 2^21 apart share a key; contains() keeps the answer right.
    const auto part = [](int i) { return static_cast<std::uint64_t>(i) & 0x1FFFFFU; };
    return part(cell.x()) | part(cell.y()) << 21U | part(cell.z()) << 42U;
}

bool GatherGrid::contains(std::uint32_t index, const Deposit& deposit) const {
    const ReceiverPoint& p = points_[index];
    const Vec3 offset = deposit.position - p.position;
    const float height = p.geometric_normal.dot(offset);
    const float radius = radii_[index];
    const float thickness =
        deposit.shape == p.shape ? radius : std::max(radius / 100, 4 * p.offset);
    return deposit.wi.dot(p.geometric_normal) > 0 &&
           deposit.geometric_normal.dot(p.geometric_normal) > same_surface_cosine &&
           std::abs(height) <= thickness &&
           (offset - height * p.geometric_normal).squaredNorm() <= radius * radius;
}

}  // namespace caustics
