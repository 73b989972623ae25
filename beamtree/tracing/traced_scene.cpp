#include "beamtree/tracing/traced_scene.h"

#include <algorithm>
#include <span>
#include <stdexcept>

#include "beamtree/tracing/beam_lights.h"

namespace caustics::beamtree {
namespace {

// How far a point may lie off a receiver's bounds, of the scene's diameter.
constexpr float near_receiver = 1e-3F;
// What parts of polygons that are divided have of all light (of a pane of two triangles a millionth), or of a polygon's on
// average: of many polygons in many lights each has little, but facets part its light as widely.
constexpr double divided_share = 0x1p-20 / 2;
constexpr double least_divided = 0x1p-10;
// Paths that tell how much of the light that beams leave out would come to receivers.
constexpr std::uint64_t sampled_photons = 20'000;

double flux_of(std::span<const RestPhoton> photons) {
    double sum = 0;
    for (const RestPhoton& photon : photons) sum += static_cast<double>(photon.flux.mean());
    return sum;
}

// Light that is lost where polygons are too coarse is in no sample: it is taken to be like the rest.
double missed_light(double lost, double left_out, double sampled) {
    return left_out > 0 ? sampled * lost / left_out : lost;
}

// Sums up the photons of a sample and takes them out.
double take_sample(std::vector<RestPhoton>& photons) {
    const auto sample = std::stable_partition(photons.begin(), photons.end(),
                                              [](const RestPhoton& one) { return !one.is_sample; });
    const double sum = flux_of({sample, photons.end()});
    photons.erase(sample, photons.end());
    return sum;
}

// What photons carry is not lost.
void settle_balance(const Completion& completion, double sampled, FluxBalance& balance) {
    double left_out = balance.pruned + balance.over_budget;
    if (completion.photons > 0) {
        const double carried = completion.of_budget_alone ? balance.over_budget : left_out;
        balance.lost -= carried;
        left_out -= carried;
    }
    balance.missed = missed_light(balance.lost, left_out, sampled);
}

}  // namespace

BuildReport TracedScene::report() const {
    BuildReport report;
    std::uint64_t& beams = report.counters["beams"];
    for (const BeamSet& set : sets) {
        beams += set.beams.size();
        report.bytes += set.bytes();
    }
    report.counters["beams_unreceived"] = unreceived;
    double flat = 0;
    double tessellated = 0;
    double closed = 0;
    double quads = 0;
    for (const CasterMesh& caster : casters) {
        report.counters["polygons"] += caster.polygon_count();
        report.counters["polygons_degenerate"] += caster.degenerate;
        report.counters["polygons_duplicated"] += caster.duplicated;
        flat += caster.flat ? 1 : 0;
        tessellated += caster.tessellated ? 1 : 0;
        closed += static_cast<double>(caster.closed.count());
        quads += static_cast<double>(caster.quads.size());
    }
    report.resolved["casters_with_face_normals"] = flat;
    report.resolved["casters_tessellated"] = tessellated;
    report.resolved["closed_parts"] = closed;
    report.resolved["quads"] = quads;
    report.resolved["flux_share_captured"] = balance.captured();
    report.resolved["flux_share_pruned"] = balance.lit > 0 ? balance.pruned / balance.lit : 0;
    report.resolved["flux_share_over_budget"] =
        balance.lit > 0 ? balance.over_budget / balance.lit : 0;
    if (completion.photons > 0 && !(completion.of_budget_alone && rest.empty())) {
        report.counters["rest_photons"] = rest.size();
        report.resolved["flux_share_rest"] = balance.lit > 0 ? flux_of(rest) / balance.lit : 0;
    }
    report.resolved["flux_share_missed"] = balance.lit > 0 ? balance.missed / balance.lit : 0;
    if (walls.share > 0) {
        report.resolved["walls_behind_polygons"] = walls.share;
        report.resolved["walls_need_finer"] = walls.finer;
    }
    if (least_light > 0) report.resolved["least_light"] = least_light;
    double bounces = 0;
    for (const BeamSet& set : sets)
        bounces = std::max(bounces, static_cast<double>(set.path.size()));
    report.resolved["most_bounces"] = bounces;
    if (wavelengths > 0) report.resolved["wavelengths"] = wavelengths;
    if (drift.rays > 0) {
        report.resolved["drift_bend"] = drift.bend;
        report.resolved["drift_unknown"] = drift.unknown / drift.rays;
    }
    return report;
}

const CasterMesh& TracedScene::caster(std::uint32_t shape) const {
    for (const CasterMesh& caster : casters)
        if (caster.shape == shape) return caster;
    throw std::logic_error("no caster of that shape");
}

TraceSettings settings_of_beams(const BeamParams& params, int most_events, std::uint64_t most) {
    return {.max_bounces = most_events,
            .prune = params.prune,
            .least_divided = least_divided,
            .divided_share = divided_share,
            .max_beams = most};
}

TracedScene trace_scene(const Scene& scene, const std::string& method, const BeamParams& params,
                        const RunOptions& options, Intensity intensity, float footprint,
                        Completion rest, int root_events) {
    const std::vector<LightSample> lights = beam_lights(scene, method, params, options);
    options.phase("beams");
    TracedScene traced;
    traced.casters = caster_meshes(scene, params.mesh_resolution, params.polygons, options.threads,
                                   params.polygon_share);
    for (const CasterMesh& caster : traced.casters) {
        const WallsBehind walls = walls_behind_polygons(scene, caster);
        if (walls.share > traced.walls.share) traced.walls = walls;
    }
    if (disperses(scene)) traced.wavelengths = params.wavelengths;
    TraceSettings settings =
        settings_of_beams(params, params.max_bounces, static_cast<std::uint64_t>(params.max_beams));
    settings.intensity = intensity;
    settings.root_events = root_events;
    settings.receiver_margin = near_receiver * scene.diameter() + footprint;
    settings.rest = rest;
    settings.sampled_photons = sampled_photons;
    TracedBeams beams = trace_all_beams(scene, traced.casters, lights, settings, options);
    traced.sets = std::move(beams.sets);
    traced.rest = std::move(beams.rest);
    traced.completion = rest;
    traced.balance = beams.balance;
    settle_balance(rest, take_sample(traced.rest), traced.balance);
    traced.drift = beams.drift;
    traced.unreceived = beams.unreceived;
    traced.least_light = beams.least_light;
    require_most_light(traced.balance, method, "");
    return traced;
}

}  // namespace caustics::beamtree
