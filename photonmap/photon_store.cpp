#include "photonmap/photon_store.h"

#include <sys/mman.h>

#include <algorithm>
#include <cerrno>
#include <limits>
#include <string>
#include <system_error>

#include "core/error.h"

namespace caustics {

namespace {

[[noreturn]] void fail_to_reserve(std::uint64_t capacity, int error) {
    throw InputError("photonmap: cannot reserve memory for " + std::to_string(capacity) +
                     " photons of 20 bytes: " + std::generic_category().message(error) +
                     " (ask for fewer photons or emitted)");
}

}  // namespace

void PhotonStore::Unmap::operator()(Photon* memory) const { munmap(memory, bytes); }

PhotonStore::PhotonStore(std::uint64_t capacity)
    : capacity_(static_cast<std::size_t>(capacity)), memory_(reserve(capacity)) {}

std::unique_ptr<Photon[], PhotonStore::Unmap> PhotonStore::reserve(std::uint64_t capacity) {
    constexpr std::size_t block_bytes = block_photons * sizeof(Photon);
    if (capacity > std::numeric_limits<std::size_t>::max() / sizeof(Photon) - block_photons)
        fail_to_reserve(capacity, ENOMEM);
    const std::uint64_t blocks =
        std::max<std::uint64_t>(1, (capacity + block_photons - 1) / block_photons);
    const std::size_t bytes = blocks * block_bytes;
    void* memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE,
                        MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (memory == MAP_FAILED) fail_to_reserve(capacity, errno);
    // Tree walks jump all over the map; large pages spare them address translations. Only advice.
    madvise(memory, bytes, MADV_HUGEPAGE);
    return {static_cast<Photon*>(memory), Unmap{bytes}};
}

void PhotonStore::append(std::span<const Photon> photons) {
    if (photons.size() > capacity_ - size_)
        throw InputError("photonmap: more than " + std::to_string(capacity_) +
                         " photons to store (ask for fewer photons or emitted)");
    std::ranges::copy(photons, memory_.get() + size_);
    size_ += photons.size();
}

}  // namespace caustics
