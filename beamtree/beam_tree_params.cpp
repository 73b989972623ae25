#include "beamtree/beam_tree.h"

namespace caustics {

namespace {

void read_bound(const JsonNode& node, BeamTreeParams& params) {
    constexpr Bound bounds[] = {Bound::single, Bound::double_cone, Bound::hybrid,
                                Bound::sphere_swept};
    if (const auto bound = node.find("bound")) {
        const std::size_t choice =
            bound->as_choice({"single", "double", "hybrid", "sphere_swept", "two_slice"});
        if (choice == 4)
            bound->fail(
                "\"two_slice\" is not built yet (built: \"single\", \"double\", \"hybrid\", "
                "\"sphere_swept\")");
        params.bound = bounds[choice];
    }
    if (const auto threshold = node.find("spread_threshold")) {
        params.spread_threshold = threshold->as_number_in(0, 90);
        if (params.bound != Bound::hybrid)
            threshold->fail("only the bound \"hybrid\" has a spread threshold");
    }
    if (const auto merging = node.find("merging"))
        params.merging = merging->as_choice({"rays", "cones"}) == 0
                             ? ConeTreeSettings::Merging::rays
                             : ConeTreeSettings::Merging::cones;
}

}  // namespace

void read(const JsonNode& node, BeamTreeParams& params) {
    read_bound(node, params);
    if (const auto hierarchy = node.find("hierarchy"))
        params.hierarchy = hierarchy->as_choice({"quadtree", "binned"}) == 0
                               ? BeamTreeParams::Tree::quadtree
                               : BeamTreeParams::Tree::binned;
    if (const auto leaf = node.find("leaf"))
        params.leaf =
            leaf->as_choice({"n", "k"}) == 0 ? BeamTreeParams::Leaf::n : BeamTreeParams::Leaf::k;
    if (const auto intensity = node.find("intensity"))
        if (intensity->as_choice({"area", "refined"}) == 1)
            intensity->fail("\"refined\" is not built yet (built: \"area\")");
    read_beam_params(node, params);
    node.finish();
}

}  // namespace caustics
