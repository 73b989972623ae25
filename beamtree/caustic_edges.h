#pragma once

#include <vector>

#include "beamtree/tracing/traced_scene.h"

namespace caustics::beamtree {

/// An edge of a caustic polygon where it falls on a receiver.
struct CausticEdge {
    enum class Kind {
        direct,  ///< of polygons whose light has passed through no caustic, or through two
        folded,  ///< of polygons that are turned over
        fold     ///< between one of each: the caustic runs along it, to a polygon's width
    };
    Vec3 from;
    Vec3 to;
    Kind kind = Kind::direct;
};

/// Those of all beams, each edge once. A polygon counts where the rays of its corners come to one
/// receiver, past no caster: where they meet another one they belong to further beams.
std::vector<CausticEdge> caustic_edges(const Scene& scene, const TracedScene& traced);

}  // namespace caustics::beamtree
