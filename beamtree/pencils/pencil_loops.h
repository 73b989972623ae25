#pragma once

#include "beamtree/pencils/pencil_leaf.h"

namespace caustics::beamtree {

/// The loops over a pencil map's leaves and boxes, compiled once for each instruction set: over arrays and without branches, so
/// that the compiler puts a leaf into a register. `static`, because every source that includes them has its own.

static inline float least(float a, float b) { return a < b ? a : b; }
static inline float most(float a, float b) { return a > b ? a : b; }
static inline float magnitude(float a) { return a < 0 ? -a : a; }
/// Dot product of a row's vector and (x, y, z).
static inline float dot(const float (&rows)[3][pencil_width], size_t i, float x, float y, float z) {
    return rows[0][i] * x + rows[1][i] * y + rows[2][i] * z;
}
static inline double within_half(double a) {
    const double low = a < -0.5 ? -0.5 : a;
    return low > 0.5 ? 0.5 : low;
}

static uint32_t touched_boxes(const PencilBoxes& boxes, const PencilQuery& query) {
    float squared[pencil_width] = {};
    for (size_t axis = 0; axis < 3; ++axis)
        for (size_t i = 0; i < pencil_width; ++i) {
            const float x = query.position[axis];
            const float beyond = most(boxes.low[axis][i] - x, x - boxes.high[axis][i]);
            const float outside = most(beyond, 0.0F);
            squared[i] += outside * outside;
        }
    uint32_t bits = 0;
    for (size_t i = 0; i < pencil_width; ++i)
        bits |= (squared[i] <= query.radius * query.radius ? 1U : 0U) << i;
    return bits;
}

/// Offsets of the query point from the eight prints.
struct Offsets {
    alignas(64) float x[pencil_width];
    alignas(64) float y[pencil_width];
    alignas(64) float z[pencil_width];
};

static void find_offsets(const PencilLeaf& leaf, const PencilQuery& query, Offsets& from) {
    for (size_t i = 0; i < pencil_width; ++i) {
        from.x[i] = query.position[0] - leaf.position[0][i];
        from.y[i] = query.position[1] - leaf.position[1][i];
        from.z[i] = query.position[2] - leaf.position[2][i];
    }
}

/// Coordinates of a point along the two sides of each print.
struct AlongSides {
    alignas(64) float u[pencil_width];
    alignas(64) float v[pencil_width];
};

// Finds the point's coordinates along the sides. `room` is below 0 for prints that hold no part of the cell. Returns false if all
// are.
static bool beside_no_side(const PencilLeaf& leaf, const PencilQuery& query, const Offsets& from,
                           AlongSides& at, float room[pencil_width]) {
    uint32_t any = 0;
    for (size_t i = 0; i < pencil_width; ++i) {
        const float u = dot(leaf.by_side[0], i, from.x[i], from.y[i], from.z[i]);
        const float v = dot(leaf.by_side[1], i, from.x[i], from.y[i], from.z[i]);
        const float room_u = 0.5F + query.radius * leaf.by_metre[0][i] - magnitude(u);
        const float room_v = 0.5F + query.radius * leaf.by_metre[1][i] - magnitude(v);
        at.u[i] = u;
        at.v[i] = v;
        room[i] = least(least(room_u, room_v), leaf.height[i]);
        any |= room[i] >= 0 ? 1U : 0U;
    }
    return any != 0;
}

// Finds the cosines of rays that reach the point, and 0 for all others. Returns false if none do.
static bool arriving(const PencilLeaf& leaf, const PencilQuery& query, const Offsets& from,
                     const float room[pencil_width], float cosine[pencil_width]) {
    uint32_t any = 0;
    for (size_t i = 0; i < pencil_width; ++i) {
        const float off_plane = magnitude(dot(leaf.normal, i, from.x[i], from.y[i], from.z[i]));
        const float towards = dot(leaf.wi, i, query.normal[0], query.normal[1], query.normal[2]);
        const float inside = least(room[i], leaf.height[i] - off_plane);
        cosine[i] = inside >= 0 ? most(towards, 0.0F) : 0.0F;
        any |= cosine[i] > 0 ? 1U : 0U;
    }
    return any != 0;
}

// An edge's term of the area of a polygon within the unit square about the origin: the integral of v du along the edge, with u and v
// clamped to the square.
static inline double area_under(double u0, double v0, double u1, double v1) {
    const double du = u1 - u0;
    const double slope = (v1 - v0) / (du == 0 ? 1 : du);
    const double from = within_half(u0);
    const double to = within_half(u1);
    const double a = v0 + (from - u0) * slope;
    const double b = v1 + (to - u1) * slope;
    const double low = within_half(a);
    const double high = within_half(b);
    // The edge stays outside at a's end, crosses the square, and stays outside at b's.
    const double sum = (low - a) * low + (b - high) * high + (high - low) * (0.5 * (low + high));
    const double rise = b - a;
    const double mean = rise == 0 ? low : sum / (rise == 0 ? 1 : rise);
    return (to - from) * mean;
}

/// Where the corners of a cell lie along a print's sides, for each print, and the box round them.
struct CellAlongSides {
    AlongSides corner[4];
    AlongSides low;
    AlongSides high;
};

static void place_cell(const PencilLeaf& leaf, const PencilQuery& query, const AlongSides& at,
                       CellAlongSides& cell) {
    cell.low = at;
    cell.high = at;
    for (size_t c = 0; c < 4; ++c) {
        const float* const way = query.corner[c];
        AlongSides& corner = cell.corner[c];
        for (size_t i = 0; i < pencil_width; ++i) {
            const float u = at.u[i] + dot(leaf.by_side[0], i, way[0], way[1], way[2]);
            const float v = at.v[i] + dot(leaf.by_side[1], i, way[0], way[1], way[2]);
            corner.u[i] = u;
            corner.v[i] = v;
            cell.low.u[i] = least(cell.low.u[i], u);
            cell.low.v[i] = least(cell.low.v[i], v);
            cell.high.u[i] = most(cell.high.u[i], u);
            cell.high.v[i] = most(cell.high.v[i], v);
        }
    }
}

static bool leaf_densities(const PencilLeaf& leaf, const PencilQuery& query,
                           double density[pencil_width]) {
    Offsets from_prints;
    find_offsets(leaf, query, from_prints);
    AlongSides at;
    alignas(64) float cosine[pencil_width];
    alignas(64) float room[pencil_width];
    if (!beside_no_side(leaf, query, from_prints, at, room) ||
        !arriving(leaf, query, from_prints, room, cosine))
        return false;
    CellAlongSides cell;
    place_cell(leaf, query, at, cell);
    alignas(64) float lit[pencil_width];     // the cosine where the cell is not beside the print
    alignas(64) float partly[pencil_width];  // the same where it is not within the print
    uint32_t any_partly = 0;
    for (size_t i = 0; i < pencil_width; ++i) {
        const float outside =
            most(most(cell.low.u[i], -cell.high.u[i]), most(cell.low.v[i], -cell.high.v[i]));
        const float farthest =
            most(most(cell.high.u[i], -cell.low.u[i]), most(cell.high.v[i], -cell.low.v[i]));
        lit[i] = outside > 0.5F ? 0.0F : cosine[i];
        partly[i] = farthest > 0.5F ? lit[i] : 0.0F;
        any_partly |= partly[i] > 0 ? 1U : 0U;
    }
#pragma GCC ivdep
    for (size_t i = 0; i < pencil_width; ++i)
        density[i] = static_cast<double>(lit[i]) / static_cast<double>(leaf.area[i]);
    if (any_partly == 0) return true;
    alignas(64) double part[pencil_width] = {};
    for (size_t c = 0; c < 4; ++c) {
        const AlongSides& from = cell.corner[c];
        const AlongSides& to = cell.corner[(c + 1) % 4];
        for (size_t i = 0; i < pencil_width; ++i)
            part[i] += area_under(static_cast<double>(from.u[i]), static_cast<double>(from.v[i]),
                                  static_cast<double>(to.u[i]), static_cast<double>(to.v[i]));
    }
#pragma GCC ivdep
    for (size_t i = 0; i < pencil_width; ++i) {
        const double covered = (part[i] < 0 ? -part[i] : part[i]) * query.over_area;
        density[i] = partly[i] > 0 ? covered : density[i];
    }
    return true;
}

static constexpr PencilKernels pencil_loops{&touched_boxes, &leaf_densities};

}  // namespace caustics::beamtree
