#include "experiments/verify/cell_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace caustics::experiments {

namespace {

/// The cell that a pixel belongs to.
std::size_t cell_of(const Film& film, std::size_t pixel) {
    const auto w = static_cast<std::size_t>(film.width()),
               h = static_cast<std::size_t>(film.height());
    return pixel / w * CellLight::rows / h * CellLight::columns +
           pixel % w * CellLight::columns / w;
}

/// The means of one picture.
std::vector<double> means_of(const Film& film, const PixelMask& counted) {
    std::vector<double> sum(CellLight::cells + 1, 0.0), count(CellLight::cells + 1, 0.0);
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        if (!counted[i]) continue;
        for (const std::size_t cell : {cell_of(film, i), CellLight::cells}) {
            sum[cell] += static_cast<double>(film.rgb("caustic", i).mean());
            count[cell] += 1;
        }
    }
    for (std::size_t cell = 0; cell < sum.size(); ++cell)
        sum[cell] = count[cell] > 0 ? sum[cell] / count[cell] : 0;
    return sum;
}

Limit limit_of(std::size_t cell) { return cell == CellLight::cells ? whole_limit : cell_limit(); }

/// The error that a method may have beside the reference's, as a share: with it the difference can be judged, or
/// else the reference's error is what matters.
double wanted_error(std::size_t cell, double of_truth) {
    const double most = limit_of(cell).largest_error();
    return std::sqrt(std::max(most * most - of_truth * of_truth, of_truth * of_truth / 4));
}

}  // namespace

CellLight cell_light(const std::vector<Film>& films, const PixelMask& counted) {
    CellLight light;
    const auto n = static_cast<double>(films.size());
    std::vector<std::vector<double>> means;
    for (const Film& film : films) means.push_back(means_of(film, counted));
    for (std::size_t cell = 0; cell < light.mean.size(); ++cell) {
        for (const auto& one : means) light.mean[cell] += one[cell] / n;
        double squares = 0;
        for (const auto& one : means) squares += std::pow(one[cell] - light.mean[cell], 2);
        light.error[cell] = n > 1 ? std::sqrt(squares / (n - 1) / n) : 0;
    }
    return light;
}

Limit cell_limit() { return limit_of_part(whole_limit, CellLight::cells); }

bool CellGap::is_within() const {
    constexpr double rounding = 1e-5;
    if (is_black) return whole.value == 0 && cells_off == 0;
    return std::abs(whole.value) <= whole_limit.share &&
           std::abs(whole.value) <= Limit::errors * whole.error + rounding && cells_off == 0;
}

bool CellGap::can_judge() const {
    if (is_black) return true;
    return (whole_limit.can_judge(whole) && largest_cell_error <= cell_limit().largest_error()) ||
           whole_limit.is_exceeded(whole) || cell_limit().is_exceeded(worst_cell);
}

std::string CellGap::text() const {
    if (is_black)
        return fmt::format("the reference is black; {} of {} cells are not", cells_off,
                           CellLight::cells);
    return fmt::format("mean {:.4f} +- {:.4f} of it, {} of {} cells off by more than {:.1f} %",
                       1 + whole.value, whole.error, cells_off, CellLight::cells,
                       100 * cell_limit().share);
}

double excess_of_truth(const CellLight& truth) {
    const double mean = truth.mean[CellLight::cells];
    if (!(mean > 0)) return 1;
    double excess = 1;
    for (std::size_t cell = 0; cell <= CellLight::cells; ++cell) {
        const double wanted = limit_of(cell).largest_error() / 2 * std::max(truth.mean[cell], mean);
        excess = std::max(excess, truth.error[cell] / wanted);
    }
    return excess;
}

CellGap gap(const CellLight& found, const CellLight& truth) {
    constexpr std::size_t whole = CellLight::cells;
    const double mean = truth.mean[whole];
    CellGap gap;
    gap.is_black = !(mean > 0);
    for (std::size_t cell = 0; cell <= whole; ++cell) {
        const double unit = gap.is_black ? 1 : std::max(truth.mean[cell], mean);
        const Difference d{(found.mean[cell] - truth.mean[cell]) / unit,
                           std::hypot(found.error[cell], truth.error[cell]) / unit};
        if (!gap.is_black)
            gap.excess_of_found =
                std::max(gap.excess_of_found,
                         found.error[cell] / unit / wanted_error(cell, truth.error[cell] / unit));
        if (cell == whole) {
            gap.whole = d;
            continue;
        }
        gap.cells_off += std::abs(d.value) > (gap.is_black ? 0 : cell_limit().share) ? 1 : 0;
        gap.largest_cell_error = std::max(gap.largest_cell_error, d.error);
        if (std::abs(d.value) > std::abs(gap.worst_cell.value)) gap.worst_cell = d;
    }
    return gap;
}

}  // namespace caustics::experiments
