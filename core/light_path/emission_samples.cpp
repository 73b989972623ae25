#include "core/light_path/emission_samples.h"

namespace caustics {

const EmissionKernels& emission_kernels(Isa isa) {
#ifdef CAUSTICS_X86_KERNELS
    if (isa == Isa::avx512) return avx512_emission_kernels();
    if (isa == Isa::avx2) return avx2_emission_kernels();
#endif
    (void)isa;
    return plain_emission_kernels();
}

void EmissionSamples::draw(const ConsecutivePaths& paths, const EmissionKernels& kernels) {
    paths_ = paths;
    std::uint32_t* const words[4] = {words_[0].data(), words_[1].data(), words_[2].data(),
                                     words_[3].data()};
    kernels.first_words(paths, words);
    for (std::size_t i = 0; i < paths.count; ++i) {
        x_[i] = static_cast<double>(words_[0][i]) * 0x1p-32;
        y_[i] = static_cast<double>(words_[1][i]) * 0x1p-32;
    }
}

}  // namespace caustics
