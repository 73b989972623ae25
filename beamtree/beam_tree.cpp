#include "beamtree/beam_tree.h"

#include <algorithm>

#include "beamtree/beam_estimator.h"
#include "beamtree/plane_groups.h"
#include "core/parallel.h"

namespace caustics {

namespace {

/// Its counts name the tests of cones as well.
class ConeSearch final : public BeamSearch {
public:
    void add_to(Counters& counters) const override {
        BeamSearch::add_to(counters);
        counters["cone_point_tests"] += counts.cone_point_tests;
    }
};

/// The trees of all lights, casters and events.
struct Forest {
    std::vector<ConeTree> trees;
    std::uint64_t binned = 0;  ///< trees over `binned`
};

class BeamTree final : public BeamEstimator {
public:
    BeamTree(const Scene& scene, TracedScene traced, Forest forest)
        : BeamEstimator(scene, std::move(traced)), forest_(std::move(forest)) {}

    std::unique_ptr<QueryContext> make_context() const override {
        return std::make_unique<ConeSearch>();
    }

    BuildReport build_report() const override {
        BuildReport report = BeamEstimator::build_report();
        report.counters["trees"] = forest_.trees.size();
        for (const ConeTree& tree : forest_.trees) {
            report.counters["nodes"] += tree.node_count();
            report.counters["height"] = std::max(report.counters["height"], tree.height());
            report.bytes += tree.bytes();
        }
        report.resolved["trees_binned"] = static_cast<double>(forest_.binned);
        report.resolved["trees_quadtree"] =
            static_cast<double>(forest_.trees.size() - forest_.binned);
        return report;
    }

private:
    void find(const ReceiverPoint& point, BeamSearch& search) const override {
        for (const ConeTree& tree : forest_.trees)
            tree.find(sets()[tree.set_index()], point.position, point.geometric_normal,
                      search.stack, search.hits, search.counts);
    }

    Forest forest_;
};

/// One tree to be built.
struct TreePlan {
    std::uint32_t set;
    PlaneGroup group;
};

std::vector<TreePlan> plan_trees(const TracedScene& traced, BeamTreeParams::Leaf leaf) {
    std::vector<TreePlan> plans;
    for (std::uint32_t i = 0; i < traced.sets.size(); ++i)
        for (PlaneGroup& group : leaf == BeamTreeParams::Leaf::k ? fixed_planes(traced.sets[i])
                                                                 : receiver_planes(traced.sets[i]))
            plans.push_back({i, std::move(group)});
    return plans;
}

Forest grow(const Scene& scene, const TracedScene& traced, const BeamTreeParams& params,
            const RunOptions& options) {
    ConeTreeSettings settings;
    settings.bound = params.bound;
    settings.spread_threshold = params.spread_threshold;
    settings.merging = params.merging;
    settings.reach = static_cast<double>(scene.diameter());
    const std::vector<TreePlan> plans = plan_trees(traced, params.leaf);
    std::vector<std::optional<ConeTree>> trees(plans.size());
    std::vector<char> binned(plans.size());
    parallel_for(options.threads, plans.size(), [&](std::size_t i, std::size_t) {
        const BeamSet& set = traced.sets[plans[i].set];
        const std::vector<GridPatch>& patches = traced.caster(set.caster).mesh.patches;
        const bool regular = params.hierarchy == BeamTreeParams::Tree::quadtree && !patches.empty();
        binned[i] = regular ? 0 : 1;
        const Hierarchy hierarchy =
            regular ? quadtree(set, plans[i].group.beams, patches)
                    : binned_hierarchy(set, plans[i].group.beams, scene.diameter() / 2);
        trees[i].emplace(set, plans[i].set, hierarchy, settings, plans[i].group.normal);
    });
    Forest forest;
    for (std::optional<ConeTree>& tree : trees) forest.trees.push_back(std::move(*tree));
    forest.binned = static_cast<std::uint64_t>(std::count(binned.begin(), binned.end(), 1));
    return forest;
}

}  // namespace

std::unique_ptr<const CausticEstimator> build(const Scene& scene, const BeamTreeParams& params,
                                              const RunOptions& options) {
    TracedScene traced = trace_scene(scene, "beamtree", params, options);
    options.phase("tree");
    Forest forest = grow(scene, traced, params, options);
    return std::make_unique<BeamTree>(scene, std::move(traced), std::move(forest));
}

}  // namespace caustics
