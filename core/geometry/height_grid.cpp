#include "core/geometry/height_grid.h"

#include <algorithm>

#include "core/mesh/mesh_rows.h"

namespace caustics {
namespace {

// Central differences, of one side at the edges.
Vec2d difference(const HeightGrid& grid, int i, int j) {
    const auto slope = [&](int i0, int j0, int i1, int j1, double length) {
        const auto low = static_cast<double>(grid.heights[grid.index(i0, j0)]);
        const auto high = static_cast<double>(grid.heights[grid.index(i1, j1)]);
        return (high - low) / length;
    };
    const int left = std::max(i - 1, 0);
    const int right = std::min(i + 1, grid.columns);
    const int front = std::max(j - 1, 0);
    const int back = std::min(j + 1, grid.rows);
    const Vec2d cell = 2 * grid.half_size.cwiseQuotient(Vec2d(grid.columns, grid.rows));
    return {slope(left, j, right, j, (right - left) * cell.x()),
            slope(i, front, i, back, (back - front) * cell.y())};
}

}  // namespace

TriangleMesh tessellate_grid(const HeightGrid& grid) {
    TriangleMesh mesh;
    expect_grid(mesh, grid.columns, grid.rows);
    for (int j = 0; j <= grid.rows; ++j)
        for (int i = 0; i <= grid.columns; ++i) {
            const std::size_t at = grid.index(i, j);
            const Vec2d slope = grid.slopes.empty() ? difference(grid, i, j)
                                                    : Vec2d(grid.slopes[at].cast<double>());
            add_vertex(mesh,
                       {symmetric(i, grid.columns) * grid.half_size.x(),
                        symmetric(j, grid.rows) * grid.half_size.y(),
                        static_cast<double>(grid.heights[at])},
                       Vec3d(-slope.x(), -slope.y(), 1).normalized(),
                       {fraction(i, grid.columns), fraction(j, grid.rows)});
        }
    add_grid_triangles(mesh, 0, grid.columns, grid.rows);
    return mesh;
}

}  // namespace caustics
