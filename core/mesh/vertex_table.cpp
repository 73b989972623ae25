#include "core/mesh/vertex_table.h"

#include <bit>

namespace caustics {
namespace {

std::uint64_t hash_of(const VertexTable::Vertex& vertex) {
    std::uint64_t hash = 0;
    for (const double value : vertex) {
        // -0 + 0 is 0.
        hash = (hash ^ std::bit_cast<std::uint64_t>(value + 0.0)) * 0x9E3779B97F4A7C15U;
        hash ^= hash >> 32U;
    }
    return hash;
}

}  // namespace

// The slot that holds the vertex, or the free one where it belongs: there are as many slots as a power of two,
// at most half of them taken.
std::size_t VertexTable::slot_of(const Vertex& vertex) const {
    std::size_t slot = hash_of(vertex) & (slots_.size() - 1);
    while (slots_[slot] != free_ && vertices_[slots_[slot]] != vertex)
        slot = (slot + 1) & (slots_.size() - 1);
    return slot;
}

std::uint32_t VertexTable::index_of(const Vertex& vertex) {
    const std::size_t slot = slot_of(vertex);
    if (slots_[slot] != free_) return slots_[slot];
    const auto index = static_cast<std::uint32_t>(vertices_.size());
    slots_[slot] = index;
    vertices_.push_back(vertex);
    if (2 * vertices_.size() > slots_.size()) grow();
    return index;
}

void VertexTable::grow() {
    slots_.assign(2 * slots_.size(), free_);
    for (std::uint32_t i = 0; i < vertices_.size(); ++i) slots_[slot_of(vertices_[i])] = i;
}

}  // namespace caustics
