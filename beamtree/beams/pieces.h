#pragma once

#include <atomic>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace caustics::beamtree {

/// Sets of numbers that grow together; any threads may join them at a time [Anderson and Woll 1991]. The number that names
/// a set at last is its least.
class Pieces {
public:
    explicit Pieces(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), 0U);
    }

    std::uint32_t find(std::uint32_t i) {
        for (;;) {
            const std::uint32_t parent = load(i);
            if (parent == i) return i;
            const std::uint32_t above = load(parent);
            // Halves the way up; parents only ever become less.
            if (above != parent) replace(i, parent, above);
            i = above;
        }
    }
    void join(std::uint32_t a, std::uint32_t b) {
        for (;;) {
            a = find(a);
            b = find(b);
            if (a == b) return;
            if (a < b) std::swap(a, b);
            if (replace(a, a, b)) return;
        }
    }

private:
    std::uint32_t load(std::uint32_t i) {
        return std::atomic_ref(parent_[i]).load(std::memory_order_relaxed);
    }
    bool replace(std::uint32_t i, std::uint32_t expected, std::uint32_t by) {
        return std::atomic_ref(parent_[i])
            .compare_exchange_strong(expected, by, std::memory_order_relaxed);
    }

    std::vector<std::uint32_t> parent_;
};

}  // namespace caustics::beamtree
