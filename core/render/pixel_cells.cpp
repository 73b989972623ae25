#include "core/render/pixel_cells.h"

#include <algorithm>
#include <cmath>

#include "core/scene/same_surface.h"

namespace caustics {

std::optional<PixelCell> pixel_cell(const Camera& camera, const Eigen::AlignedBox2d& film,
                                    const ReceiverPoint& point) {
    const Vec3d normal = point.geometric_normal.cast<double>();
    const Vec3d down = point.position.cast<double>() - camera.to_world.translation();
    const Vec2d& low = film.min();
    const Vec2d& high = film.max();
    const std::array<Vec2d, 4> at = {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
    PixelCell cell{.normal = normal, .axes = PlaneAxes(normal), .corners = {}};
    const Vec3d optical_axis = camera.to_world.linear().col(2);
    cell.depth_slope = cell.along(optical_axis) / optical_axis.dot(down);
    for (std::size_t i = 0; i < at.size(); ++i) {
        const Vec3d ray = camera.towards(at[i].x(), at[i].y());
        const double steepness = ray.dot(normal);
        if (!(steepness < 0)) return {};
        cell.corners[i] = cell.along(down.dot(normal) / steepness * ray - down);
        cell.radius = std::max(cell.radius, cell.corners[i].norm());
    }
    return cell;
}

bool lies_on_receiver(const Scene& scene, const ReceiverPoint& point, const PixelCell& cell) {
    const float above = std::max(static_cast<float>(cell.radius) / 10, 2 * point.offset);
    for (std::size_t i = 0; i < cell.corners.size(); ++i) {
        Ray down;
        down.origin =
            point.position + cell.corner(i).cast<float>() + above * point.geometric_normal;
        down.direction = -point.geometric_normal;
        down.max_distance = 2 * above;
        const auto met = scene.intersect(down);
        if (!met || std::abs(met->geometric_normal.dot(down.direction)) < same_surface_cosine)
            return false;
    }
    return true;
}

}  // namespace caustics
