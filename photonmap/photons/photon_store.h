#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "photonmap/photons/photon.h"

namespace caustics::photonmap {

/// Photons in blocks of 65,536 [J96 sec. 2]. All blocks lie in one reserved range of address
/// space: memory is taken only as photons arrive, no photon ever moves when another block begins,
/// and the whole is one array for the kd-tree, which may write behind the last photon up to the end of
/// its block.
class PhotonStore {
public:
    static constexpr std::size_t block_photons = 65'536;

    /// Reserves address space for `capacity` photons, in whole blocks. Where the first `certain`
    /// of them lie, large pages may be used at once; elsewhere they could take memory for photons
    /// that never come. Throws InputError when the system does not give it.
    explicit PhotonStore(std::uint64_t capacity, std::uint64_t certain = 0);

    /// Makes room for `count` more photons, which the caller writes: different threads may write
    /// different places at the same time. Throws InputError when the capacity is exceeded.
    std::span<Photon> extend(std::uint64_t count);
    void append(std::span<const Photon> photons);
    /// Leaves the first `count` photons and gives the other memory back.
    void shrink(std::size_t count);
    /// To call when all photons have come: puts them on large pages as far as they fill them.
    void settle();

    std::span<Photon> photons() { return {memory_.get(), size_}; }
    std::span<const Photon> photons() const { return {memory_.get(), size_}; }
    std::size_t size() const { return size_; }
    std::uint64_t bytes() const { return size_ * sizeof(Photon); }

private:
    struct Unmap {
        void* mapped = nullptr;
        std::size_t bytes = 0;
        void operator()(Photon* memory) const;
    };
    static std::unique_ptr<Photon[], Unmap> reserve(std::uint64_t capacity);

    std::size_t capacity_;
    std::size_t size_ = 0;
    std::unique_ptr<Photon[], Unmap> memory_;
};

}  // namespace caustics::photonmap
