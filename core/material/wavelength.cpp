#include "core/material/wavelength.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace caustics {
namespace {

// A lobe with one width below its middle and another above.
double matching_lobe(double nm, double middle, double below, double above) {
    const double t = (nm - middle) / (nm < middle ? below : above);
    return std::exp(-0.5 * t * t);
}

// The densities but for their integrals.
SpectrumSum unscaled_density(double nm) {
    const double x = 1.056 * matching_lobe(nm, 599.8, 37.9, 31.0) +
                     0.362 * matching_lobe(nm, 442.0, 16.0, 26.7) -
                     0.065 * matching_lobe(nm, 501.1, 20.4, 26.2);
    const double y =
        0.821 * matching_lobe(nm, 568.8, 46.9, 40.5) + 0.286 * matching_lobe(nm, 530.9, 16.3, 31.1);
    const double z =
        1.217 * matching_lobe(nm, 437.0, 11.8, 36.0) + 0.681 * matching_lobe(nm, 459.0, 26.0, 13.8);
    const SpectrumSum rgb(3.2404542 * x - 1.5371385 * y - 0.4985314 * z,
                          -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
                          0.0556434 * x - 0.2040259 * y + 1.0572252 * z);
    return rgb.max(0);
}

/// Integrals of the densities over cells of wavelengths.
class SpectralTable {
public:
    static constexpr std::size_t cells = 1400;
    static constexpr std::size_t guides = 4096;
    static constexpr double width = (longest_wavelength - shortest_wavelength) / cells;

    SpectralTable() {
        cumulative_[0] = SpectrumSum::Zero();
        for (std::size_t i = 0; i < cells; ++i) cumulative_[i + 1] = cumulative_[i] + integral(i);
        scale_ = 1 / cumulative_.back();
        for (std::size_t i = 0; i <= cells; ++i) {
            cumulative_[i] *= scale_;
            power_[i] = cumulative_[i].mean();
            const SpectrumSum density = unscaled_density(edge(i)) * scale_;
            weight_[i] = density / density.mean();
        }
        power_.back() = 1;
        for (std::size_t i = 0, cell = 0; i < guides; ++i) {
            while (power_[cell + 1] * guides <= static_cast<double>(i)) ++cell;
            guide_[i] = static_cast<std::uint16_t>(cell);
        }
    }

    static double edge(std::size_t i) {
        return shortest_wavelength + width * static_cast<double>(i);
    }
    const SpectrumSum& scale() const { return scale_; }

    // The wavelength below which lies this share of the power.
    double wavelength_at(double power) const {
        std::size_t cell = guide_[std::min(static_cast<std::size_t>(power * guides), guides - 1)];
        while (cell + 1 < cells && power_[cell + 1] <= power) ++cell;
        const double share = (power - power_[cell]) / (power_[cell + 1] - power_[cell]);
        return edge(cell) + width * share;
    }
    // c_k over their mean.
    SpectrumSum weight_at(double nm) const {
        const Place p = place(nm);
        return (1 - p.share) * weight_[p.cell] + p.share * weight_[p.cell + 1];
    }
    // Integrals of c_k from the shortest wavelength on.
    SpectrumSum cumulative_at(double nm) const {
        const Place p = place(nm);
        return (1 - p.share) * cumulative_[p.cell] + p.share * cumulative_[p.cell + 1];
    }

private:
    struct Place {
        std::size_t cell;
        double share;
    };
    static Place place(double nm) {
        const double at = std::clamp((nm - shortest_wavelength) / width, 0.0, double{cells});
        const auto cell = std::min(static_cast<std::size_t>(at), cells - 1);
        return {cell, at - static_cast<double>(cell)};
    }
    // Simpson's rule.
    static SpectrumSum integral(std::size_t i) {
        const double from = edge(i);
        return width / 6 *
               (unscaled_density(from) + 4 * unscaled_density(from + width / 2) +
                unscaled_density(from + width));
    }

    std::array<SpectrumSum, cells + 1> cumulative_;
    std::array<double, cells + 1> power_;
    std::array<std::uint16_t, guides> guide_;  ///< by steps of power: a cell to search from
    std::array<SpectrumSum, cells + 1> weight_;
    SpectrumSum scale_;
};

const SpectralTable& table() {
    static const SpectralTable made;
    return made;
}

}  // namespace

SpectrumSum channel_density(double nm) {
    if (nm < shortest_wavelength || nm > longest_wavelength) return SpectrumSum::Zero();
    return unscaled_density(nm) * table().scale();
}

SampledWavelength sample_wavelength(double u) {
    const double nm = table().wavelength_at(u);
    return {static_cast<float>(nm), table().weight_at(nm).cast<float>()};
}

SpectrumSum channel_integral(double from, double to) {
    return table().cumulative_at(to) - table().cumulative_at(from);
}

std::vector<WavelengthBin> wavelength_bins(int count) {
    constexpr int parts = 64;  // of a bin, for its mean
    std::vector<WavelengthBin> bins;
    SpectrumSum before = SpectrumSum::Zero();
    for (int i = 0; i < count; ++i) {
        const auto share = [count](double at) { return at / count; };
        double mean = 0;
        for (int j = 0; j < parts; ++j)
            mean += table().wavelength_at(share(i + (j + 0.5) / parts)) / parts;
        const double to = table().wavelength_at(share(i + 1.0));
        const SpectrumSum to_here = table().cumulative_at(to);
        bins.push_back({static_cast<float>(mean),
                        bins.empty() ? float{shortest_wavelength} : bins.back().to,
                        static_cast<float>(to), (to_here - before).max(0).cast<float>()});
        before = to_here;
    }
    return bins;
}

}  // namespace caustics
