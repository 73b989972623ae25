#pragma once

#include <limits>

#include "core/caustic_estimator.h"
#include "photonmap/estimate/brdf_lobe_table.h"
#include "photonmap/estimate/cell_kernel.h"
#include "photonmap/estimate/square_kernel.h"
#include "photonmap/tree/gathered_photons.h"

namespace caustics::photonmap {

/// Gathered photons and how much each counts.
struct WeightedPhotons {
    static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

    GatheredPhotons photons;
    const float* weight = nullptr;  ///< a factor for each photon, padded as they are; null: 1
    std::size_t left_out = none;    ///< index of a photon that does not count
};

/// Sums over gathered photons, the numerator of [J96 (4)]. Directions are decoded at the centres
/// of their cells, energies exactly. The order of summation is fixed; the same
/// bits on every instruction set.
class Shading {
public:
    explicit Shading(Isa isa);

    /// Weights of photons in a disc of that squared radius [m^2], padded as they are.
    void weigh(const FilterPolynomial& filter, const GatheredPhotons& photons,
               double squared_radius, float* weight) const;

    /// Weights of photons on the square round the point, on its tangent plane along PlaneAxes; over 1 / (2 s)^2.
    void weigh_on_square(const SquareKernel& square, const SquareKernel::Reach& reach,
                         const ReceiverPoint& point, const GatheredPhotons& photons,
                         float* weight) const;

    /// Weights [1/m^2] at a point that lies on the photons' own discs.
    void weigh_discs(const FilterPolynomial& filter, const GatheredPhotons& photons,
                     float* weight) const;

    /// Weights [1/m^2] on the photons' cell, of photons with discs of their own.
    void weigh_on_cell(const CellKernel& kernel, const ReceiverPoint& point,
                       const GatheredPhotons& photons, float* weight) const;

    /// Sum of flux x weight, in the map's unit of flux.
    SpectrumSum arriving(const WeightedPhotons& photons) const;

    /// Sum of f_r(wo, wi) x flux x weight [1/sr], f_r about the point's shading normal and 0 when wo
    /// or wi is below it. The photons must have arrived on the side of its geometric normal.
    /// Lambert's, Schlick's and Phong's laws have kernels; Phong's classic one is evaluated photon by photon.
    SpectrumSum reflected(const ReceiverPoint& point, const WeightedPhotons& photons) const;

    /// The same by a table of f_r, one photon after another.
    SpectrumSum reflected(const ReceiverPoint& point, const WeightedPhotons& photons,
                          BrdfLobeTable& table) const;

private:
    const ShadingKernels& kernels_;
};

}  // namespace caustics::photonmap
