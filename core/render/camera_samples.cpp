#include "core/render/camera_samples.h"

#include <algorithm>
#include <cmath>

#include "core/math/sampling.h"

namespace caustics {

namespace {

// Of samples in rows and columns: as nearly as many of both as their number allows.
int columns_of(int samples) {
    int columns = std::max(1, static_cast<int>(std::lround(std::sqrt(samples))));
    while (samples % columns != 0) --columns;
    return columns;
}

}  // namespace

CameraSamples::CameraSamples(const Scene& scene, const RunOptions& options, int most)
    : scene_(scene),
      seed_(options.seed),
      per_pixel_(options.samples_per_pixel),
      columns_(columns_of(per_pixel_)),
      most_(most),
      adaptive_(options.adaptive && scene.sampling().max_sample_count > 0),
      disperses_(disperses(scene)) {}

std::uint64_t CameraSamples::pixel_number(int x, int y) const {
    return static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(scene_.camera().width) +
           static_cast<std::uint64_t>(x);
}

std::uint64_t CameraSamples::id(int x, int y, int sample) const {
    return pixel_number(x, y) * static_cast<std::uint64_t>(most_) +
           static_cast<std::uint64_t>(sample);
}

Vec2d CameraSamples::film_point(int x, int y, int sample, Rng& rng) const {
    double u = static_cast<double>(rng.next());
    double v = static_cast<double>(rng.next());
    const PixelSampling& sampling = scene_.sampling();
    if (sampling.stratified) {
        const int n = columns_;
        if (!sampling.jitter) u = v = 0.5;
        u = (sample % n + u) / n;
        v = (sample / n + v) / n;
    }
    if (adaptive_) return Vec2d(x, y) + sequence_point(x, y, sample);
    return {x + u, y + v};
}

Eigen::AlignedBox2d CameraSamples::film_cell(int x, int y, int sample) const {
    const Vec2d pixel(x, y);
    if (adaptive_) return {pixel, pixel + Vec2d::Ones()};
    const Vec2d size(1.0 / columns_, static_cast<double>(columns_) / per_pixel_);
    const Vec2d low = pixel + Vec2d(sample % columns_, sample / columns_).cwiseProduct(size);
    return {low, low + size};
}

Vec2d CameraSamples::sequence_point(int x, int y, int sample) const {
    // The words that place the first sample also turn over the digits of all others.
    Rng rng(seed_, Stage::eye, id(x, y, 0));
    std::uint32_t across = rng.next_word(), down = rng.next_word();
    std::uint32_t mirrored = 1U << 31U, column = 1U << 31U;
    for (auto digits = static_cast<std::uint32_t>(sample); digits != 0; digits >>= 1U) {
        if ((digits & 1U) != 0) {
            across ^= mirrored;
            down ^= column;
        }
        mirrored >>= 1U;
        column ^= column >> 1U;
    }
    return {across * 0x1p-32, down * 0x1p-32};
}

std::optional<double> CameraSamples::wavelength_choice(int x, int y, int sample) const {
    if (!disperses_) return {};
    Rng rng(seed_, Stage::wavelength, pixel_number(x, y));
    return radical_inverse<2>(static_cast<std::uint64_t>(sample), rng.next_fine());
}

}  // namespace caustics
