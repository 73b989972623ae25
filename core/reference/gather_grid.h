#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/caustic_estimator.h"

namespace caustics {

/// Finds the discs that contain a point: each disc lies in the tangent plane of a receiver point,
/// as thick as its radius on both sides so that curved receivers count.
class GatherGrid {
public:
    GatherGrid(std::span<const ReceiverPoint> points, std::span<const float> radii);

    /// Calls found(index) for the discs that contain `position` and face `wi`, by index.
    template <typename Found>
    void for_each_containing(const Vec3& position, const Vec3& wi, const Found& found) const {
        const auto cell = cells_.find(key(cell_of(position)));
        if (cell == cells_.end()) return;
        for (const std::uint32_t i : cell->second)
            if (contains(i, position, wi)) found(i);
    }

private:
    using Cell = Eigen::Vector3i;
    Cell cell_of(const Vec3& p) const;
    static std::uint64_t key(const Cell& cell);
    bool contains(std::uint32_t index, const Vec3& position, const Vec3& wi) const;

    std::span<const ReceiverPoint> points_;
    std::span<const float> radii_;
    float cell_size_ = 1;
    /// Each disc stands in every cell its bounding box meets, ascending.
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

}  // namespace caustics
