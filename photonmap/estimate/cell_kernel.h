#pragma once

#include "photonmap/estimate/density_filter.h"

namespace caustics::photonmap {

/// A photon's own kernel where it is averaged over a cell: the product of the filter's profile along the cell's two
/// sides, because the mean of such a product is one of differences of polynomials. Its scatter along each is that of
/// the filter over the photon's disc where the sides are square to each other; where they are not it is narrower, so
/// that it reaches no farther.
///
/// The shares of a photon's kernel on cells that cover the plane add up to 1, but for what the cells' sides turn from
/// one to the next within the kernel's width.
class CellKernel {
public:
    explicit CellKernel(const DensityFilter& filter);

    /// How far it reaches from the photon, over the disc's radius.
    double reach() const;
    /// Half of its width along the sides, whose angle has this cosine, over the disc's radius.
    double width(double cosine) const;
    /// What the kernels multiply by z (CellWeighingKernel).
    const FilterPolynomial& profile() const { return profile_; }

private:
    FilterPolynomial profile_;
    double width_;  ///< for a right angle
};

}  // namespace caustics::photonmap
