#pragma once

#include <stddef.h>
#include <stdint.h>

#include "photonmap/photons/direction_tables.h"

namespace caustics::photonmap {

/// One receiver point's reflection as the kernels take it: f_r about the shading normal, seen from
/// `wo`, divided by the reflectance. The two tangents complete the normal to a frame.
struct Lobe {
    float normal[3];
    float tangent[3];
    float bitangent[3];
    float wo[3];
    float cosine;       ///< v = n.wo of [J96 (5)], > 0
    float alpha;        ///< of Schlick's model
    float mirrored[3];  ///< of Phong's: wo about the normal
    float exponent;     ///< of Phong's
    float diffuse[3];   ///< of Phong's: the part that is the same for all directions
    float specular[3];  ///< of Phong's: the part that the power of the cosine multiplies
};

/// A run of gathered photons; arrays as in GatheredPhotons.
struct ShadedPhotons {
    const uint32_t* energy;
    const uint16_t* direction;
    const float* weight;  ///< a factor for each photon; null: 1
    size_t count;
    size_t left_out;  ///< index of a photon that does not count; `count` or more: none
};

/// Adds to rgb[3] the sum over photons of energy x weight x
///   `arriving`: 1;
///   `facing`: 1 where n.wi > 0, else 0 (Lambert's law but for the factor 1/pi);
///   `schlick`: pi f_r (alpha + (1 - alpha) v) / alpha by [J96 (5)], [J96 (6)] where n.wi > 0, else 0;
///   `phong`: diffuse + specular x cos^exponent of the angle to the mirrored direction where n.wi > 0, else 0.
///
/// n.wi is rounded step by step as `evaluate(bsdf, ...)` does it, so that all agree on which photons
/// count. Eight sums in double, each of every eighth photon, are added up by halves: the same bits on every
/// instruction set, and, once rounded to float, but for one case in some 10^8 in any order of the photons.
using ShadingKernel = void(const DirectionTables& tables, const Lobe& lobe,
                           const ShadedPhotons& photons, double* rgb);

/// A filter's weight as a polynomial of (d/r)^2, or of d/r where `of_distance`.
struct FilterPolynomial {
    static constexpr size_t most_coefficients = 16;
    float coefficient[most_coefficients];  ///< of the powers 0, 1, ..., degree
    size_t degree;
    bool of_distance;
};

/// Photons whose weights are wanted. Arrays as in GatheredPhotons.
struct FilteredPhotons {
    const float* squared_distance;
    size_t count;
    float inverse_squared_radius;
    float* weight;
};

/// Writes the photons' weights, by Horner's rule; the same bits on every instruction set.
using WeighingKernel = void(const FilterPolynomial& filter, const FilteredPhotons& photons);

/// Photons whose weights on a square are wanted. Arrays as in GatheredPhotons.
struct PhotonsOnSquare {
    const float* position[3];
    size_t count;
    float centre[3];
    float right[3], forward[3];  ///< unit, along the square's sides
    float half;                  ///< of a side [m]
    float inverse_reach;         ///< of half the kernel's width [1/m]
    float* weight;
};

/// Writes the photons' weights: along each side the integral of the kernel over the square, the product of both
/// (square_kernel.h). `profile` times z is the kernel's integral from its middle to z, z = 1 being its end;
/// a polynomial of z^2, or of |z| where `of_distance`. The same bits on every instruction set.
using SquareWeighingKernel = void(const FilterPolynomial& profile, const PhotonsOnSquare& photons);

/// Photons with a disc each whose weights at a point are wanted. Arrays as in GatheredPhotons.
struct PhotonsWithDiscs {
    const float* squared_distance;
    const float* radius;  ///< of the discs [m]
    size_t count;
    float* weight;
};

/// Writes the photons' weights [1/m^2]: the filter's over pi radius^2. The same bits on every instruction set.
using DiscWeighingKernel = void(const FilterPolynomial& filter, const PhotonsWithDiscs& photons);

/// Photons with a kernel of their own whose mean over a cell is wanted. The cell is a parallelogram; coordinates run
/// along its two sides, from its middle [m]. Arrays as in GatheredPhotons.
struct PhotonsOnCell {
    const float* position[3];
    const float* radius;  ///< of the photons' discs [m]
    size_t count;
    float centre[3];
    float across[2][3];     ///< a position's product with these is its coordinate
    float half[2];          ///< of the sides [m]
    float inverse_side[2];  ///< [1/m]
    float width;            ///< half of the kernel's width over the disc's radius
    float inverse_sine;     ///< of the angle between the sides
    float* weight;
};

/// Writes the photons' weights [1/m^2]: the share of their kernel that lies on the cell, over the cell's area
/// (cell_kernel.h). `profile` as in SquareWeighingKernel. The same bits on every instruction set.
using CellWeighingKernel = void(const FilterPolynomial& profile, const PhotonsOnCell& photons);

struct ShadingKernels {
    ShadingKernel* arriving;
    ShadingKernel* facing;
    ShadingKernel* schlick;
    ShadingKernel* phong;
    WeighingKernel* weigh;
    SquareWeighingKernel* weigh_on_square;
    DiscWeighingKernel* weigh_discs;
    CellWeighingKernel* weigh_on_cell;
};

extern const ShadingKernels plain_shading;
extern const ShadingKernels avx2_shading;
extern const ShadingKernels avx512_shading;

/// What `schlick` multiplies a photon's energy by.
float schlick_factor(const DirectionTables& tables, const Lobe& lobe, uint8_t theta, uint8_t phi);
/// Writes what `phong` multiplies a photon's energy by, channel by channel.
void phong_factors(const DirectionTables& tables, const Lobe& lobe, uint8_t theta, uint8_t phi,
                   float* rgb);
/// What `facing` multiplies a photon's energy by.
float facing_factor(const DirectionTables& tables, const Lobe& lobe, uint8_t theta, uint8_t phi);

}  // namespace caustics::photonmap
