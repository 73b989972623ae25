#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>

namespace caustics::photonmap {

/// An array of plain data, aligned to 64 bytes; its contents are lost when it grows.
template <typename T>
class AlignedArray {
public:
    /// Makes room for at least `count` entries.
    void reserve(std::size_t count) {
        if (count <= capacity_) return;
        const std::size_t bytes = (count * sizeof(T) + 63) / 64 * 64;
        memory_.reset(static_cast<T*>(std::aligned_alloc(64, bytes)));
        if (!memory_) throw std::bad_alloc();
        capacity_ = count;
    }
    T* data() { return memory_.get(); }
    const T* data() const { return memory_.get(); }
    T& operator[](std::size_t i) { return memory_[i]; }

private:
    struct Free {
        void operator()(T* memory) const { std::free(memory); }
    };
    std::unique_ptr<T[], Free> memory_;
    std::size_t capacity_ = 0;
};

}  // namespace caustics::photonmap
