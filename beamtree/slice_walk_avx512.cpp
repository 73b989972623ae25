#include <immintrin.h>

#include "beamtree/slice_walk.h"

namespace caustics {
namespace {

/// Both axes of eight boxes or corners in one register.
class Avx512Eight {
public:
    explicit Avx512Eight(const SliceWalk& walk)
        : point_(
              _mm512_insertf32x8(_mm512_set1_ps(walk.point[0]), _mm256_set1_ps(walk.point[1]), 1)),
          share_(_mm512_set1_ps(walk.share)) {}

    uint32_t inside(const SliceNode& node) const {
        const __mmask16 above =
            _mm512_cmp_ps_mask(at(node.low, node.low_growth), point_, _CMP_LE_OQ);
        const __mmask16 in =
            _mm512_mask_cmp_ps_mask(above, point_, at(node.high, node.high_growth), _CMP_LE_OQ);
        return both(in);
    }

    uint32_t may_hold(const SliceLeaf& leaf) const {
        __m512 corner[3];
        for (unsigned c = 0; c < 3; ++c)
            corner[c] = _mm512_sub_ps(at(leaf.corner[c], leaf.growth[c]), point_);
        const __m256 a = cross(corner[0], corner[1]);
        const __m256 b = cross(corner[1], corner[2]);
        const __m256 c = cross(corner[2], corner[0]);
        const __m256 slack = _mm256_load_ps(leaf.slack);
        const __m256 minus = _mm256_xor_ps(slack, _mm256_set1_ps(-0.0F));
        const __m256 least = _mm256_min_ps(_mm256_min_ps(a, b), c);
        const __m256 most = _mm256_max_ps(_mm256_max_ps(a, b), c);
        const __m256 share = _mm512_castps512_ps256(share_);
        const unsigned holds =
            _mm256_cmp_ps_mask(minus, least, _CMP_LE_OQ) |
            _mm256_cmp_ps_mask(most, slack, _CMP_LE_OQ) |
            _mm256_cmp_ps_mask(share, _mm256_load_ps(leaf.whole_from), _CMP_LT_OQ);
        return holds;
    }

private:
    __m512 at(const float (&top)[2][slice_width], const float (&growth)[2][slice_width]) const {
        return _mm512_add_ps(_mm512_load_ps(top[0]),
                             _mm512_mul_ps(share_, _mm512_load_ps(growth[0])));
    }
    static __m256 cross(__m512 a, __m512 b) {
        const __m512 swapped = _mm512_shuffle_f32x4(b, b, _MM_SHUFFLE(1, 0, 3, 2));
        const __m512 products = _mm512_mul_ps(a, swapped);
        return _mm256_sub_ps(_mm512_castps512_ps256(products), _mm512_extractf32x8_ps(products, 1));
    }
    static uint32_t both(__mmask16 mask) {
        const uint32_t bits = _cvtmask16_u32(mask);
        return bits & bits >> slice_width;
    }

    __m512 point_;
    __m512 share_;
};

}  // namespace

void walk_slices_avx512(const SliceView& tree, SliceWalk& walk) {
    walk_slices<Avx512Eight>(tree, walk);
}

}  // namespace caustics
