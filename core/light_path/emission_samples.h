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

    /// Draws those of paths whose first eight numbers are points of Roberts' sequences in four, three and one dimensions, shifted by
    /// the first eight of the path `first_of_lattice`, which is not after them.
    void draw_lattice(const ConsecutivePaths& paths, std::uint64_t first_of_lattice);

    std::size_t size() const { return paths_.count; }
    std::uint64_t path(std::size_t i) const { return paths_.first + i; }
    std::span<const double> x() const { return {x_.data(), size()}; }
    std::span<const double> y() const { return {y_.data(), size()}; }
    /// To be moved to strata, say.
    std::span<double> x() { return {x_.data(), size()}; }
    std::span<double> y() { return {y_.data(), size()}; }
    /// The path's stream after its point, or after the four numbers that it begins with.
    Rng rng(std::size_t i, unsigned used = 2) const {
        const auto stage = static_cast<Stage>(paths_.stage);
        if (!on_lattice_) return {paths_.seed, stage, path(i), four(0, i), used};
        return {paths_.seed, stage, path(i), four(0, i), four(4, i), used};
    }

private:
    std::array<std::uint32_t, 4> four(std::size_t first, std::size_t i) const {
        return {words_[first][i], words_[first + 1][i], words_[first + 2][i], words_[first + 3][i]};
    }
    void set_points();

    ConsecutivePaths paths_{};
    bool on_lattice_ = false;
    alignas(
        64) std::array<std::array<std::uint32_t, most>, 8> words_;  ///< four, or eight of a lattice
    alignas(64) std::array<double, most> x_;
    alignas(64) std::array<double, most> y_;
};

}  // namespace caustics
