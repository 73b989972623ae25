#include "photonmap/lanes_plain.h"
#include "photonmap/tree_kernels_of.h"

namespace caustics {

const TreeKernels& plain_tree_kernels() { return TreeKernelsOf<PlainLanes>::value; }

}  // namespace caustics
