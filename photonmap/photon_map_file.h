#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "photonmap/photon_tracing.h"

namespace caustics {

/// What stands before the photons in a photon map's file.
struct PhotonMapHeader {
    std::uint64_t transport = 0;  ///< transport_digest() of the scene
    LightPathCounts counts;
    Spectrum flux_unit = Spectrum::Ones();  ///< [W] of a photon of energy 1, times emitted
    std::string origin;                     ///< what made it: RunOptions::origin
};

/// One map serves many views [J96, section 5]: the photons of a scene in the order of their paths,
/// before any tree is built, so that pictures from the file are bit-identical. The format, all
/// numbers little-endian: "causticbench photon map\n", its version (u32), length of the header (u32), the
/// header (transport u64, seven counts u64, flux unit 3 x f32, origin), number of photons (u64), 20
/// bytes each as photon.h has them, and the FNV-1a hash of all that (u64).
void save_photon_map(const TracedPhotons& photons, std::uint64_t transport,
                     const std::string& origin, const std::filesystem::path& file);

/// Whether a file begins as one.
bool is_photon_map(const std::filesystem::path& file);

/// Throws InputError naming the file and what is wrong: foreign, of another version, cut short, or
/// damaged.
TracedPhotons load_photon_map(const std::filesystem::path& file, PhotonMapHeader& header);

}  // namespace caustics
