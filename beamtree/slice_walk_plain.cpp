#include "beamtree/slice_walk.h"

namespace caustics {
namespace {

float least(float a, float b, float c) {
    const float ab = a < b ? a : b;
    return ab < c ? ab : c;
}

float most(float a, float b, float c) {
    const float ab = a > b ? a : b;
    return ab > c ? ab : c;
}

/// The tests one by one: what the wider ones must agree with.
class PlainEight {
public:
    explicit PlainEight(const SliceWalk& walk) : walk_(walk) {}

    uint32_t inside(const SliceNode& node) const {
        uint32_t bits = 0;
        for (unsigned i = 0; i < slice_width; ++i) {
            bool in = true;
            for (unsigned axis = 0; axis < 2; ++axis) {
                const float p = walk_.point[axis];
                in = in && node.low[axis][i] + walk_.share * node.low_growth[axis][i] <= p &&
                     node.high[axis][i] + walk_.share * node.high_growth[axis][i] >= p;
            }
            bits |= (in ? 1U : 0U) << i;
        }
        return bits;
    }

    // The point is on one side of all three edges, but for rounding.
    uint32_t may_hold(const SliceLeaf& leaf) const {
        uint32_t bits = 0;
        for (unsigned i = 0; i < slice_width; ++i) {
            float x[3];
            float y[3];
            for (unsigned c = 0; c < 3; ++c) {
                x[c] = leaf.corner[c][0][i] + walk_.share * leaf.growth[c][0][i] - walk_.point[0];
                y[c] = leaf.corner[c][1][i] + walk_.share * leaf.growth[c][1][i] - walk_.point[1];
            }
            const float a = x[0] * y[1] - y[0] * x[1];
            const float b = x[1] * y[2] - y[1] * x[2];
            const float c = x[2] * y[0] - y[2] * x[0];
            const float slack = leaf.slack[i];
            const bool holds = least(a, b, c) >= -slack || most(a, b, c) <= slack;
            bits |= (holds || walk_.share < leaf.whole_from[i] ? 1U : 0U) << i;
        }
        return bits;
    }

private:
    const SliceWalk& walk_;
};

}  // namespace

void walk_slices_plain(const SliceView& tree, SliceWalk& walk) {
    walk_slices<PlainEight>(tree, walk);
}

}  // namespace caustics
