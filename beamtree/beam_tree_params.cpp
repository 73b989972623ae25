#include <cmath>

#include "beamtree/beam_tree_params.h"

namespace caustics {

namespace {

void read_bound(const JsonNode& node, BeamTreeParams& params) {
    constexpr Bound bounds[] = {Bound::single, Bound::double_cone, Bound::hybrid,
                                Bound::sphere_swept, Bound::two_slice};
    if (const auto bound = node.find("bound"))
        params.bound =
            bounds[bound->as_choice({"single", "double", "hybrid", "sphere_swept", "two_slice"})];
    if (const auto threshold = node.find("spread_threshold")) {
        params.spread_threshold = threshold->as_number_in(0, 90);
        if (params.bound != Bound::hybrid)
            threshold->fail("only the bound \"hybrid\" has a spread threshold");
    }
    if (const auto merging = node.find("merging")) {
        params.merging = merging->as_choice({"rays", "cones"}) == 0
                             ? ConeTreeSettings::Merging::rays
                             : ConeTreeSettings::Merging::cones;
        if (params.bound == Bound::two_slice && params.merging == ConeTreeSettings::Merging::cones)
            merging->fail("the bound \"two_slice\" has no cones to merge (take \"rays\")");
    }
}

// What fits the bound: boxes on planes across a fixed normal bound nothing on other planes, and do
// best with the hierarchy that is split by them.
void read_tree(const JsonNode& node, BeamTreeParams& params) {
    if (params.bound == Bound::two_slice) {
        params.hierarchy = BeamTreeParams::Tree::binned;
        params.leaf = BeamTreeParams::Leaf::k;
    }
    if (const auto hierarchy = node.find("hierarchy"))
        params.hierarchy = hierarchy->as_choice({"quadtree", "binned"}) == 0
                               ? BeamTreeParams::Tree::quadtree
                               : BeamTreeParams::Tree::binned;
    if (const auto leaf = node.find("leaf")) {
        params.leaf =
            leaf->as_choice({"n", "k"}) == 0 ? BeamTreeParams::Leaf::n : BeamTreeParams::Leaf::k;
        if (params.bound == Bound::two_slice && params.leaf == BeamTreeParams::Leaf::n)
            leaf->fail(
                "the bound \"two_slice\" would lose light with \"n\": it holds beams only on "
                "planes "
                "across a fixed normal (take \"k\", or another bound)");
    }
}

void read_footprint(const JsonNode& footprint, BeamTreeParams& params) {
    params.footprint = static_cast<float>(footprint.as_number());
    const float area = params.footprint * params.footprint;
    if (!(params.footprint > 0 && area > 0 && std::isfinite(area)))
        footprint.fail("must be a length above 0 [m] (leave it out to ask at points)");
    if (params.bound != Bound::two_slice)
        footprint.fail("only the bound \"two_slice\" averages over squares of its planes");
}

}  // namespace

void read(const JsonNode& node, BeamTreeParams& params) {
    read_bound(node, params);
    read_tree(node, params);
    if (const auto intensity = node.find("intensity"))
        params.intensity =
            intensity->as_choice({"area", "refined"}) == 0 ? Intensity::area : Intensity::refined;
    if (const auto footprint = node.find("footprint")) read_footprint(*footprint, params);
    read_beam_params(node, params);
    node.finish();
}

}  // namespace caustics
