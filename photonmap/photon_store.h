#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "photonmap/photon.h"

namespace caustics {

/// Photons in blocks of 65,536 [J96, section 2]. All blocks lie in one reserved range of address
/// space: memory is taken only as photons arrive, no photon ever moves when another block begins,
/// and the whole is one array for the kd-tree.
class PhotonStore {
public:
    static constexpr std::size_t block_photons = 65'536;

    /// Reserves address space for `capacity` photons, in whole blocks. Throws InputError when the
    /// system does not give it.
    explicit PhotonStore(std::uint64_t capacity);

    /// Throws InputError when the capacity is exceeded.
    void append(std::span<const Photon> photons);

    std::span<Photon> photons() { return {memory_.get(), size_}; }
    std::span<const Photon> photons() const { return {memory_.get(), size_}; }
    std::size_t size() const { return size_; }
    std::uint64_t bytes() const { return size_ * sizeof(Photon); }

private:
    struct Unmap {
        std::size_t bytes = 0;
        void operator()(Photon* memory) const;
    };
    static std::unique_ptr<Photon[], Unmap> reserve(std::uint64_t capacity);

    std::size_t capacity_;
    std::size_t size_ = 0;
    std::unique_ptr<Photon[], Unmap> memory_;
};

}  // namespace caustics
