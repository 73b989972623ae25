#include "beamtree/tracing/traced_scene.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace caustics::beamtree {
namespace {

// With most of the light missing it would be another picture.
constexpr double least_captured = 0.5;

void refuse_what_is_lost(const std::string& method, const FluxBalance& balance) {
    if (balance.captured() >= least_captured) return;
    const auto percent = std::to_string(std::lround(100 * (1 - balance.captured())));
    throw UnsupportedScene(
        method + ": beams lose " + percent +
        " % of the light between specular surfaces, where polygons are too coarse for them (refine "
        "the casters' meshes, give max_bounces=1 for the paths with one event alone, or use "
        "photonmap)");
}

Ior most_dispersive_glass(const Scene& scene) {
    const auto spread = [](const Ior& ior) {
        return std::abs(ior.at(static_cast<float>(shortest_wavelength)) -
                        ior.at(static_cast<float>(longest_wavelength)));
    };
    Ior most = 1;
    for (const Shape& shape : scene.shapes())
        if (const auto* glass = std::get_if<Dielectric>(&shape.bsdf.model))
            for (const Ior& ior : {glass->int_ior, glass->ext_ior})
                if (spread(ior) > spread(most)) most = ior;
    return most;
}

}  // namespace

BuildReport TracedScene::report() const {
    BuildReport report;
    std::uint64_t& beams = report.counters["beams"];
    for (const BeamSet& set : sets) {
        beams += set.beams.size();
        report.bytes += set.bytes();
    }
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

TracedScene trace_scene(const Scene& scene, const std::string& method, const BeamParams& params,
                        const RunOptions& options, Intensity intensity) {
    for (const Light& light : scene.lights())
        if (surrounds(light))
            throw UnsupportedScene(
                method + ": beams start from points or directions, and a " + type_of(light) +
                " light shines from everywhere (photonmap and the references take it)");
    options.phase("beams");
    TracedScene traced;
    traced.casters = caster_meshes(scene, params.mesh_resolution, params.polygons);
    std::vector<LightSample> lights = sample_lights(scene, params.light_samples, options.seed);
    if (disperses(scene)) {
        lights = params.dispersion == Dispersion::intervals
                     ? drifting(lights, params.wavelengths, most_dispersive_glass(scene))
                     : dispersed(lights, params.wavelengths);
        traced.wavelengths = params.wavelengths;
    }
    TracedBeams beams =
        trace_all_beams(scene, traced.casters, lights, {intensity, params.max_bounces}, options);
    traced.sets = std::move(beams.sets);
    traced.balance = beams.balance;
    traced.drift = beams.drift;
    refuse_what_is_lost(method, traced.balance);
    return traced;
}

}  // namespace caustics::beamtree
