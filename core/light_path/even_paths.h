#pragma once

#include <cstdint>
#include <optional>

#include "core/light_path/aimed_emission.h"
#include "core/light_path/emission_samples.h"
#include "core/light_path/stratified_square.h"

namespace caustics {

/// A batch of light paths that are spread evenly over all light to the casters. Points and directions send light into a
/// square of numbers: each of its strata has a path (StratifiedSquare). A light with an extent takes four numbers, of which
/// strata would be too coarse: there all numbers up to a path's third event are points of Roberts' sequences (lattice.h),
/// shifted at random as a whole. Every path alone is uniform, and batches are independent.
class EvenPaths {
public:
    /// A batch of at least, or of at most, `size` >= 1 paths.
    static EvenPaths at_least(const AimedEmission& emission, std::uint64_t size);
    static EvenPaths at_most(const AimedEmission& emission, std::uint64_t size);

    std::uint64_t size() const { return square_ ? square_->size() : size_; }
    /// Draws consecutive paths of one batch, whose first path has the number `first_of_batch`.
    void draw(const ConsecutivePaths& paths, std::uint64_t first_of_batch,
              const EmissionKernels& kernels, EmissionSamples& samples) const;

private:
    explicit EvenPaths(std::uint64_t size) : size_(size) {}
    explicit EvenPaths(const StratifiedSquare& square) : square_(square) {}

    std::uint64_t size_ = 0;
    std::optional<StratifiedSquare> square_;
};

}  // namespace caustics
