#include <immintrin.h>

#include "beamtree/slices/slice_walk.h"

namespace caustics::beamtree {
namespace {

class Avx2Eight {
public:
    explicit Avx2Eight(const SliceWalk& walk)
        : least_share_(_mm256_set1_ps(walk.least_share)),
          most_share_(_mm256_set1_ps(walk.most_share)) {
        for (unsigned axis = 0; axis < 2; ++axis) {
            low_[axis] = _mm256_set1_ps(walk.low[axis]);
            high_[axis] = _mm256_set1_ps(walk.high[axis]);
        }
    }

    uint32_t meets(const SliceNode& node) const {
        const __m256 begun = not_above(_mm256_load_ps(node.begun_from), most_share_);
        return bits(_mm256_and_ps(begun, _mm256_and_ps(meets(node, 0), meets(node, 1))));
    }

    static uint32_t may_hold(const SliceLeaf& leaf, const SlicePoint& point, bool has_bulges) {
        const __m256 share = _mm256_set1_ps(point.share);
        __m256 x[3];
        __m256 y[3];
        for (unsigned c = 0; c < 3; ++c) {
            x[c] = _mm256_sub_ps(at(leaf.corner[c][0], leaf.growth[c][0], share),
                                 _mm256_set1_ps(point.at[0]));
            y[c] = _mm256_sub_ps(at(leaf.corner[c][1], leaf.growth[c][1], share),
                                 _mm256_set1_ps(point.at[1]));
        }
        const __m256 a = cross(x[0], y[0], x[1], y[1]);
        const __m256 b = cross(x[1], y[1], x[2], y[2]);
        const __m256 c = cross(x[2], y[2], x[0], y[0]);
        const __m256 slack = _mm256_load_ps(leaf.slack);
        const __m256 cut = _mm256_cmp_ps(share, _mm256_load_ps(leaf.whole_from), _CMP_LT_OQ);
        const __m256 begun =
            not_above(_mm256_load_ps(leaf.begun_from), _mm256_set1_ps(point.last_share));
        if (point.reach[0] > 0) {
            const __m256 by_a = _mm256_add_ps(slack, passed(point, x, y, 0, 1));
            const __m256 by_b = _mm256_add_ps(slack, passed(point, x, y, 1, 2));
            const __m256 by_c = _mm256_add_ps(slack, passed(point, x, y, 2, 0));
            const __m256 zero = _mm256_setzero_ps();
            const __m256 least =
                _mm256_min_ps(_mm256_min_ps(_mm256_add_ps(a, by_a), _mm256_add_ps(b, by_b)),
                              _mm256_add_ps(c, by_c));
            const __m256 most =
                _mm256_max_ps(_mm256_max_ps(_mm256_sub_ps(a, by_a), _mm256_sub_ps(b, by_b)),
                              _mm256_sub_ps(c, by_c));
            const __m256 holds =
                _mm256_or_ps(cut, _mm256_or_ps(not_above(zero, least), not_above(most, zero)));
            const __m256 taken = _mm256_and_ps(begun, not_above(zero, slack));
            const uint32_t near = bits(_mm256_and_ps(taken, holds));
            return near == 0 ? 0 : near & bits(box_holds(leaf, point));
        }
        const __m256 minus = _mm256_xor_ps(slack, _mm256_set1_ps(-0.0F));
        const __m256 least = _mm256_min_ps(_mm256_min_ps(a, b), c);
        const __m256 most = _mm256_max_ps(_mm256_max_ps(a, b), c);
        const __m256 holds = _mm256_or_ps(not_above(minus, least), not_above(most, slack));
        const uint32_t held = bits(_mm256_and_ps(begun, holds));
        const uint32_t clipped = bits(_mm256_andnot_ps(holds, _mm256_and_ps(begun, cut)));
        if (has_bulges) {
            const uint32_t taken = bits(not_above(_mm256_setzero_ps(), slack));
            const uint32_t near = (held | clipped) & taken;
            return near == 0 ? 0 : near & bits(box_holds(leaf, point));
        }
        if (clipped == 0) return held;
        return held | (clipped & bits(box_holds(leaf, point)));
    }

private:
    // Twice the area by which an edge may pass a point that reaches out.
    static __m256 passed(const SlicePoint& point, const __m256 (&x)[3], const __m256 (&y)[3],
                         unsigned from, unsigned to) {
        const __m256 sign = _mm256_set1_ps(-0.0F);
        const __m256 dx = _mm256_andnot_ps(sign, _mm256_sub_ps(x[to], x[from]));
        const __m256 dy = _mm256_andnot_ps(sign, _mm256_sub_ps(y[to], y[from]));
        return _mm256_add_ps(_mm256_mul_ps(dx, _mm256_set1_ps(point.reach[1])),
                             _mm256_mul_ps(dy, _mm256_set1_ps(point.reach[0])));
    }
    static __m256 box_holds(const SliceLeaf& leaf, const SlicePoint& point) {
        return _mm256_and_ps(box_holds(leaf, 0, point), box_holds(leaf, 1, point));
    }
    static __m256 box_holds(const SliceLeaf& leaf, unsigned axis, const SlicePoint& point) {
        __m256 top[3];
        __m256 bottom[3];
        for (unsigned c = 0; c < 3; ++c) {
            top[c] = _mm256_load_ps(leaf.corner[c][axis]);
            bottom[c] = _mm256_add_ps(top[c], _mm256_load_ps(leaf.growth[c][axis]));
        }
        const __m256 low = _mm256_min_ps(_mm256_min_ps(top[0], top[1]), top[2]);
        const __m256 high = _mm256_max_ps(_mm256_max_ps(top[0], top[1]), top[2]);
        const __m256 low_growth =
            _mm256_sub_ps(_mm256_min_ps(_mm256_min_ps(bottom[0], bottom[1]), bottom[2]), low);
        const __m256 high_growth =
            _mm256_sub_ps(_mm256_max_ps(_mm256_max_ps(bottom[0], bottom[1]), bottom[2]), high);
        const __m256 share = _mm256_set1_ps(point.share);
        const __m256 low_here = _mm256_add_ps(low, _mm256_mul_ps(share, low_growth));
        const __m256 high_here = _mm256_add_ps(high, _mm256_mul_ps(share, high_growth));
        const __m256 here = _mm256_set1_ps(point.at[axis]);
        const __m256 reach =
            _mm256_add_ps(_mm256_set1_ps(point.reach[axis]), _mm256_load_ps(leaf.room[axis]));
        return _mm256_and_ps(not_above(low_here, _mm256_add_ps(here, reach)),
                             not_above(_mm256_sub_ps(here, reach), high_here));
    }

