#include "core/render/film_layers.h"

#include <stdexcept>

namespace caustics {

SpectrumSum PixelSums::variance_of_mean(const SpectrumSum& sum, const SpectrumSum& squares) const {
    if (samples < 2) return SpectrumSum::Zero();
    const double n = samples;
    return (squares / n - (sum / n).square()).max(0) / (n - 1);
}

FilmLayers::FilmLayers(Film& film, const Extra& extra)
    : film_(film),
      beauty_(rgb("")),
      direct_(rgb("direct")),
      specular_(rgb("specular")),
      caustic_(rgb("caustic")),
      albedo_(rgb("albedo")),
      normal_{film.plane("normal.X").data(), film.plane("normal.Y").data(),
              film.plane("normal.Z").data()},
      depth_(film.plane("depth.Z").data()) {
    if (extra.unreached) unreached_ = film.plane("unreached.Y").data();
    if (extra.standard_error) standard_error_ = rgb("stderr");
    if (extra.ambient) ambient_ = rgb("ambient");
    if (extra.indirect) indirect_ = rgb("indirect");
    if (extra.indirect_error) indirect_error_ = rgb("indirect_stderr");
    if (extra.samples) samples_ = film.plane("samples.Y").data();
}

FilmLayers::Layer FilmLayers::rgb(const std::string& name) {
    const std::string prefix = name.empty() ? "" : name + ".";
    return {name,
            {film_.plane(prefix + "R").data(), film_.plane(prefix + "G").data(),
             film_.plane(prefix + "B").data()}};
}

void FilmLayers::put(const Layer& layer, std::size_t pixel, const SpectrumSum& value) const {
    const Spectrum stored = value.cast<float>();
    if (!is_finite(stored)) {
        const auto width = static_cast<std::size_t>(film_.width());
        throw std::runtime_error("pixel (" + std::to_string(pixel % width) + ", " +
                                 std::to_string(pixel / width) + "): layer " + layer.name +
                                 " is not finite");
    }
    for (int channel = 0; channel < 3; ++channel)
        layer.planes[static_cast<std::size_t>(channel)][pixel] = stored[channel];
}

void FilmLayers::write(std::size_t pixel, const PixelSums& sums) {
    const double n = sums.samples;
    put(direct_, pixel, sums.direct / n);
    put(specular_, pixel, sums.emitted / n);
    put(caustic_, pixel, sums.caustic / n);
    if (!ambient_.name.empty()) put(ambient_, pixel, sums.ambient / n);
    if (!indirect_.name.empty()) put(indirect_, pixel, sums.indirect / n);
    put(albedo_, pixel, sums.albedo / n);
    const Vec3d normal = sums.normal / n;
    for (int axis = 0; axis < 3; ++axis)
        normal_[static_cast<std::size_t>(axis)][pixel] = static_cast<float>(normal[axis]);
    if (sums.hits > 0) depth_[pixel] = static_cast<float>(sums.depth / sums.hits);
    if (unreached_ != nullptr) unreached_[pixel] = static_cast<float>(sums.through_caster / n);
    if (samples_ != nullptr) samples_[pixel] = static_cast<float>(sums.samples);
    // Several samples tell the error by their scatter, a single one only by its own paths'.
    const bool scatter = sums.samples > 1;
    if (!standard_error_.name.empty())
        put(standard_error_, pixel,
            (scatter ? sums.variance_of_mean(sums.caustic, sums.caustic_squares)
                     : sums.own_variance)
                .sqrt());
    if (!indirect_error_.name.empty())
        put(indirect_error_, pixel,
            (scatter ? sums.variance_of_mean(sums.indirect, sums.indirect_squares)
                     : sums.indirect_own_variance)
                .sqrt());
}

void FilmLayers::write_caustic(std::size_t pixel, const Spectrum& radiance,
                               const Spectrum& standard_error) {
    put(caustic_, pixel, radiance.cast<double>());
    put(standard_error_, pixel, standard_error.cast<double>());
}

void FilmLayers::write_indirect(std::size_t pixel, const Spectrum& radiance,
                                const Spectrum& standard_error) {
    put(indirect_, pixel, radiance.cast<double>());
    put(indirect_error_, pixel, standard_error.cast<double>());
}

void FilmLayers::sum_beauty() {
    for (std::size_t channel = 0; channel < 3; ++channel)
        for (std::size_t pixel = 0; pixel < film_.pixel_count(); ++pixel)
            beauty_.planes[channel][pixel] = direct_.planes[channel][pixel] +
                                             caustic_.planes[channel][pixel] +
                                             specular_.planes[channel][pixel];
    for (const Layer* const layer : {&ambient_, &indirect_}) {
        if (layer->name.empty()) continue;
        for (std::size_t channel = 0; channel < 3; ++channel)
            for (std::size_t pixel = 0; pixel < film_.pixel_count(); ++pixel)
                beauty_.planes[channel][pixel] += layer->planes[channel][pixel];
    }
}

}  // namespace caustics
