#include "beamtree/beam_tree.h"

#include <utility>

#include "beamtree/beam_plan.h"
#include "beamtree/forest.h"
#include "beamtree/sampled_beams.h"
#include "core/method/unlit_estimator.h"

namespace caustics::beamtree {

namespace {

/// Its counts name the tests of cones as well.
class ConeSearch final : public BeamSearch {
public:
    /// Squares of `footprint` round points, and the points with them.
    std::vector<PixelCell> squares;
    std::vector<ReceiverPoint> points;

    void add_to(Counters& counters) const override {
        BeamSearch::add_to(counters);
        counters["cone_point_tests"] += counts.cone_point_tests;
    }
};

class BeamTree final : public BeamEstimator {
public:
    BeamTree(const Scene& scene, TracedScene traced, Forest forest, const BeamTreeParams& params,
             PencilMap pencils, BuildReport plan, int threads)
        : BeamEstimator(scene, std::move(traced), static_cast<std::uint32_t>(params.rest_nearest),
                        threads, std::move(pencils)),
          forest_(std::move(forest)),
          footprint_(static_cast<double>(params.footprint)),
          pixel_footprint_(params.pixel_footprint),
          plan_(std::move(plan)) {}

    bool asks_for_cells() const override { return pixel_footprint_; }

    std::unique_ptr<QueryContext> make_context() const override {
        return std::make_unique<ConeSearch>();
    }

    BuildReport build_report() const override {
        BuildReport report = BeamEstimator::build_report();
        forest_.add_to(report);
        report.counters.insert(plan_.counters.begin(), plan_.counters.end());
        report.resolved.insert(plan_.resolved.begin(), plan_.resolved.end());
        return report;
    }

private:
    void find(std::span<const ReceiverPoint> points, BeamSearch& search) const override {
        if (footprint_ == 0) return forest_.find(sets(), points, search);
        auto& own = dynamic_cast<ConeSearch&>(search);
        own.squares.clear();
        for (const ReceiverPoint& point : points) own.squares.push_back(*square(point));
        own.points.assign(points.begin(), points.end());
        for (std::size_t i = 0; i < points.size(); ++i) own.points[i].cell = &own.squares[i];
        forest_.find(sets(), own.points, search);
    }

    std::optional<PixelCell> square(const ReceiverPoint& point) const override {
        if (footprint_ == 0) return {};
        return PixelCell::square(point.geometric_normal.cast<double>(), footprint_);
    }

    Forest forest_;
    double footprint_;
    bool pixel_footprint_;
    BuildReport plan_;
};

Completion completion(const BeamTreeParams& params) {
    using Rest = BeamTreeParams::Rest;
    if (params.rest == Rest::none) return {};
    return {static_cast<std::uint64_t>(params.rest_photons), params.rest != Rest::photons};
}

/// Parameters for beams, as `rest: pencils` settles them, and the pencils.
struct Planned {
    BeamTreeParams params;
    bool has_beams = true;
    PencilMap pencils;
    BuildReport report;
};

BuildReport report_of(const BeamPlan& plan) {
    BuildReport report;
    report.resolved["events_by_beams"] = plan.beam_events;
    report.resolved["beam_share"] = plan.beam_share;
    return report;
}

Planned planned(const Scene& scene, const BeamTreeParams& params, const RunOptions& options) {
    Planned planned{params, true, {}, {}};
    if (params.rest != BeamTreeParams::Rest::pencils) return planned;
    options.phase("plan");
    const BeamPlan plan = plan_beams(scene, params, options);
    planned.has_beams = plan.beam_events > 0;
    if (planned.has_beams) planned.params.max_bounces = plan.beam_events;
    planned.report = report_of(plan);
    if (!plan.needs_pencils) return planned;
    options.phase("pencils");
    ScenePencils pencils =
        trace_scene_pencils(scene, params, static_cast<std::uint64_t>(params.pencils), options);
    planned.report.counters["pencils_traced"] = pencils.traced.traced;
    planned.report.resolved["beam_share"] = pencils.share_up_to(plan.beam_events);
    std::erase_if(pencils.traced.prints, [&](const PencilPrint& print) {
        return std::cmp_less_equal(print.events, plan.beam_events);
    });
    planned.report.counters["pencil_prints"] = pencils.traced.prints.size();
    planned.pencils =
        PencilMap(std::move(pencils.traced.prints), pencils.lights, options.isa, options.threads);
    return planned;
}

}  // namespace

std::unique_ptr<const CausticEstimator> build(const Scene& scene, const BeamTreeParams& params,
                                              const RunOptions& options) {
    if (params.sampled) {
        if (params.rest != BeamTreeParams::Rest::pencils)
            return sampled_beams(scene, "beamtree", params, options);
        return std::make_unique<UnlitEstimator>(report_of(plan_beams(scene, params, options)));
    }
    Planned plan = planned(scene, params, options);
    TracedScene traced;
    if (plan.has_beams)
        traced = trace_scene(scene, "beamtree", plan.params, options, params.intensity,
                             params.footprint, completion(params), params.root_events);
    options.phase("tree");
    Forest forest(scene, traced, params, options);
    return std::make_unique<BeamTree>(scene, std::move(traced), std::move(forest), params,
                                      std::move(plan.pencils), std::move(plan.report),
                                      options.threads);
}

}  // namespace caustics::beamtree
