#include "experiments/run/methods.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "experiments/base/interrupt.h"
#include "photonmap/photons/photon_map_file.h"

namespace caustics {

namespace {

using nlohmann::json;

void read(const JsonNode& node, NoneParams&) { node.finish(); }

json describe_params(const NoneParams&) { return json::object(); }

json describe_params(const PathTraceParams& p) {
    return {{"spp", p.spp}, {"max_bounces", p.max_bounces}};
}

json describe_params(const LightTraceParams& p) {
    json all = {{"paths", p.paths}, {"max_bounces", p.max_bounces}};
    if (p.radius > 0) all["radius"] = p.radius;
    return all;
}

json describe_params(const PhotonMapParams& p) {
    const bool unbiased = p.estimator == PhotonMapParams::Estimator::unbiased;
    const bool stratified = p.emission == PhotonMapParams::Emission::stratified;
    json all = {{"estimator", unbiased ? "unbiased" : "raw"},
                {"filter", name(p.filter)},
                {"adaptive", p.adaptive},
                {"passes", p.passes},
                {"max_bounces", p.max_bounces},
                {"emission", stratified ? "stratified" : "random"},
                {"interaction", p.interaction == Interaction::split ? "split" : "roulette"},
                {"tree", name(p.tree)},
                {"tables", p.tables}};
    if (p.radius > 0)
        all["radius"] = p.radius;
    else
        all["nearest"] = p.nearest;
    if (p.photons > 0) all["photons"] = p.photons;
    if (p.emitted > 0) all["emitted"] = p.emitted;
    if (p.max_radius > 0) all["max_radius"] = p.max_radius;
    if (!p.save.empty()) all["save"] = p.save.string();
    if (p.load.empty()) return all;
    all["load"] = p.load.string();
    for (const char* of_the_file : {"max_bounces", "emission", "interaction"})
        all.erase(of_the_file);
    return all;
}

const char* name(PolygonKind kind) { return kind == PolygonKind::quad ? "quads" : "triangles"; }

json describe_params(const BeamTreeParams& p) {
    constexpr const char* bounds[] = {"single", "double", "hybrid", "sphere_swept", "two_slice"};
    const bool rays = p.merging == ConeTreeSettings::Merging::rays;
    json all = {
        {"bound", bounds[static_cast<std::size_t>(p.bound)]},
        {"merging", rays ? "rays" : "cones"},
        {"hierarchy", p.hierarchy == BeamTreeParams::Tree::quadtree ? "quadtree" : "binned"},
        {"leaf", p.leaf == BeamTreeParams::Leaf::n ? "n" : "k"},
        {"intensity", p.intensity == Intensity::refined ? "refined" : "area"},
        {"polygons", name(p.polygons)},
        {"light_samples", p.light_samples},
        {"mesh_resolution", p.mesh_resolution},
        {"max_bounces", p.max_bounces}};
    if (p.bound == Bound::hybrid) all["spread_threshold"] = p.spread_threshold;
    if (p.footprint > 0) all["footprint"] = p.footprint;
    return all;
}

json describe_params(const IlluminationMapParams& p) {
    return {{"emitted", p.emitted}, {"resolution", p.resolution}, {"max_bounces", p.max_bounces}};
}

json describe_params(const CausticPolygonsParams& p) {
    return {{"polygons", name(p.polygons)},
            {"light_samples", p.light_samples},
            {"mesh_resolution", p.mesh_resolution},
            {"receiver_resolution", p.receiver_resolution},
            {"max_bounces", p.max_bounces}};
}

template <typename Params>
MethodParams read_params(const JsonNode& node) {
    Params params;
    read(node, params);
    return params;
}

struct Entry {
    const char* name;
    MethodParams (*read)(const JsonNode&);
};
constexpr Entry entries[] = {{"none", read_params<NoneParams>},
                             {"pathtrace", read_params<PathTraceParams>},
                             {"lighttrace", read_params<LightTraceParams>},
                             {"photonmap", read_params<PhotonMapParams>},
                             {"beamtree", read_params<BeamTreeParams>},
                             {"illuminationmap", read_params<IlluminationMapParams>},
                             {"causticpolygons", read_params<CausticPolygonsParams>}};
static_assert(std::size(entries) == std::variant_size_v<MethodParams>);

/// The same method where building it costs next to nothing: what it can serve does not depend on
/// how much work it is given.
MethodParams with_least_work(MethodParams params) {
    if (auto* const map = std::get_if<PhotonMapParams>(&params)) {
        map->photons = std::min<std::uint64_t>(map->photons, 1);
        map->emitted = std::min<std::uint64_t>(map->emitted, 1);
        map->save.clear();
    }
    if (auto* const texels = std::get_if<IlluminationMapParams>(&params)) texels->emitted = 1;
    if (auto* const beams = std::get_if<BeamTreeParams>(&params)) beams->light_samples = 1;
    if (auto* const polygons = std::get_if<CausticPolygonsParams>(&params)) {
        polygons->light_samples = 1;
        polygons->receiver_resolution = 2;
    }
    return params;
}

}  // namespace

const std::vector<std::string>& method_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const Entry& entry : entries) all.emplace_back(entry.name);
        return all;
    }();
    return names;
}

