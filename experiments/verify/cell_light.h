#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/render/film.h"
#include "experiments/picture/metrics.h"
#include "experiments/verify/agreement.h"

namespace caustics::experiments {

/// The mean radiance of the layer `caustic` [W m^-2 sr^-1] in each cell of a grid over a picture, rows first, and in
/// the whole picture as the last number: the mean over seeds, with its standard error.
struct CellLight {
    static constexpr int columns = 6;
    static constexpr int rows = 4;
    static constexpr std::size_t cells = std::size_t{columns} * rows;
    std::vector<double> mean = std::vector<double>(cells + 1, 0.0);
    std::vector<double> error = std::vector<double>(cells + 1, 0.0);
};

/// Takes pictures of one size that differ by their seeds alone, over the pixels that count.
CellLight cell_light(const std::vector<Film>& films, const PixelMask& counted);

/// Limits for the whole picture and for a cell of it.
inline constexpr Limit whole_limit;
Limit cell_limit();

/// How far a method's light is from the reference's.
struct CellGap {
    bool is_black = false;  ///< The reference has no light; differences are then absolute.
    Difference whole;
    /// The cell that is farthest off, as a share of its light or of the picture's mean, whichever is more.
    Difference worst_cell;
    double largest_cell_error = 0;
    /// The factor by which the method's errors are larger than can be judged beside the reference's, at least 1.
    double excess_of_found = 1;
    std::size_t cells_off = 0;  ///< Cells whose difference is more than cell_limit().

    /// The whole within its limit and within five standard errors, and each cell within its limit: methods that
    /// average over an area move light by its width, so that a cell may differ by more than its noise.
    bool is_within() const;
    /// The errors are small enough to judge the whole and each cell, or it is clear that one is off.
    bool can_judge() const;
    std::string text() const;
};

/// The factor by which a reference's errors are larger than half of what can be judged, at least 1.
double excess_of_truth(const CellLight& truth);

CellGap gap(const CellLight& found, const CellLight& truth);

}  // namespace caustics::experiments
