#include "beamtree/pencils/pencil_loops.h"

namespace caustics::beamtree {

const PencilKernels& avx512_pencil_kernels() { return pencil_loops; }

}  // namespace caustics::beamtree
