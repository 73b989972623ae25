#include "experiments/picture/metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace caustics::experiments {

const char* const metric_formulas =
    "over the channels of all counted pixels, r the reference:\n"
    "  rmse        = sqrt(mean (x-r)^2)\n"
    "  relmse      = mean (x-r)^2 / (r^2 + 0.01 mean(r)^2)\n"
    "  bias        = mean(x-r) / mean(r)\n"
    "  mean_ratio  = mean(x) / mean(r)\n"
    "  leak_energy = mean of x where r is exactly 0, over mean(r)\n";

namespace {

std::string layer_name(const std::string& layer) { return layer.empty() ? "beauty" : layer; }

void require_comparable(const Film& film, const Film& reference, const std::string& layer) {
    if (film.width() != reference.width() || film.height() != reference.height())
        throw InputError(fmt::format("the picture has {}x{} pixels, the reference {}x{}",
                                     film.width(), film.height(), reference.width(),
                                     reference.height()));
    for (const Film* each : {&film, &reference})
        if (!each->has_layer(layer))
            throw InputError(fmt::format("no layer \"{}\" in the {}", layer_name(layer),
                                         each == &film ? "picture" : "reference"));
    require_finite(film, layer, "picture");
    require_finite(reference, layer, "reference");
}

}  // namespace

double mean(const Film& film, const std::string& layer, const PixelMask& counted) {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < counted.size(); ++i) {
        if (!counted[i]) continue;
        const SpectrumSum value = film.rgb(layer, i).cast<double>();
        sum += value.sum();
        count += 3;
    }
    return count == 0 ? 0 : sum / static_cast<double>(count);
}

PixelMask reached_pixels(const Film& film, const Film& reference) {
    PixelMask reached(reference.pixel_count(), true);
    for (const Film* each : {&film, &reference}) {
        const std::vector<float>* const unreached = each->find("unreached.Y");
        if (unreached == nullptr) continue;
        for (std::size_t i = 0; i < std::min(reached.size(), unreached->size()); ++i)
            if ((*unreached)[i] != 0) reached[i] = false;
    }
    return reached;
}

PixelMask bright_pixels(const Film& reference, const std::string& layer, const PixelMask& counted) {
    const double threshold = mean(reference, layer, counted);
    PixelMask bright(counted.size(), false);
    for (std::size_t i = 0; i < counted.size(); ++i) {
        if (!counted[i]) continue;
        const SpectrumSum value = reference.rgb(layer, i).cast<double>();
        bright[i] = value.sum() > 0 && value.sum() / 3 >= threshold;
    }
    return bright;
}

double fraction(const PixelMask& mask) {
    if (mask.empty()) return 0;
    return static_cast<double>(std::ranges::count(mask, true)) / static_cast<double>(mask.size());
}

PixelMask intersection(const PixelMask& a, const PixelMask& b) {
    PixelMask both(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) both[i] = a[i] && b[i];
    return both;
}

Metrics measure(const Film& film, const Film& reference, const std::string& layer,
                const PixelMask& counted) {
    require_comparable(film, reference, layer);
    const double mean_r = mean(reference, layer, counted);
    const double mean_x = mean(film, layer, counted);
    const double epsilon = 0.01 * mean_r * mean_r;

    Metrics metrics;
    double squares = 0;
    double relative_squares = 0;
    double leak = 0;
    std::size_t dark = 0;
    for (std::size_t i = 0; i < counted.size(); ++i) {
        if (!counted[i]) continue;
        ++metrics.pixels;
        const SpectrumSum x = film.rgb(layer, i).cast<double>();
        const SpectrumSum r = reference.rgb(layer, i).cast<double>();
        for (int c = 0; c < 3; ++c) {
            const double square = (x[c] - r[c]) * (x[c] - r[c]);
            squares += square;
            if (epsilon > 0) relative_squares += square / (r[c] * r[c] + epsilon);
            if (r[c] == 0) {
                leak += x[c];
                ++dark;
            }
        }
    }
    if (metrics.pixels == 0) return metrics;
    const double values = 3 * static_cast<double>(metrics.pixels);
    metrics.rmse = std::sqrt(squares / values);
    if (!(epsilon > 0)) return metrics;
    metrics.relmse = relative_squares / values;
    metrics.bias = (mean_x - mean_r) / mean_r;
    metrics.mean_ratio = mean_x / mean_r;
    if (dark > 0) metrics.leak_energy = leak / static_cast<double>(dark) / mean_r;
    return metrics;
}

void require_finite(const Film& film, const std::string& name) {
    for (const char* const layer : {"", "caustic", "indirect"}) {
        const bool there = film.has_layer(layer);
        if (!there && layer == std::string("indirect")) continue;
        if (!there) throw InputError(fmt::format("{}: no layer \"{}\"", name, layer_name(layer)));
        require_finite(film, layer, name);
    }
}

void require_finite(const Film& film, const std::string& layer, const std::string& name) {
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        if (is_finite(film.rgb(layer, i))) continue;
        const std::size_t width = static_cast<std::size_t>(film.width());
        throw InputError(fmt::format("{}: layer \"{}\" is not finite at pixel ({}, {})", name,
                                     layer_name(layer), i % width, i / width));
    }
}

std::string error_layer(const std::string& layer) {
    if (layer == "caustic") return "stderr";
    return layer == "indirect" ? "indirect_stderr" : "";
}

std::optional<double> relative_standard_error(const Film& reference, const std::string& layer,
                                              const PixelMask& counted) {
    const std::string errors = error_layer(layer);
    if (errors.empty() || !reference.has_layer(layer)) return {};
    const std::vector<float>* const grey = reference.find(errors + ".Y");
    if (grey == nullptr && !reference.has_layer(errors)) return {};
    const double mean_r = mean(reference, layer, counted);
    if (!(mean_r > 0)) return {};
    double squares = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < counted.size(); ++i) {
        if (!counted[i]) continue;
        ++count;
        if (grey != nullptr) {
            squares += static_cast<double>((*grey)[i]) * static_cast<double>((*grey)[i]);
        } else {
            const SpectrumSum s = reference.rgb(errors, i).cast<double>();
            squares += s.square().sum() / 3;
        }
    }
    return std::sqrt(squares / static_cast<double>(count)) / mean_r;
}

}  // namespace caustics::experiments
