#include "experiments/run/methods.h"

#include "beamtree/beam_tree_method.h"
#include "beamtree/caustic_polygons.h"
#include "core/illumination_map/illumination_map.h"
#include "core/method/none.h"
#include "core/reference/light_trace.h"
#include "core/reference/path_trace.h"
#include "photonmap/photon_map_method.h"

namespace caustics {

const std::vector<const MethodDescription*>& all_methods() {
    static const std::vector<const MethodDescription*> methods = {
        &none_method(),
        &pathtrace_method(),
        &lighttrace_method(),
        &photonmap_method(),
        &beamtree_method(),
        &illuminationmap_method(),
        &causticpolygons_method(),
    };
    return methods;
}

}  // namespace caustics
