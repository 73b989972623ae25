#include "core/render/camera_samples.h"

#include <cmath>

#include "core/math/sampling.h"

namespace caustics {

CameraSamples::CameraSamples(const Scene& scene, const RunOptions& options, int most)
    : scene_(scene),
      seed_(options.seed),
      per_pixel_(options.samples_per_pixel),
      most_(most),
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
        const int n = static_cast<int>(std::lround(std::sqrt(per_pixel_)));
        if (!sampling.jitter) u = v = 0.5;
        u = (sample % n + u) / n;
        v = (sample / n + v) / n;
    }
    return {x + u, y + v};
}

std::optional<double> CameraSamples::wavelength_choice(int x, int y, int sample) const {
    if (!disperses_) return {};
    Rng rng(seed_, Stage::wavelength, pixel_number(x, y));
    return radical_inverse<2>(static_cast<std::uint64_t>(sample), rng.next_fine());
}

}  // namespace caustics
