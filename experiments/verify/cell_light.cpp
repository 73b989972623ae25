#include "experiments/verify/cell_light.h"

#include <fmt/format.h>

#include <cmath>

namespace caustics::experiments {

namespace {

/// Errors by twelve seeds follow Student's law of eleven degrees: beyond six of them lies one cell in ten
/// thousand.
constexpr double widest = 6;

/// Which cell a pixel belongs to.
std::size_t cell_of(const Film& film, std::size_t pixel) {
    const auto w = static_cast<std::size_t>(film.width()),
               h = static_cast<std::size_t>(film.height());
    return pixel / w * CellLight::rows / h * CellLight::columns +
           pixel % w * CellLight::columns / w;
}

}  // namespace

CellLight cell_light(const std::vector<Film>& films, const PixelMask& counted) {
    CellLight light;
    const auto n = static_cast<double>(films.size());
    std::vector<std::vector<double>> means;
    for (const Film& film : films) {
        std::vector<double> sum(light.mean.size(), 0.0), count(light.mean.size(), 0.0);
        for (std::size_t i = 0; i < film.pixel_count(); ++i) {
            if (!counted[i]) continue;
            for (const std::size_t cell : {cell_of(film, i), sum.size() - 1}) {
                sum[cell] += static_cast<double>(film.rgb("caustic", i).mean());
                count[cell] += 1;
            }
        }
        for (std::size_t cell = 0; cell < sum.size(); ++cell)
            sum[cell] = count[cell] > 0 ? sum[cell] / count[cell] : 0;
        means.push_back(std::move(sum));
    }
    for (std::size_t cell = 0; cell < light.mean.size(); ++cell) {
        for (const auto& one : means) light.mean[cell] += one[cell] / n;
        double squares = 0;
        for (const auto& one : means) squares += std::pow(one[cell] - light.mean[cell], 2);
        light.error[cell] = n > 1 ? std::sqrt(squares / (n - 1) / n) : 0;
    }
    return light;
}

CellGap gap(const CellLight& found, const CellLight& truth, const BiasAllowed& allowed) {
    const std::size_t whole = truth.mean.size() - 1;
    const double mean = truth.mean[whole];
    std::size_t off = 0;
    for (std::size_t cell = 0; cell < whole; ++cell) {
        const double error = std::hypot(found.error[cell], truth.error[cell]);
        const double room = widest * error + allowed.in_cells * (truth.mean[cell] + mean);
        off += std::abs(found.mean[cell] - truth.mean[cell]) > room ? 1 : 0;
    }
    if (!(mean > 0))
        return {0, off, off == 0,
                fmt::format("the reference is black; {} of {} cells are not", off, whole)};
    const double error = std::hypot(found.error[whole], truth.error[whole]) / mean;
    const double miss = std::abs(found.mean[whole] / mean - 1);
    return {miss, off, off == 0 && miss <= widest * error + allowed.in_all,
            fmt::format("mean {:.4f} +- {:.4f} of it, {} of {} cells off", found.mean[whole] / mean,
                        error, off, whole)};
}

}  // namespace caustics::experiments
