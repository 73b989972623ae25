#include "core/mesh/mesh_rows.h"

#include <cmath>

#include "core/base/interrupt.h"

namespace caustics {

Vec2d on_circle(int step, int steps) {
    const int quarter = steps / 4;
    const int turned = step % steps;
    if (steps % 4 == 0 && turned % quarter == 0) {
        const Vec2d axes[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
        return axes[turned / quarter];
    }
    const double angle = 2 * pi_d * turned / steps;
    return {std::cos(angle), std::sin(angle)};
}

void expect_grid(TriangleMesh& mesh, int columns, int rows) {
    const auto width = static_cast<std::size_t>(columns);
    const auto height = static_cast<std::size_t>(rows);
    mesh.positions.reserve((width + 1) * (height + 1));
    mesh.normals.reserve((width + 1) * (height + 1));
    mesh.uvs.reserve((width + 1) * (height + 1));
    mesh.triangles.reserve(2 * width * height);
}

std::uint32_t add_vertex(TriangleMesh& mesh, const Vec3d& position, const Vec3d& normal,
                         const Vec2d& uv) {
    constexpr std::size_t vertices_between_looks = 1 << 12;
    if (mesh.positions.size() % vertices_between_looks == 0) throw_if_interrupted();
    mesh.positions.emplace_back(position.cast<float>());
    mesh.normals.emplace_back(normal.cast<float>());
    mesh.uvs.emplace_back(uv.cast<float>());
    return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

void add_patch(TriangleMesh& mesh, int columns, int rows, std::uint32_t cell_triangles) {
    if (columns == 0 || rows == 0) return;
    mesh.patches.push_back({static_cast<std::uint32_t>(mesh.triangles.size()),
                            static_cast<std::uint32_t>(columns), static_cast<std::uint32_t>(rows),
                            cell_triangles});
}

void add_row_triangles(TriangleMesh& mesh, std::uint32_t lower, std::uint32_t upper, int columns) {
    throw_if_interrupted();
    for (std::uint32_t column = 0; column < static_cast<std::uint32_t>(columns); ++column) {
        const std::uint32_t a = lower + column;
        const std::uint32_t d = upper + column;
        mesh.triangles.push_back({a, a + 1, d + 1});
        mesh.triangles.push_back({a, d + 1, d});
    }
}

void add_grid_triangles(TriangleMesh& mesh, std::uint32_t first, int columns, int rows) {
    const auto stride = static_cast<std::uint32_t>(columns) + 1;
    add_patch(mesh, columns, rows, 2);
    for (int row = 0; row < rows; ++row, first += stride)
        add_row_triangles(mesh, first, first + stride, columns);
}

}  // namespace caustics
