#include "beamtree/slices/slice_walk.h"

namespace caustics::beamtree {
namespace {

float least(float a, float b) { return a < b ? a : b; }
float most(float a, float b) { return a > b ? a : b; }
float magnitude(float a) { return a < 0 ? -a : a; }

/// The tests one by one: what the wider ones must agree with.
class PlainEight {
public:
    explicit PlainEight(const SliceWalk& walk) : walk_(walk) {}

    uint32_t meets(const SliceNode& node) const {
        uint32_t bits = 0;
        for (unsigned i = 0; i < slice_width; ++i) {
            bool meets = node.begun_from[i] <= walk_.most_share;
            for (unsigned axis = 0; axis < 2; ++axis) {
                const auto at = [&](const float(&top)[2][slice_width],
                                    const float(&growth)[2][slice_width],
                                    float share) { return top[axis][i] + share * growth[axis][i]; };
                const float low = least(at(node.low, node.low_growth, walk_.least_share),
                                        at(node.low, node.low_growth, walk_.most_share));
                const float high = most(at(node.high, node.high_growth, walk_.least_share),
                                        at(node.high, node.high_growth, walk_.most_share));
                meets = meets && low <= walk_.high[axis] && walk_.low[axis] <= high;
            }
            bits |= (meets ? 1U : 0U) << i;
        }
        return bits;
    }

    // The point is on one side of all three edges, but for rounding and its reach; or the triangle is cut there. Where it is cut, or
    // the point reaches out, or triangles have bulges, their boxes meet.
    static uint32_t may_hold(const SliceLeaf& leaf, const SlicePoint& point, bool has_bulges) {
        const bool reaches = point.reach[0] > 0;
        uint32_t bits = 0;
        for (unsigned i = 0; i < slice_width; ++i) {
            float x[3];
            float y[3];
            for (unsigned c = 0; c < 3; ++c) {
                x[c] = leaf.corner[c][0][i] + point.share * leaf.growth[c][0][i] - point.at[0];
                y[c] = leaf.corner[c][1][i] + point.share * leaf.growth[c][1][i] - point.at[1];
            }
            const float a = x[0] * y[1] - y[0] * x[1];
            const float b = x[1] * y[2] - y[1] * x[2];
            const float c = x[2] * y[0] - y[2] * x[0];
            const float slack = leaf.slack[i];
            const bool cut = point.share < leaf.whole_from[i];
            bool holds = -slack <= least(least(a, b), c) || most(most(a, b), c) <= slack;
            if (reaches) {
                const float by_a = slack + passed(point, x[1] - x[0], y[1] - y[0]);
                const float by_b = slack + passed(point, x[2] - x[1], y[2] - y[1]);
                const float by_c = slack + passed(point, x[0] - x[2], y[0] - y[2]);
                holds = 0 <= least(least(a + by_a, b + by_b), c + by_c) ||
                        most(most(a - by_a, b - by_b), c - by_c) <= 0;
            }
            const bool is_taken = slack >= 0;
            if (reaches || has_bulges ? is_taken && (holds || cut) : cut && !holds)
                holds = box_holds(leaf, i, 0, point) && box_holds(leaf, i, 1, point);
            const bool begun = leaf.begun_from[i] <= point.last_share;
            bits |= (begun && holds ? 1U : 0U) << i;
        }
        return bits;
    }

private:
    // Twice the area by which an edge may pass a point that reaches out.
    static float passed(const SlicePoint& point, float x, float y) {
        return magnitude(x) * point.reach[1] + magnitude(y) * point.reach[0];
    }

    // As the boxes of nodes: between those on both planes.
    static bool box_holds(const SliceLeaf& leaf, unsigned i, unsigned axis,
                          const SlicePoint& point) {
        float top[3];
        float bottom[3];
        for (unsigned c = 0; c < 3; ++c) {
            top[c] = leaf.corner[c][axis][i];
            bottom[c] = top[c] + leaf.growth[c][axis][i];
        }
        const float low = least(least(top[0], top[1]), top[2]);
        const float high = most(most(top[0], top[1]), top[2]);
        const float low_growth = least(least(bottom[0], bottom[1]), bottom[2]) - low;
        const float high_growth = most(most(bottom[0], bottom[1]), bottom[2]) - high;
        const float reach = point.reach[axis] + leaf.room[axis][i];
        return low + point.share * low_growth <= point.at[axis] + reach &&
               point.at[axis] - reach <= high + point.share * high_growth;
    }

    const SliceWalk& walk_;
};

}  // namespace

void walk_slices_plain(const SliceView& tree, SliceWalk* walks, size_t count) {
    walk_slices<PlainEight>(tree, walks, count);
}

}  // namespace caustics::beamtree
