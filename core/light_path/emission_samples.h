#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/base/isa.h"
#include "core/light_path/emission_kernels.h"
#include "core/math/rng.h"

namespace caustics {

/// Those of an instruction set.
const EmissionKernels& emission_kernels(Isa isa);

/// What consecutive paths start from, side by side: a point of the unit square for each, and the
/// random numbers that it continues with.
class EmissionSamples {
public:
    static constexpr std::size_t most = 256;

    /// Draws the points of up to `most` paths: the two fine numbers with which each path's stream
    /// begins.
    void draw(const ConsecutivePaths& paths, const EmissionKernels& kernels);

    std::size_t size() const { return paths_.count; }
    std::uint64_t path(std::size_t i) const { return paths_.first + i; }
    std::span<const double> x() const { return {x_.data(), size()}; }
    std::span<const double> y() const { return {y_.data(), size()}; }
    /// To be moved to strata, say.
    std::span<double> x() { return {x_.data(), size()}; }
    std::span<double> y() { return {y_.data(), size()}; }
    /// The path's stream after its point.
    Rng rng(std::size_t i) const {
        return {paths_.seed,
                static_cast<Stage>(paths_.stage),
                path(i),
                {words_[0][i], words_[1][i], words_[2][i], words_[3][i]},
                2};
    }

private:
    ConsecutivePaths paths_{};
    alignas(64) std::array<std::array<std::uint32_t, most>, 4> words_;
    alignas(64) std::array<double, most> x_;
    alignas(64) std::array<double, most> y_;
};

}  // namespace caustics