    __m256 meets(const SliceNode& node, unsigned axis) const {
        const __m256 low = _mm256_min_ps(at(node.low[axis], node.low_growth[axis], least_share_),
                                         at(node.low[axis], node.low_growth[axis], most_share_));
        const __m256 high = _mm256_max_ps(at(node.high[axis], node.high_growth[axis], least_share_),
                                          at(node.high[axis], node.high_growth[axis], most_share_));
        return _mm256_and_ps(not_above(low, high_[axis]), not_above(low_[axis], high));
    }
    static __m256 at(const float* top, const float* growth, __m256 share) {
        return _mm256_add_ps(_mm256_load_ps(top), _mm256_mul_ps(share, _mm256_load_ps(growth)));
    }
    static __m256 cross(__m256 ax, __m256 ay, __m256 bx, __m256 by) {
        return _mm256_sub_ps(_mm256_mul_ps(ax, by), _mm256_mul_ps(ay, bx));
    }
    static __m256 not_above(__m256 a, __m256 b) { return _mm256_cmp_ps(a, b, _CMP_LE_OQ); }
    static uint32_t bits(__m256 mask) { return static_cast<uint32_t>(_mm256_movemask_ps(mask)); }

    __m256 low_[2];
    __m256 high_[2];
    __m256 least_share_;
    __m256 most_share_;
};

}  // namespace

void walk_slices_avx2(const SliceView& tree, SliceWalk* walks, size_t count) {
    walk_slices<Avx2Eight>(tree, walks, count);
}

}  // namespace caustics::beamtree
