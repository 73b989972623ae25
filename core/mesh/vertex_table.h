#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace caustics {

/// Vertices by their values, each there once: equal are those whose numbers are, 0 and -0 too.
class VertexTable {
public:
    /// Position, normal, texture coordinates.
    using Vertex = std::array<double, 8>;

    /// The place of that vertex in vertices(), where it is put if it is new. NaN is not looked for.
    std::uint32_t index_of(const Vertex& vertex);
    const std::vector<Vertex>& vertices() const { return vertices_; }

private:
    std::size_t slot_of(const Vertex& vertex) const;
    void grow();

    static constexpr std::uint32_t free_ = ~0U;

    std::vector<Vertex> vertices_;
    std::vector<std::uint32_t> slots_ = std::vector<std::uint32_t>(1024, free_);
};

}  // namespace caustics
