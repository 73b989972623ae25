#pragma once

#include <vector>

#include "core/mesh/mesh.h"

namespace caustics {

/// Heights over the rectangle |x| <= half_size.x, |y| <= half_size.y, at the corners of columns x
/// rows equal cells.
struct HeightGrid {
    static constexpr int most_cells = 4096;  ///< along x and y

    int columns = 1;
    int rows = 1;
    Vec2d half_size = Vec2d::Ones();
    std::vector<float> heights = {};  ///< (columns + 1) (rows + 1) of them [m], row by row from -y
    std::vector<Vec2> slopes = {};    ///< gradients there; empty: by differences of the heights

    std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns + 1) +
               static_cast<std::size_t>(column);
    }
};

/// Two triangles a cell, facing up, one GridPatch; normals by the slopes, uv over the rectangle.
TriangleMesh tessellate_grid(const HeightGrid& grid);

}  // namespace caustics
