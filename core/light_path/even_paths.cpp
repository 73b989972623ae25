#include "core/light_path/even_paths.h"

namespace caustics {

EvenPaths EvenPaths::at_least(const AimedEmission& emission, std::uint64_t size) {
    return emission.has_extent() ? EvenPaths(size) : EvenPaths(StratifiedSquare::at_least(size));
}

EvenPaths EvenPaths::at_most(const AimedEmission& emission, std::uint64_t size) {
    return emission.has_extent() ? EvenPaths(size) : EvenPaths(StratifiedSquare::at_most(size));
}

void EvenPaths::draw(const ConsecutivePaths& paths, std::uint64_t first_of_batch,
                     const EmissionKernels& kernels, EmissionSamples& samples) const {
    if (!square_) return samples.draw_lattice(paths, first_of_batch);
    samples.draw(paths, kernels);
    square_->place(paths.first - first_of_batch, samples.x(), samples.y());
}

}  // namespace caustics
