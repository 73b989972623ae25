#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/render/film.h"

namespace caustics::experiments {

/// Errors of a layer x against a reference r. All means run over the channels of the pixels that
/// are counted, in double and in the order of the pixels. Empty where a formula has no value:
/// nothing to count, or a reference without light.
struct Metrics {
    std::optional<double> rmse;         ///< sqrt(mean (x-r)^2) [of the layer]
    std::optional<double> relmse;       ///< mean (x-r)^2 / (r^2 + 0.01 mean(r)^2)
    std::optional<double> bias;         ///< mean(x-r) / mean(r)
    std::optional<double> mean_ratio;   ///< mean(x) / mean(r)
    std::optional<double> leak_energy;  ///< mean of x where r is exactly 0, over mean(r)
    std::size_t pixels = 0;             ///< counted
};

/// One line a metric, as tables and `compare` print them.
extern const char* const metric_formulas;

/// Which pixels of a picture are counted; one entry a pixel.
using PixelMask = std::vector<bool>;

/// The pixels that no `unreached` layer of the two films marks.
PixelMask reached_pixels(const Film& film, const Film& reference);
/// The counted pixels whose reference (mean of the channels) is at least its mean, so that a small
/// caustic is not diluted by the dark round it.
PixelMask bright_pixels(const Film& reference, const std::string& layer, const PixelMask& counted);
/// Share of the pixels that the mask counts.
double fraction(const PixelMask& mask);
/// Mean of a layer over the channels of the counted pixels; 0 when nothing is counted.
double mean(const Film& film, const std::string& layer, const PixelMask& counted);
PixelMask intersection(const PixelMask& a, const PixelMask& b);

/// Metrics of a layer ("" = beauty). Throws InputError when sizes differ, the layer is missing, or
/// a value is not finite (naming `name`, layer and pixel).
Metrics measure(const Film& film, const Film& reference, const std::string& layer,
                const PixelMask& counted);

/// Throws InputError naming the first pixel that is not finite of the layers that errors are taken of: beauty,
/// caustic and, where it is there, indirect; or the layer of the first two that is missing. `name` stands for
/// the picture.
void require_finite(const Film& film, const std::string& name);
/// The same of one layer.
void require_finite(const Film& film, const std::string& layer, const std::string& name);

/// The layer with the standard error of another: "stderr" of caustic, "indirect_stderr" of indirect; empty for
/// layers that have none.
std::string error_layer(const std::string& layer);

/// Standard error of a layer of a reference as a share of its mean: sqrt(mean s^2) / mean(r), s the standard
/// error of a pixel (error_layer). Empty without these layers, or without light.
std::optional<double> relative_standard_error(const Film& reference, const std::string& layer,
                                              const PixelMask& counted);

}  // namespace caustics::experiments
