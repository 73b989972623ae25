#include "photonmap/estimate/shading.h"

#include <algorithm>
#include <array>
#include <bit>

#include "core/math/plane_axes.h"
#include "photonmap/photons/photon.h"

namespace caustics::photonmap {

namespace {

const ShadingKernels& kernels_for([[maybe_unused]] Isa isa) {
#ifdef CAUSTICS_X86_KERNELS
    if (isa == Isa::avx512) return avx512_shading;
    if (isa == Isa::avx2) return avx2_shading;
#endif
    return plain_shading;
}

SpectrumSum sum_by(ShadingKernel* kernel, const Lobe& lobe, const WeightedPhotons& all) {
    SpectrumSum sum = SpectrumSum::Zero();
    kernel(direction_tables(), lobe,
           {all.photons.energy, all.photons.direction, all.weight, all.photons.count, all.left_out},
           sum.data());
    return sum;
}

Rgbe energy_of(const GatheredPhotons& photons, std::size_t i) {
    return std::bit_cast<Rgbe>(photons.energy[i]);
}

DirectionCode direction_of(const GatheredPhotons& photons, std::size_t i) {
    return std::bit_cast<DirectionCode>(photons.direction[i]);
}

/// f_r by evaluate(), photon by photon.
SpectrumSum sum_evaluated(const ReceiverPoint& point, const WeightedPhotons& all) {
    SpectrumSum sum = SpectrumSum::Zero();
    for (std::size_t i = 0; i < all.photons.count; ++i) {
        if (i == all.left_out) continue;
        const DirectionCode code = direction_of(all.photons, i);
        const Spectrum reflection = evaluate(*point.bsdf, point.uv, point.shading_normal, point.wo,
                                             decode_direction(code.theta, code.phi));
        const Spectrum flux = decode_rgbe(energy_of(all.photons, i));
        const float weight = all.weight != nullptr ? all.weight[i] : 1.0F;
        sum += (reflection * flux * weight).cast<double>();
    }
    return sum;
}

/// Powers of two by an Rgbe's exponent: its mantissas' unit.
const std::array<float, 256> mantissa_units = [] {
    std::array<float, 256> units{};
    for (std::uint32_t e = 1; e < 255; ++e) units[e] = std::bit_cast<float>(e << 23U) * 0x1p-9F;
    return units;
}();

}  // namespace

Shading::Shading(Isa isa) : kernels_(kernels_for(isa)) {}

void Shading::weigh(const FilterPolynomial& filter, const GatheredPhotons& photons,
                    double squared_radius, float* weight) const {
    // Where photons fall into one point the radius may be too small for a float's reciprocal.
    constexpr auto smallest = static_cast<double>(std::numeric_limits<float>::min());
    const auto inverse = static_cast<float>(1 / std::max(squared_radius, smallest));
    kernels_.weigh(filter, {photons.squared_distance, photons.count, inverse, weight});
}

void Shading::weigh_on_square(const SquareKernel& square, const SquareKernel::Reach& reach,
                              const ReceiverPoint& point, const GatheredPhotons& photons,
                              float* weight) const {
    PhotonsOnSquare on{};
    std::ranges::copy(photons.position, on.position);
    on.count = photons.count;
    std::copy_n(point.position.data(), 3, on.centre);
    const PlaneAxes axes(point.geometric_normal.cast<double>());
    const Vec3 right = axes.right.cast<float>(), forward = axes.forward.cast<float>();
    std::copy_n(right.data(), 3, on.right);
    std::copy_n(forward.data(), 3, on.forward);
    on.half = static_cast<float>(reach.half);
    on.inverse_reach = static_cast<float>(1 / reach.reach);
    on.weight = weight;
    kernels_.weigh_on_square(square.profile(), on);
}

void Shading::weigh_discs(const FilterPolynomial& filter, const GatheredPhotons& photons,
                          float* weight) const {
    kernels_.weigh_discs(filter, {photons.squared_distance, photons.radius, photons.count, weight});
}

void Shading::weigh_on_cell(const CellKernel& kernel, const ReceiverPoint& point,
                            const GatheredPhotons& photons, float* weight) const {
    const PixelCell::Sides sides = photons.cell->sides();
    const Vec2d first = sides.first.normalized(), second = sides.second.normalized();
    const double cosine = first.dot(second), square = sides.sine * sides.sine;
    // The dual vectors of the two sides.
    const Vec2d across[2] = {(first - cosine * second) / square,
                             (second - cosine * first) / square};
    const double length[2] = {sides.first.norm(), sides.second.norm()};
    PhotonsOnCell on{};
    std::ranges::copy(photons.position, on.position);
    on.radius = photons.radius;
    on.count = photons.count;
    const Vec3 centre = point.position + photons.cell->at(sides.middle).cast<float>();
    std::copy_n(centre.data(), 3, on.centre);
    for (std::size_t side = 0; side < 2; ++side) {
        const Vec3 way = photons.cell->at(across[side]).cast<float>();
        std::copy_n(way.data(), 3, on.across[side]);
        on.half[side] = static_cast<float>(length[side] / 2);
        on.inverse_side[side] = static_cast<float>(1 / length[side]);
    }
    on.width = static_cast<float>(kernel.width(cosine));
    on.inverse_sine = static_cast<float>(1 / sides.sine);
    on.weight = weight;
    kernels_.weigh_on_cell(kernel.profile(), on);
}

SpectrumSum Shading::arriving(const WeightedPhotons& photons) const {
    return sum_by(kernels_.arriving, Lobe{}, photons);
}

SpectrumSum Shading::reflected(const ReceiverPoint& point, const WeightedPhotons& photons) const {
    const BrdfLobe reflection = reflection_of(point);
    const auto sum_of = [&](ShadingKernel* kernel) {
        return sum_by(kernel, reflection.lobe, photons);
    };
    // All photons are in front already where the normals are one.
    ShadingKernel* const facing =
        point.shading_normal == point.geometric_normal ? kernels_.arriving : kernels_.facing;
    switch (reflection.model) {
        case BrdfLobe::Model::lambert: return sum_of(facing) * reflection.scale;
        case BrdfLobe::Model::schlick: return sum_of(kernels_.schlick) * reflection.scale;
        case BrdfLobe::Model::phong: return sum_of(kernels_.phong) * reflection.scale;
        case BrdfLobe::Model::other: return sum_evaluated(point, photons);
        case BrdfLobe::Model::black: break;
    }
    return SpectrumSum::Zero();
}

SpectrumSum Shading::reflected(const ReceiverPoint& point, const WeightedPhotons& photons,
                               BrdfLobeTable& table) const {
    const BrdfLobe reflection = reflection_of(point);
    table.turn_to(point, reflection);
    SpectrumSum sum = SpectrumSum::Zero();
    for (std::size_t i = 0; i < photons.photons.count; ++i) {
        if (i == photons.left_out) continue;
        const DirectionCode wi = direction_of(photons.photons, i);
        const Rgbe energy = energy_of(photons.photons, i);
        const float* const factor =
            table.factor(static_cast<std::uint16_t>(wi.theta + 256 * wi.phi));
        const float weight = photons.weight != nullptr ? photons.weight[i] : 1.0F;
        const float unit = mantissa_units[energy.exponent] * weight;
        for (std::size_t c = 0; c < 3; ++c)
            sum[static_cast<Eigen::Index>(c)] +=
                static_cast<double>(factor[c] * unit * static_cast<float>(energy.mantissa[c]));
    }
    return sum * reflection.scale;
}

}  // namespace caustics::photonmap
