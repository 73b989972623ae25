#include "photonmap/shadow/shadow_map.h"

#include <algorithm>
#include <utility>

#include "photonmap/estimate/max_radius.h"
#include "photonmap/shadow/shadow_photons.h"
#include "photonmap/tree/build_tree.h"

namespace caustics::photonmap {

ShadowMap::ShadowMap(const Scene& scene, std::uint64_t paths, const RunOptions& options) {
    options.phase("shadow");
    for (std::uint32_t light = 0; light < scene.lights().size(); ++light) {
        PhotonStore photons = trace_shadows(scene, light, paths, options);
        const double radius =
            default_max_radius(photons.photons(), scene.bounds(), static_cast<int>(nearest));
        lights_.push_back(
            {{nearest, static_cast<float>(radius)},
             build_tree(TreeKind::packed, std::move(photons), options.isa, options.threads)});
    }
}

KnownShadows::Seen ShadowMap::sees(const ReceiverPoint& point, std::size_t light,
                                   GatherScratch& scratch) const {
    using Seen = KnownShadows::Seen;
    const OfLight& of = lights_[light];
    Seen seen = Seen::unknown;
    of.tree->gather(
        {&point, 1}, of.limits, scratch, [&](std::size_t, const GatheredPhotons& photons) {
            if (photons.count < nearest) return;
            const auto in_light = std::count_if(photons.energy, photons.energy + photons.count,
                                                [](std::uint32_t e) { return lit(e) == Lit::yes; });
            if (in_light == 0) seen = Seen::no;
            if (in_light == static_cast<std::ptrdiff_t>(nearest)) seen = Seen::yes;
        });
    return seen;
}

std::uint64_t ShadowMap::size() const {
    std::uint64_t sum = 0;
    for (const OfLight& light : lights_) sum += light.tree->size();
    return sum;
}

std::uint64_t ShadowMap::bytes() const {
    std::uint64_t sum = 0;
    for (const OfLight& light : lights_) sum += light.tree->bytes();
    return sum;
}

}  // namespace caustics::photonmap
