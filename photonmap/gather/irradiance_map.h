#pragma once

#include <optional>
#include <vector>

#include "core/run_options.h"
#include "photonmap/gather/density_map.h"

namespace caustics::photonmap {

/// Every K-th photon of a map, as a place on its surface: the side that it landed on, where photons that say
/// nothing else of it count as the surface's own. Its energy is its number.
PhotonStore every_kth(std::span<const Photon> photons, int k);

/// Irradiance known beforehand at some places of a map, and read at the nearest of them on the same surface
/// [Christensen 1999, "Faster photon map global illumination"]. The photon that gives a place counts in its
/// estimate: a reader has no nearer place, and that lack of one photon is what the photon makes good.
class IrradianceMap {
public:
    IrradianceMap(PhotonStore places, const DensityMap& density, const RunOptions& options);

    /// [W m^-2] on the side of each point's geometric normal; none where no place is within the estimate's
    /// maximum radius. Calls take(i, irradiance).
    template <typename Take>
    void read(std::span<const ReceiverPoint> points, GatherScratch& scratch,
              const Take& take) const {
        tree_->gather(points, nearest_, scratch, [&](std::size_t i, const GatheredPhotons& found) {
            take(i, found.count == 0 ? std::optional<Spectrum>{} : irradiance_[found.energy[0]]);
        });
    }
    std::size_t size() const { return irradiance_.size(); }
    std::uint64_t bytes() const { return tree_->bytes() + irradiance_.size() * sizeof(Spectrum); }

private:
    std::vector<Spectrum> irradiance_;  ///< of the places, by number
    GatherLimits nearest_;
    std::unique_ptr<const PhotonTree> tree_;
};

}  // namespace caustics::photonmap