Method parse_method(const std::string& name, const JsonNode& params) {
    for (const Entry& entry : entries)
        if (name == entry.name) return {name, entry.read(params)};
    throw InputError(
        fmt::format("unknown method \"{}\" (known: {})", name, fmt::join(method_names(), ", ")));
}

JsonNode parameters_node(const std::vector<std::string>& assignments) {
    json object = json::object();
    for (const std::string& assignment : assignments) {
        const std::size_t equals = assignment.find('=');
        if (equals == std::string::npos || equals == 0)
            throw InputError(fmt::format("--param \"{}\": expected key=value", assignment));
        const std::string key = assignment.substr(0, equals);
        const std::string text = assignment.substr(equals + 1);
        if (object.contains(key)) throw InputError(fmt::format("--param \"{}\": given twice", key));
        json value = json::parse(text, nullptr, false);
        object[key] = value.is_discarded() ? json(text) : std::move(value);
    }
    return JsonNode::parse_text(object.dump(), "--param");
}

json describe(const Method& method) {
    return std::visit([](const auto& params) { return describe_params(params); }, method.params);
}

std::map<std::string, std::string> files_read(const Method& method) {
    const auto* const map = std::get_if<PhotonMapParams>(&method.params);
    if (map == nullptr || map->load.empty()) return {};
    return {{"load", hex(photon_map_checksum(map->load))}};
}

json identity(const Method& method) {
    json all = describe(method);
    for (const auto& [parameter, hash] : files_read(method)) all[parameter] = hash;
    return all;
}

bool writes_files(const Method& method) {
    const auto* const map = std::get_if<PhotonMapParams>(&method.params);
    return map != nullptr && !map->save.empty();
}

int pass_count(const Method& method) {
    return std::visit(
        [](const auto& params) {
            if constexpr (requires { params.passes; })
                return params.passes;
            else
                return 1;
        },
        method.params);
}

std::unique_ptr<const CausticEstimator> build(const Scene& scene, const Method& method,
                                              const RunOptions& options, int pass) {
    return std::visit(
        [&](const auto& params) {
            if constexpr (requires { params.passes; })
                return build_pass(scene, params, options, pass);
            else
                return build(scene, params, options);
        },
        method.params);
}

std::optional<std::string> why_unsupported(const Scene& scene, const Method& method) {
    RunOptions options;
    options.progress = [](double) { throw_if_interrupted(); };
    try {
        build(scene, {method.name, with_least_work(method.params)}, options);
        return {};
    } catch (const UnsupportedScene& unsupported) {
        return unsupported.what();
    }
}

bool gathers_over_discs(const Method& method) {
    return std::holds_alternative<LightTraceParams>(method.params);
}

double disc_radius(const Method& method) {
    const auto* const params = std::get_if<LightTraceParams>(&method.params);
    return params == nullptr ? 0 : params->radius;
}

}  // namespace caustics
