#include "core/light_path/emission_samples.h"

#include "core/math/lattice.h"

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
    on_lattice_ = false;
    std::uint32_t* const words[4] = {words_[0].data(), words_[1].data(), words_[2].data(),
                                     words_[3].data()};
    kernels.first_words(paths, words);
    set_points();
}

void EmissionSamples::draw_lattice(const ConsecutivePaths& paths, std::uint64_t first_of_lattice) {
    constexpr std::array<std::uint64_t, 8> steps = {r4_steps[0], r4_steps[1], r4_steps[2],
                                                    r4_steps[3], r3_steps[0], r3_steps[1],
                                                    r3_steps[2], r1_steps[0]};
    paths_ = paths;
    on_lattice_ = true;
    Rng shift(paths.seed, static_cast<Stage>(paths.stage), first_of_lattice);
    for (std::size_t k = 0; k < steps.size(); ++k) {
        std::uint64_t at =
            (std::uint64_t{shift.next_word()} << 32U) + (paths.first - first_of_lattice) * steps[k];
        for (std::size_t i = 0; i < paths.count; ++i, at += steps[k]) words_[k][i] = high_word(at);
    }
    set_points();
}

void EmissionSamples::set_points() {
    for (std::size_t i = 0; i < size(); ++i) {
        x_[i] = static_cast<double>(words_[0][i]) * 0x1p-32;
        y_[i] = static_cast<double>(words_[1][i]) * 0x1p-32;
    }
}

}  // namespace caustics
