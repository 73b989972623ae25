#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "beamtree/beams/light_sample.h"
#include "beamtree/pencils/pencil_print.h"
#include "beamtree/pencils/pencil_window.h"
#include "beamtree/rest/leaf_heap.h"
#include "core/receiver_point.h"

namespace caustics::beamtree {

/// The light that pencils bring to points: that of the prints that lie on a point, or on its cell (ReceiverPoint::cell),
/// each by the part of it that does. A print's rays count off its plane as well, on surfaces that are not flat up to a part
/// of its size, so that a rough one has them by its own slope.
class PencilMap {
public:
    PencilMap() = default;
    /// On up to `threads` threads. `lights` are those that the prints name.
    PencilMap(std::vector<PencilPrint> prints, std::span<const LightSample> lights, int threads);

    bool is_empty() const { return prints_.empty(); }
    std::uint64_t bytes() const;
    /// [W m^-2] on the side of the geometric normal. `stack` is scratch.
    Spectrum irradiance(const ReceiverPoint& point, std::vector<std::uint32_t>& stack) const;
    /// [W m^-2 sr^-1] along the point's `wo`.
    Spectrum radiance(const ReceiverPoint& point, std::vector<std::uint32_t>& stack) const;

private:
    static constexpr std::size_t leaf_size = 8;
    /// A leaf's prints side by side; places that are left over have a height below 0.
    struct Leaf {
        using Row = std::array<float, leaf_size>;
        std::array<Row, 3> position{};
        std::array<Row, 3> normal{};
        /// Times what leads from the position: a point's numbers along the sides of a print, -1/2 to 1/2 on it.
        std::array<std::array<Row, 3>, 2> by_side{};
        std::array<Row, 2> by_metre{};  ///< their lengths [1/m]
        Row height{};                   ///< how far off its plane its rays count, to both sides [m]
        Row area{};                     ///< across the rays [m^2]
    };

    std::size_t first_of(std::size_t leaf) const {
        return first_of_leaf(leaf, prints_.size(), leaves_.size());
    }
    void shorten_prints(int threads);
    void place_prints(int threads);
    static Box place(Leaf& leaf, std::size_t k, const PencilPrint& print);
    template <typename Weight>
    void add_leaf(std::size_t leaf, const ReceiverPoint& point, const PencilWindow& window,
                  const Weight& weight, SpectrumSum& sum) const;
    template <typename Weight>
    Spectrum sum(const ReceiverPoint& point, std::vector<std::uint32_t>& stack,
                 const Weight& weight) const;

    std::vector<PencilPrint> prints_;  ///< leaf by leaf
    std::vector<WavelengthBin> bins_;  ///< one a light
    std::vector<Leaf> leaves_;         ///< a power of two
    std::vector<Box> boxes_;           ///< of prints (leaf_heap.h)
};

}  // namespace caustics::beamtree
