#include "beamtree/beam_tree_method.h"

#include <algorithm>
#include <array>

#include "beamtree/beam_param_table.h"

namespace caustics::beamtree {

namespace {

using P = BeamTreeParams;
using Merging = ConeTreeSettings::Merging;

bool has_own_rest(const P& p) {
    return p.rest == P::Rest::photons ||
           (p.rest != P::Rest::none &&
            (p.rest_photons != P{}.rest_photons || p.rest_nearest != P{}.rest_nearest));
}

std::vector<Parameter<P>> tree_parameters() {
    return {
        parameter::preset<P>(
            &P::preset, {{"chuang1995", P::chuang1995}},
            {.key = "preset",
             .meaning =
                 "Takes the paper's settings in place of the defaults: hybrid, cones, quadtree, "
                 "receiver, area, 16 events.",
             .source = "[CC95]"}),
        parameter::choice<P>(&P::bound,
                             {{"single", Bound::single},
                              {"double", Bound::double_cone},
                              {"hybrid", Bound::hybrid},
                              {"sphere_swept", Bound::sphere_swept},
                              {"two_slice", Bound::two_slice}},
                             {.key = "bound",
                              .meaning = "What bounds the beams below a node of the tree. Where a "
                                         "parameter of cones is given, usually hybrid.",
                              .source = "[CC95 (1)-(3)]"}),
        parameter::number<P>(
            &P::spread_threshold, 0, 90,
            {.key = "spread_threshold",
             .meaning = "With the bound hybrid: spread from which on a node's cone is double.",
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
             .meaning =
                 "The caster's own subdivision (usual with cones), or a tree of any polygons.",
             .source = "[CC95 sec. 3.1]"}),
        parameter::choice<P>(&P::leaf,
                             {{"receiver", P::Leaf::receiver, "n"}, {"fixed", P::Leaf::fixed, "k"}},
                             {.key = "leaf",
                              .meaning = "Plane of the caustic polygons: across the receiver's "
                                         "normal (usual with cones), or fixed.",
                              .source = "[CC95 sec. 3.2.2]"}),
        parameter::choice<P>(
            &P::intensity, {{"area", Intensity::area}, {"refined", Intensity::refined}},
            {.key = "intensity",
             .meaning =
                 "Flux over the area of the caustic polygon, or refined at the specular point.",
             .source = "[CC95 (11)]"}),
        parameter::whole_number<P>(
            &P::root_events, 1, most_bounces,
            {.key = "root_events",
             .meaning = "With refined, at points: rays of up to so many events are searched one by "
                        "one. Light of more events is spread over the images of its polygons. Each "
                        "event more takes several times as long."})
            .only_if([](const P& p) { return p.root_events != P{}.root_events; }),
        parameter::optional_length<P>(&P::footprint, "leave it out to ask at points",
                                      {.key = "footprint",
                                       .meaning = "With two_slice: side of the square round a "
                                                  "point, on its tangent plane, that irradiance is "
                                                  "averaged over."})
            .usually("none"),
        parameter::yes_or_no<P>(
            &P::pixel_footprint,
            {.key = "pixel_footprint",
             .meaning = "With two_slice: averages over each pixel as the camera sees it on the "
                        "receiver; what mirrors and glass show is asked at points."})
            .only_if([](const P& p) {
                return p.pixel_footprint || (p.rest == P::Rest::pencils &&
                                             p.bound == Bound::two_slice && p.footprint == 0);
            })
            .usually("true with rest pencils, else false"),
        parameter::choice<P>(
            &P::rest,
            {{"none", P::Rest::none},
             {"max_beams", P::Rest::max_beams},
             {"photons", P::Rest::photons},
             {"pencils", P::Rest::pencils}},
            {.key = "rest",
             .meaning =
                 "What becomes of light that no beam carries. none: it is lost. max_beams: photons "
                 "carry what max_beams leaves out. photons: they carry what prune leaves out, too, "
                 "and what polygons are too coarse for. pencils: beams carry the light that they "
                 "are good at (beam_events), and pencils of light paths all other. Where a "
                 "parameter of beams alone is given, usually max_beams."})
            .only_if([](const P& p) {
                return p.rest == P::Rest::photons || p.rest == P::Rest::pencils ||
                       (p.rest == P::Rest::none && p.preset.empty() &&
                        p.dispersion == Dispersion::bins);
            }),
        parameter::whole_number<P>(
            &P::beam_events, 0, preset_bounces,
            {.key = "beam_events",
             .meaning = "With pencils: beams carry the light of up to so many specular events. By "
                        "default of as many as cost little; the record has their number."})
            .only_if([](const P& p) { return p.beam_events != P::planned; })
            .usually("by a sample of the scene"),
        parameter::whole_number<P>(
            &P::pencils, 1, 1'000'000'000,
            {.key = "pencils",
             .meaning = "With rest pencils: their number, over all lights and casters. More are "
                        "smaller and nearer to the truth.",
             .unit = "pencils"})
            .only_if([](const P& p) { return p.rest == P::Rest::pencils; }),
        parameter::whole_number<P>(
            &P::rest_photons, 1, 1'000'000'000,
            {.key = "rest_photons",
             .meaning = "Paths for all light on casters; the light that photons carry takes its "
                        "share of them.",
             .unit = "photons"})
            .only_if(has_own_rest),
        parameter::whole_number<P>(
            &P::rest_nearest, 2, 10'000,
            {.key = "rest_nearest",
             .meaning = "A photon of rest spreads its light as far as so many others lie.",
             .unit = "photons"})
            .only_if(has_own_rest),
        parameter::choice<P>(
            &P::dispersion, {{"bins", Dispersion::bins}, {"intervals", Dispersion::intervals}},
            {.key = "dispersion",
             .meaning = "All light of a part of the wavelengths goes one way, or a point asks for "
                        "which of them a caustic polygon holds it.",
             .source = "[C11]"})
            .only_if([](const P& p) { return p.dispersion != Dispersion::bins; })};
}

// Cones are what the parameters ask for that belong to them alone.
bool asks_for_cones(const JsonNode& node, const P& params) {
    return node.has("spread_threshold") || (node.has("leaf") && params.leaf == P::Leaf::receiver) ||
           (node.has("merging") && params.merging == Merging::cones);
}

void settle_bound(const JsonNode& node, P& params) {
    if (!node.has("bound") && asks_for_cones(node, params)) params.bound = Bound::hybrid;
    if (const auto threshold = node.find("spread_threshold"))
        if (params.bound != Bound::hybrid)
            threshold->fail("only the bound \"hybrid\" has a spread threshold");
}

void settle_intensity(const JsonNode& node, const P& params) {
    const auto given = node.find("root_events");
    if (given && params.intensity != Intensity::refined)
        given->fail("only the intensity \"refined\" searches for rays");
}

// Averages over pixels are the default with pencils, where they can be; who asks about beams has points.
void settle_pixels(const JsonNode& node, P& params) {
    if (!node.has("pixel_footprint"))
        params.pixel_footprint = params.rest == P::Rest::pencils &&
                                 params.bound == Bound::two_slice && params.footprint == 0 &&
                                 params.dispersion == Dispersion::bins;
}

void settle_footprint(const JsonNode& node, const P& params) {
    for (const char* key : {"footprint", "pixel_footprint"})
        if (const auto given = node.find(key); given && params.bound != Bound::two_slice)
            given->fail("only the bound \"two_slice\" averages over squares of its planes");
    constexpr float least = 1e-15F;  // beyond it floats between a square and its beams hold nothing
    if (params.footprint > 0 && params.footprint < least)
        node.at("footprint").fail("must be 1e-15 m or more (leave it out to ask at points)");
    if (params.pixel_footprint && params.footprint > 0)
        node.at("pixel_footprint")
            .fail("footprint asks for squares of its own (leave one of the two out)");
    if (params.dispersion == Dispersion::intervals &&
        (params.footprint > 0 || params.pixel_footprint))
        node.at("dispersion")
            .fail(
                "intervals are of points, not of squares (leave out footprint and "
                "pixel_footprint)");
}

// Beams themselves are what some parameters ask about.
bool asks_for_beams(const JsonNode& node) {
    return std::ranges::any_of(
        std::array{"bound", "spread_threshold", "merging", "hierarchy", "leaf", "intensity",
                   "root_events", "mesh_resolution", "polygons", "prune", "max_beams"},
        [&](const char* key) { return node.has(key); });
}

void settle_rest(const JsonNode& node, P& params) {
    if (params.preset.empty() && !node.has("rest") && !node.has("beam_events") &&
        !node.has("pencils") && asks_for_beams(node))
        params.rest = P::Rest::max_beams;
    for (const char* key : {"beam_events", "pencils"})
        if (const auto given = node.find(key); given && params.rest != P::Rest::pencils)
            given->fail("only \"rest\": \"pencils\" shares light with beams");
    if (params.rest == P::Rest::none)
        for (const char* key : {"rest_photons", "rest_nearest"})
            if (const auto given = node.find(key))
                given->fail(
                    "\"rest\": \"none\" traces no photons (take \"max_beams\" or \"photons\")");
    // Pencils follow paths to their end; levels of beams cost too much for so many.
    if (params.rest == P::Rest::pencils && !node.has("max_bounces") &&
        params.dispersion == Dispersion::bins)
        params.max_bounces = most_bounces;
    if (params.dispersion != Dispersion::intervals) return;
    if (node.has("rest") && params.rest != P::Rest::none)
        node.at("dispersion").fail("photons complete no intervals (take \"bins\")");
    params.rest = P::Rest::none;
}

// What fits the bound: boxes on planes across a fixed normal bound nothing on other planes, have no
// cones to merge, and do best with the hierarchy that is split by them.
void settle_tree(const JsonNode& node, P& params) {
    const bool has_cones = params.bound != Bound::two_slice;
    if (const auto merging = node.find("merging");
        merging && !has_cones && params.merging == Merging::cones)
        merging->fail("the bound \"two_slice\" has no cones to merge (take \"rays\")");
    if (const auto leaf = node.find("leaf"); leaf && !has_cones && params.leaf == P::Leaf::receiver)
        leaf->fail(
            "the bound \"two_slice\" would lose light with \"receiver\": it holds beams only on "
            "planes across a fixed normal (take \"fixed\", or another bound)");
    if (!has_cones) params.merging = Merging::rays;
    if (!node.has("hierarchy")) params.hierarchy = has_cones ? P::Tree::quadtree : P::Tree::binned;
    if (!node.has("leaf")) params.leaf = has_cones ? P::Leaf::receiver : P::Leaf::fixed;
}

}  // namespace

const DescribedMethod<BeamTreeParams>& beamtree_method() {
    static const DescribedMethod<P> method(
        {.facts = {.name = "beamtree",
                   .summary = "Chuang and Cheng 1995: beams of specular polygons, found through a "
                              "tree of boxes on two planes, or of the paper's cones",
                   .serves = "every light but `constant`; on coarse meshes beams lose light, "
                             "and the record says how much",
                   .work = {.parameter = "mesh_resolution", .power = 2, .first = 8, .most = 4096}},
         .parameters = joined(tree_parameters(), beam_param_table<P>()),
         .settle =
             [](const JsonNode& node, P& params) {
                 settle_bound(node, params);
                 settle_intensity(node, params);
                 settle_rest(node, params);
                 settle_pixels(node, params);
                 settle_footprint(node, params);
                 settle_tree(node, params);
             },
         .take_least_work = [](P& params) { params.sampled = true; },
         .take_share =
             [](P& params, double share) {
                 params.polygon_share =
                     params.rest == P::Rest::pencils ? take_share_of(params.pencils, share) : share;
                 return params.polygon_share;
             },
         // Pencils are the light whose noise is seen, where beams carry any of it.
         .work = [](const MethodFacts& facts, const P& params) -> WorkParameter {
             if (params.rest != P::Rest::pencils) return facts.work;
             return {.parameter = "pencils", .first = 20'000, .most = 1'000'000'000};
         }});
    return method;
}

}  // namespace caustics::beamtree
