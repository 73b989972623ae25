#include "photonmap/lanes_avx2.h"
#include "photonmap/tree_kernels_of.h"

namespace caustics {

const TreeKernels& avx2_tree_kernels() { return TreeKernelsOf<Avx2Lanes>::value; }

}  // namespace caustics
