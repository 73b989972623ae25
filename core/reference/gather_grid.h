#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/light_path/light_path.h"

namespace caustics {

/// Finds the discs that contain a point: each disc lies in the tangent plane of a receiver point,
/// as thick as its radius on both sides so that curved receivers count. Of other shapes only what goes on in its plane
/// counts, to a hundredth of the radius: a floor in pieces, but no shelf above it.
class GatherGrid {
public:
    GatherGrid(std::span<const ReceiverPoint> points, std::span<const float> radii);

    /// Calls found(index), by index, for the discs that contain the deposit's position, face the way
    /// it came from, and lie on a surface that faces as the deposit's does (same_surface.h).
    template <typename Found>
    void for_each_containing(const Deposit& deposit, const Found& found) const {
        const auto cell = cells_.find(key(cell_of(deposit.position)));
        if (cell == cells_.end()) return;
        for (const std::uint32_t i : cell->second)
            if (contains(i, deposit)) found(i);
    }

private:
    using Cell = Eigen::Vector3i;
    Cell cell_of(const Vec3& p) const;
    static std::uint64_t key(const Cell& cell);
    bool contains(std::uint32_t index, const Deposit& deposit) const;

    std::span<const ReceiverPoint> points_;
    std::span<const float> radii_;
    float cell_size_ = 1;
    /// Each disc is listed in every cell its bounding box meets, ascending.
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

}  // namespace caustics
