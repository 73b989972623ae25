#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "photonmap/photons/photon_map_params.h"
#include "photonmap/photons/photon_tracing.h"

namespace caustics::photonmap {

/// Where the photons of a map come from.
struct PhotonOrigin {
    std::uint64_t transport = 0;  ///< transport_hash() of the scene
    std::uint64_t seed = 0;
    PhotonMapParams::Emission emission = PhotonMapParams::Emission::random;
    Interaction interaction = Interaction::roulette;
    int max_bounces = 0;
    bool whole_paths = false;  ///< of a global map: photons on all surfaces
    int diffuse_bounces = 0;   ///< of a global map: the receiver at which a photon ends; 0: none
    std::string command = {};  ///< that traced them: RunOptions::origin
};

/// Of the format. Files of versions 2 and 3 are read too, which have no global maps. Those of version 2 have
/// no `misdirected` (it is among the absorbed), and their photons' surfaces are not known (facing_code.h),
/// so that photons round a corner count in estimates as they did then.
inline constexpr std::uint32_t photon_map_version = 4;
inline constexpr std::uint32_t first_version_with_surfaces = 3;
inline constexpr std::uint32_t oldest_photon_map_version = 2;

struct SavedPhotons {
    TracedPhotons photons;
    PhotonOrigin origin;
    std::uint32_t version = photon_map_version;  ///< of the file they come from
};

/// One map serves many views [J96 sec. 5]: the photons of a scene in the order of their paths,
/// before any tree is built, so that pictures from the file are bit-identical. The format, all
/// numbers little-endian: "causticbench photon map\n", its version (u32), length of the header
/// (u32), the header (transport, seed u64; emission, interaction, max_bounces, whole_paths, diffuse_bounces u32; the 13 counts
/// of LightPathCounts u64; flux unit 3 x f32; command), number of photons (u64), 20 bytes each as
/// photon.h has them, and the FNV-1a hash of all that (u64).
void save_photon_map(const TracedPhotons& photons, const PhotonOrigin& origin,
                     const std::filesystem::path& file);

/// Whether a file begins as one.
bool is_photon_map(const std::filesystem::path& file);

/// Throws InputError naming the file and what is wrong: foreign, of another version, cut short, or
/// damaged.
SavedPhotons load_photon_map(const std::filesystem::path& file);

/// The hash at the end of a map's file, which stands for its content; that it fits is seen only on
/// loading. Throws InputError where there is no photon map.
std::uint64_t photon_map_checksum(const std::filesystem::path& file);

}  // namespace caustics::photonmap
