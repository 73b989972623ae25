#include "photonmap/kernels/simd_plain.h"
#include "photonmap/kernels/tree_kernels_of.h"

namespace caustics::photonmap {

const TreeKernels& plain_tree_kernels() { return TreeKernelsOf<PlainSimd>::value; }

}  // namespace caustics::photonmap
