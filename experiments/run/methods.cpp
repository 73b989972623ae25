#include "experiments/run/methods.h"

#include "beamtree/beam_tree_method.h"
#include "beamtree/caustic_polygons.h"
#include "core/illumination_map/illumination_map.h"
#include "core/method/none.h"
#include "core/reference/indirect_path_trace.h"
#include "core/reference/light_trace.h"
#include "core/reference/path_trace.h"
#include "photonmap/global_photon_map.h"
#include "photonmap/photon_map_method.h"

namespace caustics::experiments {

const std::vector<const MethodDescription*>& all_methods() {
    static const std::vector<const MethodDescription*> methods = {
        &none_method(),
        &pathtrace_method(),
        &lighttrace_method(),
        &photonmap::photonmap_method(),
        &beamtree::beamtree_method(),
        &illuminationmap_method(),
        &beamtree::causticpolygons_method(),
    };
    return methods;
}

const std::vector<const IndirectDescription*>& all_indirect_methods() {
    static const std::vector<const IndirectDescription*> methods = {
        &indirect_pathtrace_method(),
        &indirect_lighttrace_method(),
        &photonmap::globalphotonmap_method(),
    };
    return methods;
}

}  // namespace caustics::experiments
