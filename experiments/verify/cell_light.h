#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/render/film.h"
#include "experiments/picture/metrics.h"

namespace caustics::experiments {

/// Light by cells of a picture, over seeds: the mean radiance of the layer `caustic` [W m^-2 sr^-1] in each
/// cell of a grid, rows first, and in the whole picture as the last number, with its standard error.
struct CellLight {
    static constexpr int columns = 6;
    static constexpr int rows = 4;
    std::vector<double> mean = std::vector<double>(columns * rows + 1, 0.0);
    std::vector<double> error = std::vector<double>(columns * rows + 1, 0.0);
};

/// Of pictures of one size that differ by their seeds alone, over the pixels that count.
CellLight cell_light(const std::vector<Film>& films, const PixelMask& counted);

/// What a method may be off beyond its noise, as a share of the light.
struct BiasAllowed {
    double in_all = 0;
    double in_cells = 0;  ///< of the cell's light and the picture's mean together
};

/// How far a method is from the reference.
struct CellGap {
    double whole;           ///< of the picture's mean, as a share of it
    std::size_t cells_off;  ///< beyond their noise and what is allowed
    bool holds;
    std::string text;
};

CellGap gap(const CellLight& found, const CellLight& truth, const BiasAllowed& allowed);

}  // namespace caustics::experiments
