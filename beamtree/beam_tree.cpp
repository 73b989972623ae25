#include "beamtree/beam_tree.h"

#include "beamtree/forest.h"
#include "beamtree/sampled_beams.h"

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
             int threads)
        : BeamEstimator(scene, std::move(traced), static_cast<std::uint32_t>(params.rest_nearest),
                        threads),
          forest_(std::move(forest)),
          footprint_(static_cast<double>(params.footprint)),
          pixel_footprint_(params.pixel_footprint) {}

    bool asks_for_cells() const override { return pixel_footprint_; }

    std::unique_ptr<QueryContext> make_context() const override {
        return std::make_unique<ConeSearch>();
    }

    BuildReport build_report() const override {
        BuildReport report = BeamEstimator::build_report();
        forest_.add_to(report);
        return report;
    }

private:
    void find(std::span<const ReceiverPoint> points, BeamSearch& search) const override {
        if (footprint_ == 0) return forest_.find(sets(), points, search);
        auto& own = dynamic_cast<ConeSearch&>(search);
        own.squares.clear();
        for (const ReceiverPoint& point : points)
            own.squares.push_back(
                PixelCell::square(point.geometric_normal.cast<double>(), footprint_));
        own.points.assign(points.begin(), points.end());
        for (std::size_t i = 0; i < points.size(); ++i) own.points[i].cell = &own.squares[i];
        forest_.find(sets(), own.points, search);
    }

    Forest forest_;
    double footprint_;
    bool pixel_footprint_;
};

Completion completion(const BeamTreeParams& params) {
    using Rest = BeamTreeParams::Rest;
    if (params.rest == Rest::none) return {};
    return {static_cast<std::uint64_t>(params.rest_photons), params.rest == Rest::max_beams};
}

}  // namespace

std::unique_ptr<const CausticEstimator> build(const Scene& scene, const BeamTreeParams& params,
                                              const RunOptions& options) {
    if (params.sampled) return sampled_beams(scene, "beamtree", params, options);
    TracedScene traced = trace_scene(scene, "beamtree", params, options, params.intensity,
                                     params.footprint, completion(params), params.root_events);
    options.phase("tree");
    Forest forest(scene, traced, params, options);
    return std::make_unique<BeamTree>(scene, std::move(traced), std::move(forest), params,
                                      options.threads);
}

}  // namespace caustics::beamtree
