#pragma once

#include <stddef.h>
#include <stdint.h>

namespace caustics::beamtree {

/// The memory of a pencil map (pencil_map.h), eight things side by side: plain data, so that a source compiled for wide
/// registers includes no inline code of Eigen or the standard library.
constexpr size_t pencil_width = 8;

/// The boxes of eight nodes three levels below one of a heap (leaf_heap.h).
struct alignas(64) PencilBoxes {
    float low[3][pencil_width];
    float high[3][pencil_width];
};

/// A leaf's prints. Places that are left over have a height below 0.
struct alignas(64) PencilLeaf {
    float position[3][pencil_width];
    /// Times what leads from the position: a point's numbers along the sides of a print, -1/2 to 1/2 on it [1/m].
    float by_side[2][3][pencil_width];
    float by_metre[2][pencil_width];  ///< their lengths [1/m]
    float height[pencil_width];       ///< how far off its plane its rays count, to both sides [m]
    float normal[3][pencil_width];    ///< geometric, unit
    float wi[3][pencil_width];        ///< unit, where the rays come from
    float area[pencil_width];         ///< across the rays [m^2]
    float flux[3][pencil_width];      ///< [W]
    uint32_t light[pencil_width];     ///< index of the light sample
};

/// Where prints are asked about: at a point, or over its cell.
struct PencilQuery {
    float position[3];
    float normal[3];     ///< geometric, unit
    float radius;        ///< within which the cell lies [m]; 0 for a point
    float corner[4][3];  ///< of the cell, from the position; 0 for a point
    double over_area;    ///< 1 / the cell's area [1/m^2]; 0 for a point
};

struct PencilKernels {
    /// The boxes that the query's ball touches, one bit each.
    uint32_t (*touched)(const PencilBoxes&, const PencilQuery&);
    /// The light of each print that falls on the point's surface or cell, over the print's light and the cell's area [1/m^2]. 0 where there
    /// is none; false where there is none at all, and then the densities are not written.
    bool (*densities)(const PencilLeaf&, const PencilQuery&, double density[pencil_width]);
};

const PencilKernels& plain_pencil_kernels();
const PencilKernels& avx2_pencil_kernels();
const PencilKernels& avx512_pencil_kernels();

}  // namespace caustics::beamtree
