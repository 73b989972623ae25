#include <cstring>
#include <optional>

#include "core/base/hash.h"
#include "photonmap/photons/photon_map_file.h"
#include "tests/fuzz/reading.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace {

using namespace caustics;
using namespace caustics::photonmap;

constexpr std::size_t checksum = sizeof(std::uint64_t);

void check(const SavedPhotons& saved) {
    const Spectrum unit = saved.photons.flux_per_energy();
    for (const Photon& photon : saved.photons.store.photons()) {
        fuzz::require(position(photon).allFinite(), "a photon at no place");
        fuzz::require(incoming(photon).allFinite(), "a photon from no direction");
        fuzz::require(is_finite(decode_rgbe(photon.energy) * unit), "a photon of no flux");
    }
}

}  // namespace

/// Bytes, with a checksum that fits most of the time: else nothing behind it would be reached.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
    size = LLVMFuzzerMutate(data, size, most);
    if (seed % 8 == 0 || size < checksum) return size;
    const std::uint64_t hash = fnv1a(fuzz::view(data, size - checksum));
    std::memcpy(data + size - checksum, &hash, checksum);
    return size;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes = fuzz::view(data, size);
    const auto file = fuzz::put("photons.map", bytes);
    std::optional<SavedPhotons> saved;
    fuzz::taken(fuzz::Naming::file, [&] { saved = load_photon_map(file); });
    if (saved) check(*saved);
    if (!fuzz::one_in(16, bytes)) return 0;
    fuzz::require(is_photon_map(file) || !saved, "a photon map that is not one");
    fuzz::taken(fuzz::Naming::file, [&] { photon_map_checksum(file); });
    if (!saved) return 0;
    // What was read can be written, and is the same when read again.
    const auto again = fuzz::named("again.map");
    save_photon_map(saved->photons, saved->origin, again);
    check(load_photon_map(again));
    return 0;
}
