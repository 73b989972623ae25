#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "beamtree/rest/leaf_heap.h"
#include "beamtree/rest/rest_photon.h"
#include "core/receiver_point.h"

namespace caustics::beamtree {

/// The light that photons bring to points. Each lights a disc that reaches to its `nearest`th neighbour, by Epanechnikov's
/// kernel: an adaptive kernel estimate whose widths belong to the samples (Abramson 1982), so that all of a photon's
/// flux arrives on a plane, and a query only adds up the discs it is in. Photons and points count for each other where
/// their surfaces face alike (same_surface.h).
class PhotonDiscs {
public:
    PhotonDiscs() = default;
    /// A photon without a neighbour has no disc. On up to `threads` threads.
    PhotonDiscs(std::vector<RestPhoton> photons, std::uint32_t nearest, int threads);

    bool is_empty() const { return photons_.empty(); }
    std::uint64_t bytes() const;
    /// [W m^-2] on the side of the geometric normal. `stack` is scratch.
    Spectrum irradiance(const ReceiverPoint& point, std::vector<std::uint32_t>& stack) const;
    /// [W m^-2 sr^-1] along the point's `wo`.
    Spectrum radiance(const ReceiverPoint& point, std::vector<std::uint32_t>& stack) const;

private:
    static constexpr std::size_t leaf_size = 8;
    /// Discs of a leaf, side by side; places that are left over have no width.
    struct Leaf {
        std::array<float, leaf_size> x{};
        std::array<float, leaf_size> y{};
        std::array<float, leaf_size> z{};
        std::array<float, leaf_size> squared_radius{};
    };

    std::size_t first_of(std::size_t leaf) const {
        return first_of_leaf(leaf, photons_.size(), leaves_.size());
    }
    void find_widths(std::uint32_t nearest, int threads);
    void bound_discs();
    template <typename Weight>
    void add_leaf(std::size_t leaf, const ReceiverPoint& point, const Weight& weight,
                  SpectrumSum& sum) const;
    template <typename Weight>
    Spectrum sum(const ReceiverPoint& point, std::vector<std::uint32_t>& stack,
                 const Weight& weight) const;

    std::vector<RestPhoton> photons_;  ///< leaf by leaf
    std::vector<Leaf> leaves_;         ///< a power of two
    std::vector<Box> boxes_;           ///< of discs (leaf_heap.h)
};

}  // namespace caustics::beamtree
