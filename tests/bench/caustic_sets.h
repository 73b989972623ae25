#pragma once

#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "photonmap/photons/photon.h"

namespace caustics::bench {

/// Two caustics on a floor at z = 0, whose front faces up.
enum class Caustic {
    water,  ///< (a) a point light above a surface of six sines: folds all over the floor
    ball    ///< (b) an oblique point light and a glass ball: one sharp spot, much of it dark
};
const char* name(Caustic caustic);

/// In which order photons arrive: that of their aim points on the casters' bound.
enum class Arrival {
    random,
    shuffled_strata,  ///< a point in each cell of a grid, cells in random order
    r2,               ///< the R2 sequence [Roberts 2018], of low discrepancy
    scanline_strata   ///< a point in each cell of a grid, row by row
};
const char* name(Arrival arrival);

/// The receiver's rectangle [m]: x and y from -half to half.
double floor_half(Caustic caustic);

/// Casters are meshes, of 33 k (water) and 65 k triangles (ball).
SceneDesc caustic_scene(Caustic caustic);

/// `count` photons in their order of arrival, traced by the project's own light paths.
std::vector<photonmap::Photon> caustic_photons(Caustic caustic, Arrival arrival, std::size_t count);

/// Where a picture's queries lie: points of the floor seen from straight above.
struct Queries {
    std::vector<float> points;  ///< x, y, z, row by row
    int width = 0;              ///< points a row
    std::size_t size() const { return points.size() / 3; }
    const float* operator[](std::size_t i) const { return &points[3 * i]; }
};

/// Rows of a picture of width x height points over the floor: `bands` bands, evenly spaced, of
/// `band_rows` rows each, one after another.
Queries scanlines(Caustic caustic, int width, int height, int bands, int band_rows);

/// Maximum radius of a search for k of n photons [m]: 3 sqrt(k A / (pi n)), A the floor's area.
float max_radius(Caustic caustic, std::size_t k, std::size_t n);

}  // namespace caustics::bench
