#pragma once

#include <memory>
#include <vector>

#include "core/known_shadows.h"
#include "core/run_options.h"
#include "photonmap/tree/photon_tree.h"

namespace caustics::photonmap {

/// The shadow photons of every light. Where the nearest of them agree, the point is taken for lit or dark
/// without a shadow ray [C11]; what casts shadows narrower than the photons lie apart is missed there.
class ShadowMap {
public:
    /// How many photons have to agree.
    static constexpr std::size_t nearest = 20;

    /// Traces `paths` rays from each light. Phase "shadow".
    ShadowMap(const Scene& scene, std::uint64_t paths, const RunOptions& options);

    KnownShadows::Seen sees(const ReceiverPoint& point, std::size_t light,
                            GatherScratch& scratch) const;
    std::uint64_t size() const;
    std::uint64_t bytes() const;

private:
    struct OfLight {
        GatherLimits limits;
        std::unique_ptr<const PhotonTree> tree;
    };
    std::vector<OfLight> lights_;
};

}  // namespace caustics::photonmap
