#include "photonmap/photons/photon_map_params.h"

namespace caustics::photonmap {

const char* name(TreeKind kind) {
    switch (kind) {
        case TreeKind::unbalanced: return "unbalanced";
        case TreeKind::packed: return "packed";
        case TreeKind::balanced: break;
    }
    return "balanced";
}

const char* name(FilterKind kind) {
    switch (kind) {
        case FilterKind::cone: return "cone";
        case FilterKind::gaussian: return "gaussian";
        case FilterKind::epanechnikov: return "epanechnikov";
        case FilterKind::none: break;
    }
    return "none";
}

}  // namespace caustics::photonmap
