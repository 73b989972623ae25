#include "beamtree/beams/bin_share.h"

namespace caustics::beamtree {

Spectrum whitened(const WavelengthBin& bin) {
    return (bin.weight > 0).select(1 / bin.weight, black());
}

Spectrum share_of_bin(const WavelengthBin& bin, float nm) {
    if (bin.nm == 0 || nm == 0) return Spectrum::Ones();
    const bool is_last = bin.to >= float{longest_wavelength};
    if (nm < bin.from || (nm >= bin.to && !is_last)) return black();
    return whitened(bin);
}

}  // namespace caustics::beamtree
