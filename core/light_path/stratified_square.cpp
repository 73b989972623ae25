#include "core/light_path/stratified_square.h"

#include <algorithm>
#include <cmath>

namespace caustics {

namespace {

constexpr unsigned largest_block_bits = 6;
/// A grid has at least this many blocks, so that whole blocks can come close to any size.
constexpr std::uint64_t fewest_blocks = 256;

/// Every other bit of a Morton code.
std::uint32_t even_bits(std::uint32_t code) {
    std::uint32_t bits = code & 0x55555555U;
    bits = (bits | bits >> 1U) & 0x33333333U;
    bits = (bits | bits >> 2U) & 0x0F0F0F0FU;
    bits = (bits | bits >> 4U) & 0x00FF00FFU;
    return (bits | bits >> 8U) & 0x0000FFFFU;
}

unsigned block_bits_for(std::uint64_t size) {
    unsigned bits = 0;
    while (bits < largest_block_bits && size >> (2 * bits + 2) >= fewest_blocks) ++bits;
    return bits;
}

}  // namespace

StratifiedSquare::StratifiedSquare(std::uint64_t columns, std::uint64_t rows, unsigned block_bits)
    : columns_(columns),
      rows_(rows),
      block_bits_(block_bits),
      stratum_(1 / static_cast<double>(columns << block_bits),
               1 / static_cast<double>(rows << block_bits)) {}

// Among the grids up to 16 : 9, the one whose number of blocks is next to what is asked.
StratifiedSquare StratifiedSquare::nearest(std::uint64_t blocks, unsigned bits, bool or_more) {
    const auto side = static_cast<std::uint64_t>(std::sqrt(static_cast<double>(blocks)));
    StratifiedSquare best(side, side, bits);
    std::uint64_t smallest_gap = ~std::uint64_t{0};
    for (std::uint64_t columns = side; 4 * columns >= 3 * side; --columns) {
        const std::uint64_t rows = (or_more ? blocks + columns - 1 : blocks) / columns;
        const std::uint64_t gap =
            std::max(columns * rows, blocks) - std::min(columns * rows, blocks);
        if (gap >= smallest_gap) continue;
        smallest_gap = gap;
        best = StratifiedSquare(columns, rows, bits);
    }
    return best;
}

StratifiedSquare StratifiedSquare::at_least(std::uint64_t size) {
    const unsigned bits = block_bits_for(size);
    return nearest(((size - 1) >> (2 * bits)) + 1, bits, true);
}

StratifiedSquare StratifiedSquare::at_most(std::uint64_t size) {
    const unsigned bits = block_bits_for(size);
    return nearest(size >> (2 * bits), bits, false);
}

void StratifiedSquare::place(std::uint64_t first, std::span<double> x, std::span<double> y) const {
    const std::uint64_t in_block = std::uint64_t{1} << (2 * block_bits_);
    for (std::size_t done = 0; done < x.size();) {
        const std::uint64_t block = (first + done) / in_block;
        const std::uint64_t code = (first + done) % in_block;
        const std::size_t run = std::min<std::uint64_t>(x.size() - done, in_block - code);
        const std::uint64_t row = block / columns_;
        const std::uint64_t along = block % columns_;
        const std::uint64_t column = row % 2 == 0 ? along : columns_ - 1 - along;
        place_in_block(Vec2d(static_cast<double>(column << block_bits_),
                             static_cast<double>(row << block_bits_)),
                       static_cast<std::uint32_t>(code), x.subspan(done, run),
                       y.subspan(done, run));
        done += run;
    }
}

// From Morton code number `code` on; `corner` is the block's, counted in strata.
void StratifiedSquare::place_in_block(const Vec2d& corner, std::uint32_t code, std::span<double> x,
                                      std::span<double> y) const {
    constexpr double below_one = 1 - 0x1p-53;
    for (std::uint32_t i = 0; i < x.size(); ++i) {
        const double column = corner.x() + static_cast<int>(even_bits(code + i));
        const double row = corner.y() + static_cast<int>(even_bits((code + i) >> 1U));
        x[i] = std::min((column + x[i]) * stratum_.x(), below_one);
        y[i] = std::min((row + y[i]) * stratum_.y(), below_one);
    }
}

}  // namespace caustics
