#include "photonmap/kernels/simd_avx512.h"
#include "photonmap/kernels/tree_kernels_of.h"

namespace caustics::photonmap {

const TreeKernels& avx512_tree_kernels() { return TreeKernelsOf<Avx512Lanes>::value; }

}  // namespace caustics::photonmap
