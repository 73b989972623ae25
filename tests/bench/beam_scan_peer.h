#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace caustics::bench {

/// A triangle of rays on two planes: where the three meet the upper one, and how far they move down
/// to the lower one.
struct SlicedPeer {
    float corner[3][2];
    float growth[3][2];
};

/// Whether the point may lie within the triangle at the share t of the way down, but for `slack`
/// (twice an area).
bool may_hold(const SlicedPeer& triangle, float x, float y, float t, float slack);

/// The rays of a triangle's corners.
struct RaysPeer {
    float position[3][3];
    float direction[3][3];
};

/// Every triangle tested, eight at a time, without a tree, compiled for this machine: on the plane
/// through the point, as the beam-point test does it, but in float.
class BeamScan {
public:
    explicit BeamScan(const std::vector<RaysPeer>& triangles);

    /// Numbers of the triangles that may hold the point, on the plane across `normal`, of whose
    /// axes the third is the longest; `found` has room for all.
    std::size_t find(const float point[3], const float normal[3], float slack,
                     std::uint32_t* found) const;

private:
    struct alignas(32) Block {
        float position[3][3][8];
        float direction[3][3][8];
    };
    std::vector<Block> blocks_;
};

/// The same for triangles that are on two planes already: interpolated in place of projected.
class SliceScan {
public:
    explicit SliceScan(const std::vector<SlicedPeer>& triangles);

    std::size_t find(float x, float y, float t, float slack, std::uint32_t* found) const;

private:
    struct alignas(32) Block {
        float corner[3][2][8];
        float growth[3][2][8];
    };
    std::vector<Block> blocks_;
};

}  // namespace caustics::bench
