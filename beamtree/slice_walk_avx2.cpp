#include <immintrin.h>

#include "beamtree/slice_walk.h"

namespace caustics {
namespace {

class Avx2Eight {
public:
    explicit Avx2Eight(const SliceWalk& walk)
        : x_(_mm256_set1_ps(walk.point[0])),
          y_(_mm256_set1_ps(walk.point[1])),
          share_(_mm256_set1_ps(walk.share)) {}

    uint32_t inside(const SliceNode& node) const {
        const __m256 low = _mm256_and_ps(not_above(at(node.low[0], node.low_growth[0]), x_),
                                         not_above(at(node.low[1], node.low_growth[1]), y_));
        const __m256 high = _mm256_and_ps(not_above(x_, at(node.high[0], node.high_growth[0])),
                                          not_above(y_, at(node.high[1], node.high_growth[1])));
        return bits(_mm256_and_ps(low, high));
    }

    uint32_t may_hold(const SliceLeaf& leaf) const {
        __m256 x[3];
        __m256 y[3];
        for (unsigned c = 0; c < 3; ++c) {
            x[c] = _mm256_sub_ps(at(leaf.corner[c][0], leaf.growth[c][0]), x_);
            y[c] = _mm256_sub_ps(at(leaf.corner[c][1], leaf.growth[c][1]), y_);
        }
        const __m256 a = cross(x[0], y[0], x[1], y[1]);
        const __m256 b = cross(x[1], y[1], x[2], y[2]);
        const __m256 c = cross(x[2], y[2], x[0], y[0]);
        const __m256 slack = _mm256_load_ps(leaf.slack);
        const __m256 minus = _mm256_xor_ps(slack, _mm256_set1_ps(-0.0F));
        const __m256 least = _mm256_min_ps(_mm256_min_ps(a, b), c);
        const __m256 most = _mm256_max_ps(_mm256_max_ps(a, b), c);
        const __m256 holds = _mm256_or_ps(not_above(minus, least), not_above(most, slack));
        const __m256 cut = _mm256_cmp_ps(share_, _mm256_load_ps(leaf.whole_from), _CMP_LT_OQ);
        return bits(_mm256_or_ps(holds, cut));
    }

private:
    __m256 at(const float* top, const float* growth) const {
        return _mm256_add_ps(_mm256_load_ps(top), _mm256_mul_ps(share_, _mm256_load_ps(growth)));
    }
    static __m256 cross(__m256 ax, __m256 ay, __m256 bx, __m256 by) {
        return _mm256_sub_ps(_mm256_mul_ps(ax, by), _mm256_mul_ps(ay, bx));
    }
    static __m256 not_above(__m256 a, __m256 b) { return _mm256_cmp_ps(a, b, _CMP_LE_OQ); }
    static uint32_t bits(__m256 mask) { return static_cast<uint32_t>(_mm256_movemask_ps(mask)); }

    __m256 x_;
    __m256 y_;
    __m256 share_;
};

}  // namespace

void walk_slices_avx2(const SliceView& tree, SliceWalk& walk) {
    walk_slices<Avx2Eight>(tree, walk);
}

}  // namespace caustics
