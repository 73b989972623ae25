#include "photonmap/lanes_avx512.h"
#include "photonmap/tree_kernels_of.h"

namespace caustics {

const TreeKernels& avx512_tree_kernels() { return TreeKernelsOf<Avx512Lanes>::value; }

}  // namespace caustics
