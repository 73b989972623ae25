#include "beamtree/beam_tree_method.h"

#include "beamtree/beam_param_table.h"

namespace caustics::beamtree {

namespace {

using P = BeamTreeParams;
using Merging = ConeTreeSettings::Merging;

std::vector<Parameter<P>> tree_parameters() {
    return {
        parameter::choice<P>(&P::bound,
                             {{"single", Bound::single},
                              {"double", Bound::double_cone},
                              {"hybrid", Bound::hybrid},
                              {"sphere_swept", Bound::sphere_swept},
                              {"two_slice", Bound::two_slice}},
                             {.key = "bound",
                              .meaning = "What bounds the beams below a node of the tree.",
                              .source = "[CC95 (1)-(3)]"}),
        parameter::number<P>(
            &P::spread_threshold, 0, 90,
            {.key = "spread_threshold",
             .meaning = "With the bound hybrid: spread up to which a node's cone is double.",
             .unit = "degrees",
             .source = "[CC95 sec. 3.1]"})
            .only_if([](const P& p) { return p.bound == Bound::hybrid; }),
        parameter::choice<P>(
            &P::merging, {{"rays", Merging::rays}, {"cones", Merging::cones}},
            {.key = "merging",
             .meaning = "Makes a node's cone from all rays below it, or from its children's cones.",
             .source = "[CC95 (4)-(10)]"}),
        parameter::choice<P>(
            &P::hierarchy, {{"quadtree", P::Tree::quadtree}, {"binned", P::Tree::binned}},
            {.key = "hierarchy",
             .meaning = "The caster's own subdivision, or a tree of any polygons; with two_slice "
                        "usually binned.",
             .source = "[CC95 sec. 3.1]"}),
        parameter::choice<P>(&P::leaf, {{"receiver", P::Leaf::n, "n"}, {"fixed", P::Leaf::k, "k"}},
                             {.key = "leaf",
                              .meaning = "Plane of the caustic polygons: across the receiver's "
                                         "normal, or (always with two_slice) fixed.",
                              .source = "[CC95 3.2.2]"}),
        parameter::choice<P>(
            &P::intensity, {{"area", Intensity::area}, {"refined", Intensity::refined}},
            {.key = "intensity",
             .meaning =
                 "Flux over the area of the caustic polygon, or refined at the specular point.",
             .source = "[CC95 (11)]"}),
        parameter::optional_length<P>(&P::footprint, "leave it out to ask at points",
                                      {.key = "footprint",
                                       .meaning = "With two_slice: side of the square round a "
                                                  "point that irradiance is averaged over."})
            .usually("none"),
        parameter::choice<P>(
            &P::dispersion, {{"bins", Dispersion::bins}, {"intervals", Dispersion::intervals}},
            {.key = "dispersion",
             .meaning = "All light of a part of the wavelengths goes one way, or a point asks for "
                        "which of them a caustic polygon holds it.",
             .source = "[C11]"})
            .only_if([](const P& p) { return p.dispersion != Dispersion::bins; })};
}

void settle_bound(const JsonNode& node, const P& params) {
    if (const auto threshold = node.find("spread_threshold"))
        if (params.bound != Bound::hybrid)
            threshold->fail("only the bound \"hybrid\" has a spread threshold");
    if (params.bound == Bound::two_slice && params.merging == Merging::cones)
        node.at("merging").fail("the bound \"two_slice\" has no cones to merge (take \"rays\")");
    if (const auto footprint = node.find("footprint"))
        if (params.bound != Bound::two_slice)
            footprint->fail("only the bound \"two_slice\" averages over squares of its planes");
    if (params.dispersion == Dispersion::intervals && params.footprint > 0)
        node.at("dispersion").fail("intervals are of points, not of squares (leave out footprint)");
}

// What fits the bound: boxes on planes across a fixed normal bound nothing on other planes, and do
// best with the hierarchy that is split by them.
void settle_tree(const JsonNode& node, P& params) {
    if (params.bound != Bound::two_slice) return;
    if (!node.has("hierarchy")) params.hierarchy = P::Tree::binned;
    if (const auto leaf = node.find("leaf"); leaf && params.leaf == P::Leaf::n)
        leaf->fail(
            "the bound \"two_slice\" would lose light with \"receiver\": it holds beams only on "
            "planes across a fixed normal (take \"fixed\", or another bound)");
    params.leaf = P::Leaf::k;
}

}  // namespace

const DescribedMethod<BeamTreeParams>& beamtree_method() {
    static const DescribedMethod<P> method(
        {.facts = {.name = "beamtree",
                   .summary = "Chuang and Cheng 1995: beams of specular polygons, found through a "
                              "tree of cones",
                   .serves = "every scene; on coarse meshes beams lose light, and the record "
                             "says how much",
                   .effort = {"mesh_resolution=64"},
                   .more_effort = {"mesh_resolution=128"}},
         .parameters = joined(tree_parameters(), beam_param_table<P>()),
         .settle =
             [](const JsonNode& node, P& params) {
                 settle_bound(node, params);
                 settle_tree(node, params);
             },
         .take_least_work = [](P& params) { params.sampled = true; }});
    return method;
}

}  // namespace caustics::beamtree
