#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace caustics {

/// A photon found near a point.
struct Neighbour {
    float squared_distance;  ///< [m^2]
    std::uint32_t index;     ///< into the tree's array

    /// Equal distances are ordered by index, so that the N nearest are always the same ones.
    friend bool operator<(const Neighbour& a, const Neighbour& b) {
        if (a.squared_distance != b.squared_distance)
            return a.squared_distance < b.squared_distance;
        return a.index < b.index;
    }
};

/// The N nearest of the neighbours offered, within a maximum distance: a bounded max-heap. Its
/// memory is taken once.
class NearestSet {
public:
    /// `count` >= 1.
    explicit NearestSet(std::size_t count) : count_(count) { heap_.reserve(count); }

    void reset(float max_squared_distance) {
        heap_.clear();
        bound_ = max_squared_distance;
    }
    /// Squared distance beyond which an offer is certainly refused [m^2].
    float bound() const { return bound_; }
    bool full() const { return heap_.size() == count_; }
    void offer(const Neighbour& neighbour);

    /// The set in heap order; the farthest comes first.
    std::span<const Neighbour> found() const { return heap_; }

private:
    std::size_t count_;
    float bound_ = 0;
    std::vector<Neighbour> heap_;
};

}  // namespace caustics
