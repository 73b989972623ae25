#include "photonmap/photons/photon_store.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <limits>
#include <string>
#include <system_error>

#include "core/base/error.h"

namespace caustics::photonmap {

namespace {

constexpr std::size_t block_bytes = PhotonStore::block_photons * sizeof(Photon);
constexpr std::size_t large_page = std::size_t{2} << 20U;
/// Linux's MADV_COLLAPSE, since 6.1; older systems refuse it, which does no harm.
constexpr int collapse_now = 25;

[[noreturn]] void fail_to_reserve(std::uint64_t capacity, int error) {
    throw InputError("no memory to reserve for " + std::to_string(capacity) +
                     " photons of 20 bytes: " + std::generic_category().message(error) +
                     " (ask for fewer photons)");
}

std::size_t round_up(std::size_t bytes, std::size_t unit) {
    return (bytes + unit - 1) / unit * unit;
}

/// Tree walks jump all over the map; large pages spare them address translations. Only advice.
/// Whole large pages only: the rest of one would be memory for nothing.
void advise_large_pages(void* memory, std::size_t bytes) {
    if (bytes >= large_page) madvise(memory, bytes / large_page * large_page, MADV_HUGEPAGE);
}

}  // namespace

void PhotonStore::Unmap::operator()(Photon*) const { munmap(mapped, bytes); }

PhotonStore::PhotonStore(std::uint64_t capacity, std::uint64_t certain)
    : capacity_(static_cast<std::size_t>(capacity)), memory_(reserve(capacity)) {
    advise_large_pages(memory_.get(), std::min<std::size_t>(certain, capacity_) * sizeof(Photon));
}

std::unique_ptr<Photon[], PhotonStore::Unmap> PhotonStore::reserve(std::uint64_t capacity) {
    if (capacity > std::numeric_limits<std::size_t>::max() / sizeof(Photon) - 2 * block_photons)
        fail_to_reserve(capacity, ENOMEM);
    const std::uint64_t blocks =
        std::max<std::uint64_t>(1, (capacity + block_photons - 1) / block_photons);
    // One large page more, so that the first photon can lie at the start of one.
    const std::size_t bytes = blocks * block_bytes + large_page;
    void* const mapped = mmap(nullptr, bytes, PROT_READ | PROT_WRITE,
                              MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (mapped == MAP_FAILED) fail_to_reserve(capacity, errno);
    const auto address = reinterpret_cast<std::uintptr_t>(mapped);
    void* const aligned = static_cast<char*>(mapped) + (round_up(address, large_page) - address);
    return {static_cast<Photon*>(aligned), Unmap{mapped, bytes}};
}

std::span<Photon> PhotonStore::extend(std::uint64_t count) {
    if (count > capacity_ - size_)
        throw InputError("more than " + std::to_string(capacity_) +
                         " photons to store (ask for fewer photons)");
    const std::span<Photon> room(memory_.get() + size_, count);
    size_ += count;
    return room;
}

void PhotonStore::append(std::span<const Photon> photons) {
    std::ranges::copy(photons, extend(photons.size()).begin());
}

void PhotonStore::shrink(std::size_t count) {
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    const std::size_t kept = round_up(count * sizeof(Photon), page);
    const std::size_t held = round_up(size_ * sizeof(Photon), page);
    if (held > kept)
        madvise(reinterpret_cast<char*>(memory_.get()) + kept, held - kept, MADV_DONTNEED);
    size_ = count;
}

void PhotonStore::settle() {
    const std::size_t whole = size_ * sizeof(Photon) / large_page * large_page;
    if (whole == 0) return;
    advise_large_pages(memory_.get(), whole);
    madvise(memory_.get(), whole, collapse_now);
}

}  // namespace caustics::photonmap
