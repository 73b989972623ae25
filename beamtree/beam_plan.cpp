#include "beamtree/beam_plan.h"

#include <algorithm>
#include <utility>

#include "beamtree/pencils/light_patch.h"
#include "beamtree/scene_sample.h"
#include "beamtree/tracing/beam_lights.h"
#include "beamtree/tracing/expected_least.h"
#include "beamtree/tracing/traced_scene.h"

namespace caustics::beamtree {
namespace {

constexpr std::uint64_t pilot_pencils = 10'000;
// Beams and divisions of polygons that take about two CPU seconds where several events follow each other.
constexpr std::uint64_t few_beams = 100'000;
// Polygons, once a light, that take less than ten times as long as a photon map by one event alone (12 microseconds each),
// and light points: every receiver point asks the beams of each.
constexpr std::uint64_t few_polygons = 600'000;
constexpr std::size_t few_points = 8;
// Light of one event that is worth beams of its own, over all of the caustic.
constexpr double most_light = 0.5;
// Light that is too little to be followed.
constexpr double least_light = 1e-4;

// Parts of each light by wavelength.
int bins_of(const Scene& scene, const BeamTreeParams& params) {
    return disperses(scene) ? params.wavelengths : 1;
}

bool all_beams_fit(const Scene& scene, const BeamTreeParams& params,
                   const std::vector<LightSample>& lights, int most_events,
                   const RunOptions& options) {
    return beams_fit(scene,
                     caster_meshes(scene, params.mesh_resolution, params.polygons, options.threads),
                     lights, settings_of_beams(params, most_events, few_beams), options);
}

}  // namespace

double ScenePencils::share_up_to(int most_events) const {
    double all = 0;
    double some = 0;
    for (const PencilPrint& print : traced.prints) {
        const auto watts = static_cast<double>(print.flux.mean());
        all += watts;
        if (std::cmp_less_equal(print.events, most_events)) some += watts;
    }
    return all > 0 ? some / all : 1;
}

ScenePencils trace_scene_pencils(const Scene& scene, const BeamTreeParams& params,
                                 std::uint64_t count, const RunOptions& options) {
    BeamTreeParams own = params;
    own.light_samples = 1;
    ScenePencils pencils{whole_lamps(scene, beam_lights(scene, "beamtree", own, options)), {}};
    pencils.traced = trace_pencils(scene, pencils.lights, {count, params.max_bounces}, options);
    return pencils;
}

BeamPlan plan_beams(const Scene& scene, const BeamTreeParams& params, const RunOptions& options) {
    // Refuses lights that beams cannot serve, whatever the plan is.
    const std::vector<LightSample> lights = beam_lights(scene, "beamtree", params, options);
    if (params.beam_events != BeamTreeParams::planned) {
        const int given = std::min(params.beam_events, params.max_bounces);
        return {given, given < params.max_bounces, 1};
    }
    const ScenePencils pilot = trace_scene_pencils(scene, params, pilot_pencils, options);
    const auto with = [&](int most_events) -> BeamPlan {
        const double share = pilot.share_up_to(most_events);
        return {most_events, most_events < params.max_bounces && 1 - share > least_light, share};
    };
    const std::uint64_t polygons = count_polygons(scene, params.mesh_resolution) * lights.size();
    const int most = std::min(params.max_bounces, preset_bounces);
    const double first = pilot.share_up_to(1);
    if (most > 1 && 1 - first > least_light && polygons <= few_beams &&
        all_beams_fit(scene, params, lights, most, options))
        return with(most);
    const bool first_fits =
        lights.size() <= few_points * static_cast<std::size_t>(bins_of(scene, params)) &&
        polygons <= few_polygons;
    return with(first_fits && first >= most_light ? 1 : 0);
}

}  // namespace caustics::beamtree
