#include "tests/bench/beam_scan_peer.h"

#include <immintrin.h>

#include <algorithm>
#include <limits>

namespace caustics::bench {

namespace {

using Eight = float __attribute__((vector_size(32)));

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

Eight load(const float* from) { return _mm256_load_ps(from); }

float least(float a, float b, float c) { return a < b ? (a < c ? a : c) : (b < c ? b : c); }
float most(float a, float b, float c) { return a > b ? (a > c ? a : c) : (b > c ? b : c); }

/// Corners of eight triangles, seen from the point.
struct EightTriangles {
    Eight x[3];
    Eight y[3];

    // Which of them hold the point, but for the slack.
    unsigned around(Eight slack) const {
        const Eight a = x[0] * y[1] - y[0] * x[1];
        const Eight b = x[1] * y[2] - y[1] * x[2];
        const Eight c = x[2] * y[0] - y[2] * x[0];
        const Eight low = _mm256_min_ps(_mm256_min_ps(a, b), c);
        const Eight high = _mm256_max_ps(_mm256_max_ps(a, b), c);
        return static_cast<unsigned>(_mm256_movemask_ps(_mm256_or_ps(
            _mm256_cmp_ps(low, -slack, _CMP_GE_OQ), _mm256_cmp_ps(high, slack, _CMP_LE_OQ))));
    }
};

void append(unsigned bits, std::size_t block, std::uint32_t* found, std::size_t& count) {
    for (; bits != 0; bits &= bits - 1)
        found[count++] =
            static_cast<std::uint32_t>(8 * block) + static_cast<std::uint32_t>(__builtin_ctz(bits));
}

}  // namespace

bool may_hold(const SlicedPeer& triangle, float x, float y, float t, float slack) {
    float px[3];
    float py[3];
    for (int c = 0; c < 3; ++c) {
        px[c] = triangle.corner[c][0] + t * triangle.growth[c][0] - x;
        py[c] = triangle.corner[c][1] + t * triangle.growth[c][1] - y;
    }
    const float a = px[0] * py[1] - py[0] * px[1];
    const float b = px[1] * py[2] - py[1] * px[2];
    const float c = px[2] * py[0] - py[2] * px[0];
    return least(a, b, c) >= -slack || most(a, b, c) <= slack;
}

// The last block is filled up with triangles that are nowhere.
BeamScan::BeamScan(const std::vector<RaysPeer>& triangles) : blocks_((triangles.size() + 7) / 8) {
    for (std::size_t i = 0; i < 8 * blocks_.size(); ++i) {
        const RaysPeer& from = triangles[std::min(i, triangles.size() - 1)];
        const float filler = i < triangles.size() ? 0.0F : nan;
        for (int c = 0; c < 3; ++c)
            for (int axis = 0; axis < 3; ++axis) {
                blocks_[i / 8].position[c][axis][i % 8] = from.position[c][axis] + filler;
                blocks_[i / 8].direction[c][axis][i % 8] = from.direction[c][axis];
            }
    }
}

std::size_t BeamScan::find(const float point[3], const float normal[3], float slack,
                           std::uint32_t* found) const {
    std::size_t count = 0;
    const Eight all_slack = _mm256_set1_ps(slack);
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
        EightTriangles eight;
        for (int c = 0; c < 3; ++c) {
            Eight from[3];
            Eight along[3];
            for (int axis = 0; axis < 3; ++axis) {
                from[axis] = load(blocks_[i].position[c][axis]) - point[axis];
                along[axis] = load(blocks_[i].direction[c][axis]);
            }
            const Eight height = normal[0] * from[0] + normal[1] * from[1] + normal[2] * from[2];
            const Eight steep = normal[0] * along[0] + normal[1] * along[1] + normal[2] * along[2];
            const Eight way = height / -steep;
            eight.x[c] = from[0] + way * along[0];
            eight.y[c] = from[1] + way * along[1];
        }
        append(eight.around(all_slack), i, found, count);
    }
    return count;
}

SliceScan::SliceScan(const std::vector<SlicedPeer>& triangles)
    : blocks_((triangles.size() + 7) / 8) {
    for (std::size_t i = 0; i < 8 * blocks_.size(); ++i) {
        const SlicedPeer& from = triangles[std::min(i, triangles.size() - 1)];
        const float filler = i < triangles.size() ? 0.0F : nan;
        for (int c = 0; c < 3; ++c)
            for (int axis = 0; axis < 2; ++axis) {
                blocks_[i / 8].corner[c][axis][i % 8] = from.corner[c][axis] + filler;
                blocks_[i / 8].growth[c][axis][i % 8] = from.growth[c][axis];
            }
    }
}

std::size_t SliceScan::find(float x, float y, float t, float slack, std::uint32_t* found) const {
    std::size_t count = 0;
    const Eight all_slack = _mm256_set1_ps(slack);
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
        const Block& block = blocks_[i];
        EightTriangles eight;
        for (int c = 0; c < 3; ++c) {
            eight.x[c] = load(block.corner[c][0]) + t * load(block.growth[c][0]) - x;
            eight.y[c] = load(block.corner[c][1]) + t * load(block.growth[c][1]) - y;
        }
        append(eight.around(all_slack), i, found, count);
    }
    return count;
}

}  // namespace caustics::bench
