#include "photonmap/photons/photon_map_params.h"

#include <cmath>
#include <string>

namespace caustics {

namespace {

constexpr std::int64_t most_photons = 2'000'000'000;
constexpr std::int64_t most_paths = 1'000'000'000'000;
constexpr std::int64_t most_bounces = 1'000;
constexpr std::int64_t most_nearest = 1'000'000;
constexpr std::int64_t most_passes = 100'000;

constexpr FilterKind filter_kinds[] = {FilterKind::none, FilterKind::cone, FilterKind::gaussian,
                                       FilterKind::epanechnikov};
constexpr TreeKind tree_kinds[] = {TreeKind::balanced, TreeKind::unbalanced, TreeKind::packed};

std::filesystem::path file_name(const JsonNode& node) {
    const std::string name = node.as_string();
    if (name.empty()) node.fail("must name a file");
    return (node.file().parent_path() / name).lexically_normal();
}

void read_files(const JsonNode& node, PhotonMapParams& params) {
    const std::optional<JsonNode> save = node.find("save");
    const std::optional<JsonNode> load = node.find("load");
    if (save) params.save = file_name(*save);
    if (!load) return;
    params.load = file_name(*load);
    params.photons = 0;
    for (const char* key : {"save", "photons", "emitted", "emission", "interaction", "max_bounces"})
        if (const std::optional<JsonNode> given = node.find(key))
            given->fail("cannot be given with load: the photons of " + params.load.string() +
                        " are there already, traced as that file says");
}

void read_count(const JsonNode& node, PhotonMapParams& params) {
    const std::optional<JsonNode> photons = node.find("photons");
    const std::optional<JsonNode> emitted = node.find("emitted");
    if (photons && emitted) emitted->fail("give either photons or emitted, not both");
    if (photons)
        params.photons = static_cast<std::uint64_t>(photons->as_integer_in(1, most_photons));
    if (emitted) {
        params.emitted = static_cast<std::uint64_t>(emitted->as_integer_in(1, most_paths));
        params.photons = 0;
    }
}

double length(const JsonNode& node, const std::string& otherwise) {
    const double value = node.as_number();
    const auto stored = static_cast<float>(value);
    // The square must be a float above 0 too: that is what distances are compared with.
    if (!(stored > 0 && stored * stored > 0) || !std::isfinite(stored * stored))
        node.fail("must be a length above 0 [m] (" + otherwise + ")");
    return value;
}

void read_estimate(const JsonNode& node, PhotonMapParams& params) {
    using Estimator = PhotonMapParams::Estimator;
    if (const auto estimator = node.find("estimator"))
        params.estimator =
            estimator->as_choice({"unbiased", "raw"}) == 0 ? Estimator::unbiased : Estimator::raw;
    if (const auto adaptive = node.find("adaptive")) params.adaptive = adaptive->as_bool();
    if (params.adaptive) params.nearest = PhotonMapParams::default_adaptive_nearest;
    if (const auto nearest = node.find("nearest")) {
        params.nearest = static_cast<int>(nearest->as_integer_in(1, most_nearest));
        if (params.nearest < 2 && params.estimator == Estimator::unbiased)
            nearest->fail(
                "must be at least 2 with the estimator \"unbiased\", which leaves the "
                "outermost photon out (or choose \"raw\")");
        if (params.adaptive)
            nearest->as_integer_in(PhotonMapParams::least_adaptive_nearest,
                                   PhotonMapParams::most_adaptive_nearest);
    }
    if (const auto max_radius = node.find("max_radius"))
        params.max_radius = length(*max_radius, "leave it out to have it chosen");
}

void read_radius(const JsonNode& node, PhotonMapParams& params) {
    const auto radius = node.find("radius");
    if (!radius) return;
    for (const char* const other : {"nearest", "max_radius"})
        if (node.find(other))
            radius->fail(
                std::string("takes all photons within it, in place of the nearest: leave ") +
                other + " out, or radius");
    if (params.adaptive) radius->fail("leaves no N for adaptive to choose: leave one of them out");
    params.radius = length(*radius, "leave it out to take the nearest photons");
}

}  // namespace

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

void read(const JsonNode& node, PhotonMapParams& params) {
    read_count(node, params);
    read_estimate(node, params);
    read_radius(node, params);
    if (const auto filter = node.find("filter"))
        params.filter =
            filter_kinds[filter->as_choice({name(filter_kinds[0]), name(filter_kinds[1]),
                                            name(filter_kinds[2]), name(filter_kinds[3])})];
    read_files(node, params);
    if (const auto max_bounces = node.find("max_bounces"))
        params.max_bounces = static_cast<int>(max_bounces->as_integer_in(1, most_bounces));
    if (const auto emission = node.find("emission"))
        params.emission = emission->as_choice({"random", "stratified"}) == 0
                              ? PhotonMapParams::Emission::random
                              : PhotonMapParams::Emission::stratified;
    if (const auto interaction = node.find("interaction"))
        params.interaction = interaction->as_choice({"roulette", "split"}) == 0
                                 ? Interaction::roulette
                                 : Interaction::split;
    if (const auto tree = node.find("tree"))
        params.tree = tree_kinds[tree->as_choice(
            {name(tree_kinds[0]), name(tree_kinds[1]), name(tree_kinds[2])})];
    if (const auto tables = node.find("tables")) params.tables = tables->as_bool();
    if (const auto passes = node.find("passes"))
        params.passes = static_cast<int>(passes->as_integer_in(1, most_passes));
    if (params.passes > 1)
        for (const char* key : {"save", "load"})
            if (const auto given = node.find(key))
                given->fail("cannot be given with several passes, each of which has its own map");
    node.finish();
}

}  // namespace caustics
