#pragma once

#include <cstdint>
#include <optional>

#include "core/caustic_estimator.h"
#include "core/math/rng.h"
#include "core/scene/scene.h"

namespace caustics {

/// Where the camera samples of a picture lie, the same for every method: their points of the film, their
/// wavelengths and their numbers.
class CameraSamples {
public:
    /// No pixel takes more than `most` samples.
    CameraSamples(const Scene& scene, const RunOptions& options, int most);

    int most() const { return most_; }
    std::uint64_t pixel_number(int x, int y) const;
    std::uint64_t id(int x, int y, int sample) const;
    /// The film point of a sample, in pixels (Mitsuba's samplers; [C11] with two numbers an axis). Adaptive samples
    /// follow a (0, 2)-sequence [Sobol 1967], scrambled at random in every pixel: with each doubling they
    /// fill the cells of all grids of so many cells, one in each.
    Vec2d film_point(int x, int y, int sample, Rng& rng) const;
    /// The part of the film that the sample stands for, in pixels: its stratum; of random samples, one of as many equal
    /// rectangles as there are samples; of adaptive ones, the whole pixel.
    Eigen::AlignedBox2d film_cell(int x, int y, int sample) const;
    /// The number of [0, 1) that chooses a sample's wavelength; none where no glass disperses. Spread over the
    /// pixel's samples (van der Corput), and at random over the pixels: few samples have all colours.
    std::optional<double> wavelength_choice(int x, int y, int sample) const;

private:
    Vec2d sequence_point(int x, int y, int sample) const;

    const Scene& scene_;
    std::uint64_t seed_;
    int per_pixel_;
    int columns_;
    int most_;
    bool adaptive_;
    bool disperses_;
};

}  // namespace caustics
