#include <immintrin.h>

#include "beamtree/slice_walk.h"

namespace caustics {
namespace {

/// Both axes of eight boxes or corners in one register.
class Avx512Eight {
public:
    explicit Avx512Eight(const SliceWalk& walk)
        : low_(pair(walk.low)),
          high_(pair(walk.high)),
          least_share_(_mm512_set1_ps(walk.least_share)),
          most_share_(_mm512_set1_ps(walk.most_share)) {}

    uint32_t meets(const SliceNode& node) const {
        const __m512 low = _mm512_min_ps(at(node.low, node.low_growth, least_share_),
                                         at(node.low, node.low_growth, most_share_));
        const __m512 high = _mm512_max_ps(at(node.high, node.high_growth, least_share_),
                                          at(node.high, node.high_growth, most_share_));
        const __mmask16 above = _mm512_cmp_ps_mask(low, high_, _CMP_LE_OQ);
        const uint32_t both = _mm512_mask_cmp_ps_mask(above, low_, high, _CMP_LE_OQ);
        return both & both >> slice_width;
    }

    static uint32_t may_hold(const SliceLeaf& leaf, const SlicePoint& point) {
        const __m512 at_point = pair(point.at);
        const __m512 share = _mm512_set1_ps(point.share);
        __m512 corner[3];
        for (unsigned c = 0; c < 3; ++c)
            corner[c] = _mm512_sub_ps(at(leaf.corner[c], leaf.growth[c], share), at_point);
        const __m256 a = cross(corner[0], corner[1]);
        const __m256 b = cross(corner[1], corner[2]);
        const __m256 c = cross(corner[2], corner[0]);
        const __m256 slack = _mm256_load_ps(leaf.slack);
        const __m256 minus = _mm256_xor_ps(slack, _mm256_set1_ps(-0.0F));
        const __m256 least = _mm256_min_ps(_mm256_min_ps(a, b), c);
        const __m256 most = _mm256_max_ps(_mm256_max_ps(a, b), c);
        const __mmask8 in = _mm256_cmp_ps_mask(minus, least, _CMP_LE_OQ);
        const __mmask8 turned = _mm256_cmp_ps_mask(most, slack, _CMP_LE_OQ);
        const __mmask8 cut = _mm256_cmp_ps_mask(_mm512_castps512_ps256(share),
                                                _mm256_load_ps(leaf.whole_from), _CMP_LT_OQ);
        return static_cast<uint32_t>(in | turned | cut);
    }

private:
    using Pairs = float[2][slice_width];

    static __m512 pair(const float (&of)[2]) {
        return _mm512_insertf32x8(_mm512_set1_ps(of[0]), _mm256_set1_ps(of[1]), 1);
    }
    static __m512 at(const Pairs& top, const Pairs& growth, __m512 share) {
        return _mm512_add_ps(_mm512_load_ps(&top), _mm512_mul_ps(share, _mm512_load_ps(&growth)));
    }
    static __m256 cross(__m512 a, __m512 b) {
        const __m512 swapped = _mm512_shuffle_f32x4(b, b, _MM_SHUFFLE(1, 0, 3, 2));
        const __m512 products = _mm512_mul_ps(a, swapped);
        return _mm256_sub_ps(_mm512_castps512_ps256(products), _mm512_extractf32x8_ps(products, 1));
    }

    __m512 low_;
    __m512 high_;
    __m512 least_share_;
    __m512 most_share_;
};

}  // namespace

void walk_slices_avx512(const SliceView& tree, SliceWalk& walk) {
    walk_slices<Avx512Eight>(tree, walk);
}

}  // namespace caustics
