#include "photonmap/photon_map_method.h"

#include <algorithm>
#include <array>
#include <string>

#include "photonmap/photons/photon_map_file.h"

namespace caustics::photonmap {

namespace {

using P = PhotonMapParams;

constexpr std::int64_t most_stored = 2'000'000'000;
constexpr std::int64_t most_paths = 1'000'000'000'000;
constexpr std::int64_t most_nearest = 1'000'000;
constexpr std::int64_t most_passes = 100'000;

bool is_traced(const P& params) { return params.load.empty(); }

std::vector<Parameter<P>> photon_parameters() {
    return {
        parameter::preset<P>(
            &P::preset, {{"jensen1996", P::jensen1996}},
            {.key = "preset",
             .meaning =
                 "Takes the paper's settings in place of the defaults: balanced, raw, 16 events.",
             .source = "[J96]"}),
        parameter::whole_number<P>(
            &P::photons, 1, most_stored,
            {.key = "photons",
             .meaning = "Photons to store; light paths are traced until so many are.",
             .unit = "photons",
             .source = "[J96 sec. 2]"})
            .only_if([](const P& p) { return p.photons > 0; }),
        parameter::whole_number<P>(&P::emitted, 1, most_paths,
                                   {.key = "emitted",
                                    .meaning = "Light paths to emit, in place of photons.",
                                    .unit = "paths"})
            .only_if([](const P& p) { return p.emitted > 0; })
            .usually("none"),
        parameter::choice<P>(
            &P::emission,
            {{"random", P::Emission::random}, {"stratified", P::Emission::stratified}},
            {.key = "emission",
             .meaning =
                 "Draws light paths at random, or spread evenly: one from each stratum, or from a "
                 "lamp by low-discrepancy points. That has less noise, but with kernel point the "
                 "nearest N then read up to 1/(2N) low.",
             .source = "[J96 sec. 2]"})
            .only_if(is_traced)
            .usually("stratified; random with kernel point"),
        parameter::choice<P>(&P::interaction,
                             {{"roulette", Interaction::roulette}, {"split", Interaction::split}},
                             {.key = "interaction",
                              .meaning = "At glass, follows one way by Russian roulette, or both.",
                              .source = "[J96 sec. 2]"})
            .only_if(is_traced),
        parameter::max_bounces<P>().only_if(is_traced),
        parameter::written_file<P>(
            &P::save, {.key = "save",
                       .meaning = "File that the traced photons are written to; not in sweeps."}),
        parameter::read_file<P>(
            &P::load, photon_map_checksum,
            {.key = "load",
             .meaning = "File that the photons come from, in place of being traced."})};
}

std::vector<Parameter<P>> estimate_parameters() {
    return {
        parameter::choice<P>(
            &P::kernel, {{"photon", KernelKind::photon}, {"point", KernelKind::point}},
            {.key = "kernel",
             .meaning =
                 "Spreads each photon's light over a disc up to its own N-th neighbour, which "
                 "keeps its sum; or takes a point's N nearest over their disc, which makes "
                 "light where its density is uneven. Adaptive, filter_alpha, the estimator raw and "
                 "trees other than packed belong to point.",
             .source = "[Breiman, Meisel & Purcell 1977; Abramson 1982; J96 (4)]"})
            .only_if([](const P& p) { return p.kernel == KernelKind::photon; })
            .usually("photon, or point where a key belongs to it"),
        parameter::choice<P>(
            &P::tree,
            {{name(TreeKind::balanced), TreeKind::balanced},
             {name(TreeKind::unbalanced), TreeKind::unbalanced},
             {name(TreeKind::packed), TreeKind::packed}},
            {.key = "tree",
             .meaning =
                 "How photons are ordered for finding the nearest; all give the same answers.",
             .source = "[J96 sec. 2]"}),
        parameter::whole_number<P>(
            &P::nearest, 1, most_nearest,
            {.key = "nearest",
             .meaning = "N, the photons of an estimate, or the neighbours within a photon's own "
                        "disc; where adaptive, the most (usually 200).",
             .unit = "photons",
             .source = "[J96 (3)]"})
            .only_if([](const P& p) { return !(p.radius > 0); }),
        parameter::yes_or_no<P>(&P::adaptive,
                                {.key = "adaptive",
                                 .meaning = "With kernel point: takes fewer than N photons where "
                                            "they lie unevenly.",
                                 .source = "[J96 sec. 5]"}),
        parameter::optional_length<P>(&P::max_radius, "leave it out to have it chosen",
                                      {.key = "max_radius",
                                       .meaning = "Farthest photon of an estimate.",
                                       .source = "[J96 sec. 3]"})
            .usually("chosen"),
        parameter::optional_length<P>(
            &P::radius, "leave it out to take the nearest photons",
            {.key = "radius",
             .meaning = "Takes all photons within it, in place of nearest and max_radius."})
            .usually("none"),
        parameter::optional_length<P>(
            &P::footprint, "leave it out to ask at points",
            {.key = "footprint",
             .meaning = "Side of the square round a point that the estimate is averaged over."})
            .usually("none"),
        parameter::yes_or_no<P>(
            &P::pixel_footprint,
            {.key = "pixel_footprint",
             .meaning = "With kernel photon: averages over each pixel as the camera sees it on the "
                        "receiver; what mirrors, glass and edges show is asked at points."})
            .only_if([](const P& p) { return p.kernel == KernelKind::photon && p.footprint == 0; }),
        parameter::choice<P>(&P::filter,
                             {{name(FilterKind::none), FilterKind::none},
                              {name(FilterKind::cone), FilterKind::cone},
                              {name(FilterKind::gaussian), FilterKind::gaussian},
                              {name(FilterKind::epanechnikov), FilterKind::epanechnikov}},
                             {.key = "filter",
                              .meaning = "How photons weigh by their distance.",
                              .source = "[Jensen 2001; Epanechnikov 1969; Silverman 1986]"})
            .usually("epanechnikov; none with kernel point"),
        parameter::number<P>(&P::filter_k, 1, 1000,
                             {.key = "filter_k",
                              .meaning = "Of the filter cone: its weight is 0 at so many radii.",
                              .source = "[Jensen 2001]"})
            .only_if([](const P& p) { return p.filter_k != P{}.filter_k; }),
        parameter::number<P>(&P::filter_beta, 0.1, 8,
                             {.key = "filter_beta",
                              .meaning = "Of the filter gaussian: how steeply it falls off.",
                              .source = "[Jensen 2001]"})
            .only_if([](const P& p) { return p.filter_beta != P{}.filter_beta; }),
        parameter::number<P>(
            &P::filter_alpha, 0.001, 100,
            {.key = "filter_alpha",
             .meaning = "Of the filter gaussian as printed, whose mean is not 1: 0.918 there.",
             .source = "[Jensen 2001]"})
            .only_if([](const P& p) { return p.filter_alpha > 0; })
            .usually("normalised"),
        parameter::choice<P>(&P::estimator,
                             {{"unbiased", P::Estimator::unbiased}, {"raw", P::Estimator::raw}},
                             {.key = "estimator",
                              .meaning = "Leaves the outermost photon out, or is the equation as "
                                         "printed, which reads high.",
                              .source = "[J96 (4)]"}),
        parameter::whole_number<P>(
            &P::passes, 1, most_passes,
            {.key = "passes",
             .meaning =
                 "Maps that are averaged, one after another, with smaller and smaller discs.",
             .unit = "maps",
             .source = "[Knaus & Zwicker 2011]"}),
        parameter::yes_or_no<P>(
            &P::tables, {.key = "tables",
                         .meaning = "Shades by tables over the directions that photons can have.",
                         .source = "[J96 sec. 5]"})};
}

void settle_files(const JsonNode& node, P& params) {
    if (node.has("load")) {
        params.photons = 0;
        for (const char* key :
             {"save", "photons", "emitted", "emission", "interaction", "max_bounces"})
            if (const std::optional<JsonNode> given = node.find(key))
                given->fail("cannot be given with load: the photons of " + params.load.string() +
                            " are there already, traced as that file says");
    }
    if (params.passes > 1)
        for (const char* key : {"save", "load"})
            if (const auto given = node.find(key))
                given->fail("cannot be given with several passes, each of which has its own map");
}

void settle_nearest(const JsonNode& node, P& params) {
    const auto nearest = node.find("nearest");
    if (!nearest) {
        if (params.adaptive) params.nearest = P::default_adaptive_nearest;
        return;
    }
    if (params.nearest < 2 && params.estimator == P::Estimator::unbiased)
        nearest->fail(
            "must be at least 2 with the estimator \"unbiased\", which leaves the "
            "outermost photon out (or choose \"raw\")");
    if (params.adaptive)
        nearest->as_integer_in(P::least_adaptive_nearest, P::most_adaptive_nearest);
}

void settle_filter(const JsonNode& node, const P& params) {
    if (const auto k = node.find("filter_k"); k && params.filter != FilterKind::cone)
        k->fail("belongs to the filter cone");
    for (const char* const key : {"filter_beta", "filter_alpha"})
        if (const auto given = node.find(key); given && params.filter != FilterKind::gaussian)
            given->fail("belongs to the filter gaussian");
}

void settle_radius(const JsonNode& node, P& params) {
    const auto radius = node.find("radius");
    if (!radius) return;
    for (const char* const other : {"nearest", "max_radius"})
        if (node.has(other))
            radius->fail(
                std::string("takes all photons within it, in place of the nearest: leave ") +
                other + " out, or radius");
    if (params.adaptive) radius->fail("leaves no N for adaptive to choose: leave one of them out");
}

/// What the kernel "point" alone has: the key that asks for it, and why no other kernel does.
struct PointKey {
    const char* key;
    bool asked;
    const char* reason;
};

std::array<PointKey, 4> point_keys(const JsonNode& node, const P& params) {
    return {{{"tree", params.tree != TreeKind::packed,
              "photons' own discs are kept by the tree \"packed\""},
             {"adaptive", params.adaptive, "it chooses N at a point"},
             {"estimator", params.estimator == P::Estimator::raw,
              "\"raw\" is the equation of a point's N nearest"},
             {"filter_alpha", node.has("filter_alpha"),
              "with it the filter's mean is not 1, and light is not kept"}}};
}

// Keys that the kernel "point" alone has choose it. The kernel chooses how photons are emitted and filtered.
void settle_kernel(const JsonNode& node, P& params) {
    for (const PointKey& each : point_keys(node, params)) {
        if (!each.asked || params.kernel == KernelKind::point) continue;
        if (node.has("kernel"))
            node.at(node.has(each.key) ? each.key : "kernel")
                .fail(std::string("belongs to the kernel \"point\": ") + each.reason +
                      " (leave out " + each.key + ", or kernel)");
        params.kernel = KernelKind::point;
    }
    if (params.kernel == KernelKind::photon) {
        if (!node.has("filter")) params.filter = FilterKind::epanechnikov;
        if (!node.has("emission")) params.emission = P::Emission::stratified;
    }
    const auto pixels = node.find("pixel_footprint");
    if (!pixels) return;
    if (params.kernel == KernelKind::point)
        pixels->fail("only the kernel \"photon\" averages over pixels (or give a footprint)");
    if (params.footprint > 0 && params.pixel_footprint)
        pixels->fail("footprint asks for squares of its own (leave one of the two out)");
}

void settle_footprint(const JsonNode& node, const P& params) {
    const auto footprint = node.find("footprint");
    if (!footprint) return;
    if (params.adaptive)
        footprint->fail(
            "averages over squares, whose photons adaptive does not choose: leave one of them out");
    if (params.estimator == P::Estimator::raw)
        footprint->fail(
            "has no equation of the estimator \"raw\" (leave it out, or take \"unbiased\")");
    if (const auto alpha = node.find("filter_alpha"))
        alpha->fail("is of the filter as printed, whose mean is not 1: not with footprint");
}

void settle(const JsonNode& node, P& params) {
    if (const auto emitted = node.find("emitted")) {
        if (node.has("photons")) emitted->fail("give either photons or emitted, not both");
        params.photons = 0;
    }
    settle_nearest(node, params);
    settle_radius(node, params);
    settle_filter(node, params);
    settle_kernel(node, params);
    settle_footprint(node, params);
    settle_files(node, params);
}

}  // namespace

const DescribedMethod<PhotonMapParams>& photonmap_method() {
    static const DescribedMethod<P> method(
        {.facts = {.name = "photonmap",
                   .summary = "Jensen 1996: photons aimed at the casters, each spread over a disc "
                              "up to its N-th "
                              "neighbour, or the N nearest of a point as in the paper",
                   .serves = "every scene; without light on casters by `emitted` alone",
                   .work = {.parameter = "photons",
                            .instead = "emitted",
                            .first = 1000,
                            .most = 1'000'000'000}},
         .parameters = joined(photon_parameters(), estimate_parameters()),
         .settle = settle,
         .take_least_work =
             [](P& params) {
                 params.photons = std::min<std::uint64_t>(params.photons, 1);
                 params.emitted = std::min<std::uint64_t>(params.emitted, 1);
                 params.save.clear();
             },
         .take_share =
             [](P& params, double share) {
                 params.save.clear();
                 if (!is_traced(params)) return 1.0;
                 return take_share_of(params.photons > 0 ? params.photons : params.emitted, share);
             },
         .make = build_pass,
         .passes = &P::passes});
    return method;
}

}  // namespace caustics::photonmap
