#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "beamtree/beams/light_sample.h"
#include "beamtree/pencils/pencil_leaf.h"
#include "beamtree/pencils/pencil_print.h"
#include "beamtree/rest/leaf_heap.h"
#include "core/base/isa.h"
#include "core/receiver_point.h"

namespace caustics::beamtree {

/// The kernels of an instruction set.
const PencilKernels& pencil_kernels(Isa isa);
/// The query of a point's cell, or of the point alone where it has no cell with an area.
PencilQuery pencil_query(const ReceiverPoint& point);

/// The light that pencils bring to points: that of the prints that lie on a point, or on its cell (ReceiverPoint::cell),
/// each by the part of it that does. A print's rays count off its plane as well, on surfaces that are not flat up to a part
/// of its size, so that a rough one has them by its own slope.
class PencilMap {
public:
    PencilMap() = default;
    /// On up to `threads` threads. `lights` are those that the prints name. All instruction sets give the same bits.
    PencilMap(std::vector<PencilPrint> prints, std::span<const LightSample> lights, Isa isa,
              int threads);

    bool is_empty() const { return count_ == 0; }
    std::uint64_t bytes() const;
    /// [W m^-2] on the side of the geometric normal. `stack` is scratch.
    Spectrum irradiance(const ReceiverPoint& point, std::vector<std::uint32_t>& stack) const;
    /// [W m^-2 sr^-1] along the point's `wo`.
    Spectrum radiance(const ReceiverPoint& point, std::vector<std::uint32_t>& stack) const;

private:
    std::size_t first_of(std::size_t leaf) const {
        return first_of_leaf(leaf, count_, leaves_.size());
    }
    void shorten_prints(std::vector<PencilPrint>& prints, std::span<const LightSample> lights,
                        int threads) const;
    void place_prints(const std::vector<PencilPrint>& prints, int threads);
    template <typename Take>
    void for_each_touched(const PencilQuery& query, std::vector<std::uint32_t>& stack,
                          const Take& take) const;
    template <typename Weight>
    Spectrum sum(const ReceiverPoint& point, std::vector<std::uint32_t>& stack,
                 const Weight& weight) const;

    const PencilKernels* kernels_ = nullptr;
    std::size_t count_ = 0;            ///< of prints
    std::vector<WavelengthBin> bins_;  ///< one a light
    std::vector<PencilLeaf> leaves_;   ///< a power of two, those of a heap (leaf_heap.h)
    std::size_t top_ = 1;  ///< the first node of the uppermost of its levels that are asked
    std::vector<PencilBoxes>
        boxes_;  ///< of a node's descendants three levels below, by node; on every third level
};

}  // namespace caustics::beamtree
