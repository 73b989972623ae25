#include "photonmap/kernels/simd_avx2.h"
#include "photonmap/kernels/tree_kernels_of.h"

namespace caustics::photonmap {

const TreeKernels& avx2_tree_kernels() { return TreeKernelsOf<Avx2Lanes>::value; }

}  // namespace caustics::photonmap
