#include "beamtree/forest.h"

#include <algorithm>
#include <optional>

#include "beamtree/beams/binned_hierarchy.h"
#include "beamtree/beams/quadtree.h"
#include "beamtree/beams/trace_progress.h"
#include "beamtree/cones/plane_groups.h"
#include "core/base/parallel.h"

namespace caustics::beamtree {
namespace {

// Trees of so many beams are built one after the other, each on all threads; so are few of them.
constexpr std::size_t large = 4096;
constexpr std::size_t few = 8;

/// One tree to be built.
struct TreePlan {
    std::vector<BeamNumber> beams;
    std::optional<Vec3> normal;
    bool sliced = false;
    bool regular = false;  ///< over the quadtree of the caster's mesh; the beams are of one set
};

class Planner {
public:
    Planner(const TracedScene& traced, const BeamTreeParams& params)
        : traced_(traced), params_(params) {
        for (std::uint32_t i = 0; i < traced.sets.size(); ++i) {
            const BeamSet& set = traced.sets[i];
            const bool fixed = params.leaf == BeamTreeParams::Leaf::fixed;
            for (const PlaneGroup& group : fixed ? fixed_planes(set) : receiver_planes(set))
                add(i, group);
        }
    }
    std::vector<TreePlan> take() { return std::move(plans_); }

private:
    void add(std::uint32_t set, const PlaneGroup& group) {
        TreePlan plan;
        for (const std::uint32_t beam : group.beams) plan.beams.push_back({set, beam});
        plan.normal = group.normal;
        plan.sliced = params_.bound == Bound::two_slice && group.normal;
        plan.regular = params_.hierarchy == BeamTreeParams::Tree::quadtree &&
                       !traced_.caster(traced_.sets[set].caster).mesh.patches.empty();
        const auto alike = std::ranges::find_if(plans_, [&](const TreePlan& other) {
            return plan.sliced && other.sliced && !plan.regular && !other.regular &&
                   *plan.normal == *other.normal;
        });
        if (alike == plans_.end())
            plans_.push_back(std::move(plan));
        else
            alike->beams.insert(alike->beams.end(), plan.beams.begin(), plan.beams.end());
    }

    const TracedScene& traced_;
    const BeamTreeParams& params_;
    std::vector<TreePlan> plans_;
};

std::vector<std::uint32_t> in_their_set(const std::vector<BeamNumber>& numbers) {
    std::vector<std::uint32_t> beams;
    for (const BeamNumber& number : numbers) beams.push_back(number.beam);
    return beams;
}

Hierarchy quadtree_of(const TracedScene& traced, const TreePlan& plan) {
    const BeamSet& set = traced.sets[plan.beams.front().set];
    return quadtree(set, in_their_set(plan.beams), traced.caster(set.caster).mesh.patches);
}

SliceTree slice_tree(const Scene& scene, const TracedScene& traced, const TreePlan& plan,
                     const RunOptions& options, int threads) {
    SlicedBeams beams{traced.sets, plan.beams, *plan.normal, scene.bounds()};
    if (!plan.regular) return {std::move(beams), options.isa, threads};
    const Hierarchy hierarchy = quadtree_of(traced, plan);
    beams.beams.clear();
    for (const std::uint32_t beam : hierarchy.order)
        beams.beams.push_back({plan.beams.front().set, beam});
    return {std::move(beams), hierarchy, options.isa, threads};
}

ConeTree cone_tree(const Scene& scene, const TracedScene& traced, const TreePlan& plan,
                   const BeamTreeParams& params, int threads) {
    const std::uint32_t set = plan.beams.front().set;
    ConeTreeSettings settings;
    settings.bound = params.bound == Bound::two_slice ? Bound::sphere_swept : params.bound;
    settings.spread_threshold = params.spread_threshold;
    settings.merging = params.merging;
    settings.reach = static_cast<double>(scene.diameter());
    const Hierarchy hierarchy =
        plan.regular
            ? quadtree_of(traced, plan)
            : binned_hierarchy(traced.sets[set], in_their_set(plan.beams), scene.diameter() / 2);
    return {traced.sets[set], set, hierarchy, settings, plan.normal, threads};
}

}  // namespace

Forest::Forest(const Scene& scene, const TracedScene& traced, const BeamTreeParams& params,
               const RunOptions& options) {
    const std::vector<TreePlan> plans = Planner(traced, params).take();
    std::vector<std::optional<ConeTree>> cones(plans.size());
    std::vector<std::optional<SliceTree>> slices(plans.size());
    TraceProgress progress(options);
    const auto build = [&](std::size_t i, int threads) {
        if (plans[i].sliced)
            slices[i].emplace(slice_tree(scene, traced, plans[i], options, threads));
        else
            cones[i].emplace(cone_tree(scene, traced, plans[i], params, threads));
        progress.add(1 / static_cast<double>(plans.size()));
    };
    std::vector<std::size_t> small;
    for (std::size_t i = 0; i < plans.size(); ++i)
        if (plans[i].beams.size() >= large || plans.size() < few)
            build(i, options.threads);
        else
            small.push_back(i);
    parallel_for(options.threads, small.size(),
                 [&](std::size_t k, std::size_t) { build(small[k], 1); });
    for (std::size_t i = 0; i < plans.size(); ++i) {
        if (slices[i])
            slices_.push_back(std::move(*slices[i]));
        else
            cones_.push_back(std::move(*cones[i]));
        binned_ += plans[i].regular ? 0 : 1;
    }
}

void Forest::find(std::span<const BeamSet> sets, std::span<const ReceiverPoint> points,
                  BeamSearch& search) const {
    for (std::size_t i = 0; i < points.size(); ++i)
        for (const ConeTree& tree : cones_)
            tree.find(sets[tree.set_index()], points[i].position, points[i].geometric_normal,
                      search.stack, search.hits[i], search.counts);
    for (const SliceTree& tree : slices_)
        tree.find(sets, points, search.stack, search.hits, search.counts);
}

void Forest::add_to(BuildReport& report) const {
    const std::uint64_t trees = cones_.size() + slices_.size();
    report.counters["trees"] = trees;
    const auto add = [&report](const auto& tree) {
        report.counters["nodes"] += tree.node_count();
        report.counters["height"] = std::max(report.counters["height"], tree.height());
        report.bytes += tree.bytes();
    };
    std::ranges::for_each(cones_, add);
    std::ranges::for_each(slices_, add);
    report.resolved["trees_binned"] = static_cast<double>(binned_);
    report.resolved["trees_quadtree"] = static_cast<double>(trees - binned_);
}

}  // namespace caustics::beamtree
