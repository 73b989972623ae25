#include "beamtree/traced_scene.h"

#include <cmath>

#include "core/error.h"

namespace caustics {
namespace {

// With most of the light missing it would be another picture. A mirror ring loses a fifth.
constexpr double most_lost = 0.5;

void refuse_several_events(const std::string& method, const BeamParams& params,
                           const FluxBalance& balance) {
    if (params.max_bounces == 1 || balance.share() <= most_lost) return;
    const auto percent = std::to_string(std::lround(100 * balance.share()));
    throw UnsupportedScene(
        method + ": beams follow one specular event, and here " + percent +
        " % of the light they carry goes on to another specular surface (give max_bounces=1 for "
        "the paths with one event alone, or use photonmap)");
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
    report.resolved["flux_share_to_second_event"] = balance.share();
    return report;
}

const CasterMesh& TracedScene::caster(std::uint32_t shape) const {
    for (const CasterMesh& caster : casters)
        if (caster.shape == shape) return caster;
    throw std::logic_error("no caster of that shape");
}

TracedScene trace_scene(const Scene& scene, const std::string& method, const BeamParams& params,
                        const RunOptions& options, Intensity intensity) {
    options.phase("beams");
    TracedScene traced;
    traced.casters = caster_meshes(scene, params.mesh_resolution, params.polygons);
    const std::vector<LightSample> lights =
        sample_lights(scene, params.light_samples, options.seed);
    traced.sets = trace_all_beams(scene, traced.casters, lights, options, intensity);
    traced.balance = flux_balance(scene, traced.sets, options);
    refuse_several_events(method, params, traced.balance);
    return traced;
}

}  // namespace caustics
