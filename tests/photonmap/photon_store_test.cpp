#include "photonmap/photons/photon_store.h"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <vector>

#include "core/base/error.h"
#include "photon_sets.h"

namespace caustics::photonmap {
namespace {

/// Bytes of a range that are in memory.
std::size_t resident_bytes_of(const void* begin, std::size_t bytes) {
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    std::vector<unsigned char> pages((bytes + page - 1) / page);
    EXPECT_EQ(mincore(const_cast<void*>(begin), bytes, pages.data()), 0);
    std::size_t resident = 0;
    for (const unsigned char p : pages) resident += (p & 1U) != 0 ? page : 0;
    return resident;
}

TEST(PhotonStore, NeverMovesAPhoton) {
    PhotonStore store(3 * PhotonStore::block_photons);
    const std::vector<Photon> some(1'000, test::photon_at({1, 2, 3}));
    store.append(some);
    const Photon* const first = store.photons().data();
    while (store.size() + some.size() <= 3 * PhotonStore::block_photons) store.append(some);
    EXPECT_EQ(store.photons().data(), first);
    EXPECT_EQ(store.bytes(), 20 * store.size());
    EXPECT_EQ(store.photons().back().position[2], 3);
}

TEST(PhotonStore, TakesMemoryOnlyForWhatItHolds) {
    constexpr std::uint64_t capacity = 1'000'000'000;
    PhotonStore store(capacity);
    const std::vector<Photon> some(10'000, test::photon_at({1, 2, 3}));
    for (int i = 0; i < 100; ++i) store.append(some);
    const std::size_t held = store.size() * sizeof(Photon);
    constexpr std::size_t block = PhotonStore::block_photons * sizeof(Photon);
    // A page of the largest kind may be open at the end.
    EXPECT_LE(resident_bytes_of(store.photons().data(), held + 16 * block),
              held + std::max<std::size_t>(block, 2U << 20U));
}

TEST(PhotonStore, RefusesWhatDoesNotFit) {
    PhotonStore store(2);
    const std::vector<Photon> three(3, test::photon_at({0, 0, 0}));
    EXPECT_THROW(store.append(three), InputError);
    EXPECT_EQ(store.size(), 0U);
    EXPECT_THROW(PhotonStore{std::uint64_t{1} << 62U}, InputError);
    EXPECT_THROW(PhotonStore{~std::uint64_t{0}}, InputError);
}

TEST(PhotonStore, MayBeEmpty) {
    const PhotonStore store(0);
    EXPECT_TRUE(store.photons().empty());
}

}  // namespace
}  // namespace caustics::photonmap
