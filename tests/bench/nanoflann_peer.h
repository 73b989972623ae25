#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

namespace caustics::bench {

/// nanoflann's kd-tree over positions that lie `stride` floats apart, with an interface that holds
/// no inline code: its source is compiled for this machine, and none of that may leak out.
class NanoflannTree {
public:
    NanoflannTree(const float* positions, std::size_t count, std::size_t stride,
                  std::size_t leaf_size);
    ~NanoflannTree();
    NanoflannTree(NanoflannTree&&) noexcept;
    NanoflannTree& operator=(NanoflannTree&&) noexcept;

    /// How the k nearest found so far are kept: by nanoflann's own KNNResultSet, a sorted array, or
    /// by a binary max-heap, which does not grow slow with k.
    enum class ResultSet { stock, heap };

    /// The k nearest points within a distance: their indices and squared distances, in no order
    /// that may be relied on. The arrays hold k. Returns how many were found.
    std::size_t nearest(ResultSet set, const float* point, std::size_t k,
                        float max_squared_distance, std::uint32_t* indices,
                        float* squared_distances) const;

private:
    struct Index;
    std::unique_ptr<Index> index_;
};

}  // namespace caustics::bench
