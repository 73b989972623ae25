#include "tests/bench/nanoflann_peer.h"

#include <cmath>
#include <limits>
#include <nanoflann.hpp>

namespace caustics::bench {

namespace {

struct Points {
    const float* positions;
    std::size_t count;
    std::size_t stride;

    std::size_t kdtree_get_point_count() const { return count; }
    float kdtree_get_pt(std::size_t point, std::size_t axis) const {
        return positions[point * stride + axis];
    }
    template <typename Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>,
                                                 Points, 3, std::uint32_t>;

/// nanoflann keeps a point only below the bound; the maximum distance itself belongs to the disc.
float bound_above(float squared_distance) {
    return std::nextafter(squared_distance, std::numeric_limits<float>::infinity());
}

/// A result set of nanoflann's kind with a binary max-heap.
class HeapSet {
public:
    using DistanceType = float;
    using IndexType = std::uint32_t;
    using CountType = std::size_t;

    HeapSet(std::size_t capacity, float bound, std::uint32_t* indices, float* distances)
        : capacity_(capacity), bound_(bound), indices_(indices), distances_(distances) {}

    std::size_t size() const { return count_; }
    bool full() const { return count_ == capacity_; }
    float worstDist() const { return bound_; }

    bool addPoint(float distance, std::uint32_t index) {
        if (count_ < capacity_) {
            sift_up(distance, index);
            if (++count_ == capacity_) bound_ = distances_[0];
        } else if (distance < bound_) {
            sift_down(distance, index);
            bound_ = distances_[0];
        }
        return true;
    }

private:
    void sift_up(float distance, std::uint32_t index) {
        std::size_t hole = count_;
        while (hole > 0 && distances_[(hole - 1) / 2] < distance) {
            distances_[hole] = distances_[(hole - 1) / 2];
            indices_[hole] = indices_[(hole - 1) / 2];
            hole = (hole - 1) / 2;
        }
        distances_[hole] = distance;
        indices_[hole] = index;
    }
    void sift_down(float distance, std::uint32_t index) {
        std::size_t hole = 0;
        for (std::size_t child = 1; child < capacity_; child = 2 * hole + 1) {
            if (child + 1 < capacity_ && distances_[child + 1] > distances_[child]) ++child;
            if (distances_[child] <= distance) break;
            distances_[hole] = distances_[child];
            indices_[hole] = indices_[child];
            hole = child;
        }
        distances_[hole] = distance;
        indices_[hole] = index;
    }

    std::size_t capacity_;
    std::size_t count_ = 0;
    float bound_;
    std::uint32_t* indices_;
    float* distances_;
};

}  // namespace

/// nanoflann keeps a reference to the points, so they live beside the tree.
struct NanoflannTree::Index {
    Index(const Points& from, std::size_t leaf_size)
        : points(from), tree(3, points, nanoflann::KDTreeSingleIndexAdaptorParams(leaf_size)) {
        tree.buildIndex();
    }
    Points points;
    Tree tree;
};

NanoflannTree::NanoflannTree(const float* positions, std::size_t count, std::size_t stride,
                             std::size_t leaf_size)
    : index_(std::make_unique<Index>(Points{positions, count, stride}, leaf_size)) {}
NanoflannTree::~NanoflannTree() = default;
NanoflannTree::NanoflannTree(NanoflannTree&&) noexcept = default;
NanoflannTree& NanoflannTree::operator=(NanoflannTree&&) noexcept = default;

std::size_t NanoflannTree::nearest(ResultSet set, const float* point, std::size_t k,
                                   float max_squared_distance, std::uint32_t* indices,
                                   float* squared_distances) const {
    const nanoflann::SearchParams params;
    if (set == ResultSet::heap) {
        HeapSet results(k, bound_above(max_squared_distance), indices, squared_distances);
        index_->tree.findNeighbors(results, point, params);
        return results.size();
    }
    nanoflann::KNNResultSet<float, std::uint32_t> results(k);
    results.init(indices, squared_distances);
    // The worst distance of a set that is not full, which is how it bounds the search.
    squared_distances[k - 1] = bound_above(max_squared_distance);
    index_->tree.findNeighbors(results, point, params);
    return results.size();
}

}  // namespace caustics::bench
