#pragma once

#include <cstdint>
#include <span>

#include "core/math/vec.h"

namespace caustics {

/// The unit square in equal strata, walked so that consecutive strata are near each other: square
/// blocks of up to 64 x 64 strata row by row, to and fro, and within a block in Morton order.
/// A whole walk is one stratified batch.
class StratifiedSquare {
public:
    /// The smallest walk of at least, or the largest of at most, `size` >= 1 strata, among grids
    /// that are not far from square.
    static StratifiedSquare at_least(std::uint64_t size);
    static StratifiedSquare at_most(std::uint64_t size);

    /// Number of strata.
    std::uint64_t size() const { return columns_ * rows_ << (2 * block_bits_); }
    /// Moves points of the unit square, one for each of the strata number `first`, `first` + 1, ...
    /// < size(), to the same places in their strata.
    void place(std::uint64_t first, std::span<double> x, std::span<double> y) const;

private:
    void place_in_block(const Vec2d& corner, std::uint32_t code, std::span<double> x,
                        std::span<double> y) const;
    static StratifiedSquare nearest(std::uint64_t blocks, unsigned block_bits, bool or_more);
    StratifiedSquare(std::uint64_t columns, std::uint64_t rows, unsigned block_bits);

    std::uint64_t columns_;  ///< of blocks
    std::uint64_t rows_;
    unsigned block_bits_;  ///< a block has 2^block_bits strata a side
    Vec2d stratum_;        ///< a stratum's sides
};

}  // namespace caustics
