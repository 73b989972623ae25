#include "core/light_path/emission_loops.h"

namespace caustics {

const EmissionKernels& avx2_emission_kernels() { return emission_loops; }

}  // namespace caustics
