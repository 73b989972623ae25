#include "beamtree/traced_scene.h"

#include <cmath>

#include "core/error.h"

namespace caustics {
namespace {

// With most of the light missing it would be another picture. A mirror ring loses a fifth.
constexpr double most_lost = 0.5;

void refuse_several_events(const BeamRequest& request, const FluxBalance& balance) {
    if (request.max_bounces == 1 || balance.share() <= most_lost) return;
    const auto percent = std::to_string(std::lround(100 * balance.share()));
    throw UnsupportedScene(
        request.method + ": beams follow one specular event, and here " + percent +
        " % of the light they carry goes on to another specular surface (give max_bounces=1 for "
        "the paths with one event alone, or use photonmap)");
}

}  // namespace

void read_polygons(const JsonNode& node, PolygonKind& polygons) {
    if (const auto choice = node.find("polygons"))
        polygons = choice->as_choice({"triangles", "quads"}) == 0 ? PolygonKind::triangle
                                                                  : PolygonKind::quad;
}

std::uint64_t TracedScene::beam_count() const {
    std::uint64_t count = 0;
    for (const BeamSet& set : sets) count += set.beams.size();
    return count;
}

std::uint64_t TracedScene::bytes() const {
    std::uint64_t sum = 0;
    for (const BeamSet& set : sets) sum += set.bytes();
    return sum;
}

void TracedScene::add_to(BuildReport& report) const {
    report.bytes += bytes();
    report.counters["beams"] = beam_count();
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
}

const CasterMesh& TracedScene::caster(std::uint32_t shape) const {
    for (const CasterMesh& caster : casters)
        if (caster.shape == shape) return caster;
    throw std::logic_error("no caster of that shape");
}

TracedScene trace_scene(const Scene& scene, const BeamRequest& request, const RunOptions& options) {
    options.phase("beams");
    TracedScene traced;
    traced.casters = caster_meshes(scene, request.mesh_resolution, request.polygons);
    const std::vector<LightSample> lights =
        sample_lights(scene, request.light_samples, options.seed);
    traced.sets = trace_all_beams(scene, traced.casters, lights, options);
    traced.balance = flux_balance(scene, traced.sets, options);
    refuse_several_events(request, traced.balance);
    return traced;
}

}  // namespace caustics
