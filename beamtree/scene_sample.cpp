#include "beamtree/scene_sample.h"

#include <map>

#include "beamtree/beams/caster_sample.h"
#include "beamtree/tracing/beam_lights.h"
#include "beamtree/tracing/caster_beams.h"
#include "core/geometry/tessellate.h"
#include "core/math/rng.h"

namespace caustics::beamtree {
namespace {

// Polygons of one caster in one light that are traced together, and how often at most.
constexpr std::size_t together = 4;
constexpr int most_draws = 512;
// Beams that are enough to judge by.
constexpr std::size_t enough = 2'000;
// Of a first event's light: less tells little, and costs most.
constexpr double least_share_kept = 0.03;

// Exact shapes of one kind have equally many.
std::uint64_t count_polygons(const Scene& scene, OwnFrameMeshes& meshes) {
    std::map<Primitive, std::size_t> exact;
    std::uint64_t count = 0;
    for (const std::uint32_t index : scene.casters()) {
        const Shape& shape = scene.shapes()[index];
        if (shape.primitive == Primitive::mesh)
            count += shape.mesh.triangles.size();
        else if (const auto known = exact.find(shape.primitive); known != exact.end())
            count += known->second;
        else
            count += exact[shape.primitive] = meshes.of(shape).triangles.size();
    }
    return count;
}

}  // namespace

std::uint64_t count_polygons(const Scene& scene, int mesh_resolution) {
    OwnFrameMeshes meshes(mesh_resolution);
    return count_polygons(scene, meshes);
}

namespace {

std::size_t pick(std::size_t count, Rng& rng) {
    return static_cast<std::size_t>(rng.next_fine() * static_cast<double>(count));
}

/// Beams of one draw.
class Draw {
public:
    Draw(const Scene& scene, const SceneBoxes& boxes, const CasterMesh& caster,
         const LightSample& light, const ProgressPart& part)
        : scene_(scene), boxes_(boxes), caster_(caster), light_(light), part_(part) {}

    TracedBeams run(int max_bounces) const {
        BeamBudget all;
        const TracedBeams first = trace(1, all);
        double light = 0;
        for (const BeamSet& set : first.sets)
            for (const Beam& beam : set.beams) light += static_cast<double>(beam.flux.mean());
        BeamBudget bright(BeamBudget::no_limit, least_share_kept * light / together);
        return trace(max_bounces, bright);
    }

private:
    TracedBeams trace(int max_bounces, BeamBudget& budget) const {
        return trace_beams(scene_, boxes_, caster_, nullptr, light_, {Intensity::area, max_bounces},
                           budget, part_);
    }

    const Scene& scene_;
    const SceneBoxes& boxes_;
    const CasterMesh& caster_;
    const LightSample& light_;
    ProgressPart part_;
};

}  // namespace

BuildReport SceneSample::report() const {
    BuildReport report;
    report.counters["polygons_sampled"] = polygons_sampled;
    report.counters["polygons"] = polygons;
    report.resolved["flux_share_captured"] = balance.captured();
    return report;
}

SceneSample sample_scene(const Scene& scene, const std::string& method, const BeamParams& params,
                         const RunOptions& options) {
    const std::vector<LightSample> lights = beam_lights(scene, method, params, options);
    SceneSample sample;
    OwnFrameMeshes meshes(params.mesh_resolution);
    sample.polygons = count_polygons(scene, meshes);
    if (lights.empty() || sample.polygons == 0) return sample;
    const SceneBoxes boxes = scene_boxes(scene);
    Rng rng(options.seed, Stage::beams, lights.size());
    TraceProgress progress(options);
    std::size_t made = 0;
    for (int draws = 0; draws < most_draws && made < enough; ++draws) {
        const std::uint32_t caster = scene.casters()[pick(scene.casters().size(), rng)];
        const Shape& shape = scene.shapes()[caster];
        const TriangleMesh& mesh = meshes.of(shape);
        const LightSample& light = lights[pick(lights.size(), rng)];
        if (mesh.triangles.empty()) continue;
        CasterMesh drawn = draw_polygons(mesh, together, rng);
        drawn.shape = caster;
        drawn.tessellated = shape.primitive != Primitive::mesh;
        if (drawn.tessellated) place_exact(drawn.mesh, shape);
        const TracedBeams traced =
            Draw(scene, boxes, drawn, light, {progress, 0}).run(params.max_bounces);
        for (const BeamSet& set : traced.sets) made += set.beams.size();
        FluxBalance balance = traced.balance;
        balance.lost -= balance.over_budget;
        sample.balance.add(balance, static_cast<double>(mesh.triangles.size()));
        sample.polygons_sampled += together;
    }
    require_most_light(sample.balance, method,
                       " in a sample of " + std::to_string(sample.polygons_sampled) + " polygons");
    return sample;
}

}  // namespace caustics::beamtree
