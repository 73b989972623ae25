#include "beamtree/caustic_polygons.h"

#include <algorithm>

#include "beamtree/beam_estimator.h"
#include "beamtree/beam_param_table.h"
#include "beamtree/beams/trace_progress.h"
#include "beamtree/light/find_in_beam.h"
#include "beamtree/receiver_polygons.h"
#include "beamtree/sampled_beams.h"
#include "core/base/parallel.h"

namespace caustics::beamtree {

namespace {

/// The beams that meet one diffuse polygon, from either of its sides.
class Sweep {
public:
    Sweep(const ReceiverPolygon& polygon, const std::vector<BeamSet>& sets)
        : plane_(polygon.a, polygon.normal), sets_(sets) {
        for (const Vec3& p : {polygon.a, polygon.b, polygon.c})
            box_.extend(plane_.project(p, 0, Vec3::Zero()));
        // Points of the polygon are its own to rounding.
        const double margin = position_rounding(polygon) + 1e-5 * box_.diagonal().norm();
        box_.min().array() -= margin;
        box_.max().array() += margin;
    }

    std::vector<BeamNumber> run() {
        std::vector<BeamNumber> found;
        for (std::uint32_t s = 0; s < sets_.size(); ++s) {
            project_rays(sets_[s]);
            for (std::uint32_t i = 0; i < sets_[s].beams.size(); ++i)
                if (meets(sets_[s].beams[i])) found.push_back({s, i});
        }
        return found;
    }

private:
    struct RayFoot {
        Vec2d at = Vec2d::Zero();
        double height = 0;
        double steepness = 0;
        bool comes_down = false;  ///< to the plane, from its own side
    };

    void project_rays(const BeamSet& set) {
        feet_.clear();
        for (const VertexRay& ray : set.rays) {
            RayFoot foot;
            foot.height = plane_.height(ray.position);
            foot.steepness = plane_.steepness(ray.direction);
            foot.comes_down = foot.height * foot.steepness > 0;
            if (foot.comes_down)
                foot.at = plane_.project(ray.position, foot.height / foot.steepness, ray.direction);
            feet_.push_back(foot);
        }
    }

    // Whether the caustic polygon's box touches the diffuse polygon's. Beams that the plane may cut
    // are kept for the point test to decide.
    bool meets(const Beam& beam) const {
        Eigen::AlignedBox2d box;
        Eigen::AlignedBox2d sides;  // of (height, steepness)
        bool whole = true;
        for (const std::uint32_t corner : beam.corners) {
            if (corner == Beam::none) continue;
            const RayFoot& foot = feet_[corner];
            box.extend(foot.at);
            sides.extend(Vec2d(foot.height, foot.steepness));
            whole = whole && foot.comes_down;
        }
        const bool from_above = sides.max().minCoeff() > 0;
        const bool from_below = sides.min().maxCoeff() < 0;
        if (!from_above && !from_below) return false;
        return !whole || (from_above && from_below) || box.intersects(box_);
    }

    TestPlane plane_;
    const std::vector<BeamSet>& sets_;
    Eigen::AlignedBox2d box_;
    std::vector<RayFoot> feet_;
};

class CausticPolygons final : public BeamEstimator {
public:
    CausticPolygons(const Scene& scene, TracedScene traced, ReceiverPolygons receivers,
                    std::vector<std::vector<BeamNumber>> lists)
        : BeamEstimator(scene, std::move(traced)),
          receivers_(std::move(receivers)),
          lists_(std::move(lists)) {}

    BuildReport build_report() const override {
        BuildReport report = BeamEstimator::build_report();
        report.bytes += receivers_.bytes();
        report.counters["receiver_polygons"] = receivers_.polygons().size();
        report.counters["beam_polygon_tests"] =
            receivers_.polygons().size() * report.counters["beams"];
        std::uint64_t& pairs = report.counters["caustic_polygons"];
        for (const std::vector<BeamNumber>& list : lists_) pairs += list.size();
        report.bytes += pairs * sizeof(BeamNumber);
        return report;
    }

private:
    void find(std::span<const ReceiverPoint> points, BeamSearch& search) const override {
        if (receivers_.polygons().empty()) return;
        for (std::size_t i = 0; i < points.size(); ++i) find(points[i], search, search.hits[i]);
    }

    // The caustic polygons that hold the point, on the plane of its diffuse polygon.
    void find(const ReceiverPoint& point, BeamSearch& search, std::vector<BeamHit>& hits) const {
        const std::uint32_t index =
            receivers_.nearest(point.position, point.geometric_normal, search.stack);
        const ReceiverPolygon& polygon = receivers_.polygons()[index];
        const bool front = polygon.normal.dot(point.geometric_normal) > 0;
        const Vec3 normal = front ? polygon.normal : Vec3(-polygon.normal);
        const float off = normal.dot(point.position - polygon.a);
        const TestPlane plane(point.position - off * normal, normal);
        for (const BeamNumber& number : lists_[index])
            find_in_beam(sets()[number.set], number, plane, hits, search.counts);
        // The polygon stands for the surface: its irradiance is the surface's.
        for (BeamHit& hit : hits) hit.plane_normal = point.geometric_normal;
    }

    ReceiverPolygons receivers_;
    std::vector<std::vector<BeamNumber>> lists_;  ///< one a diffuse polygon
};

}  // namespace

const DescribedMethod<CausticPolygonsParams>& causticpolygons_method() {
    using P = CausticPolygonsParams;
    static const DescribedMethod<P> method(
        {.facts = {.name = "causticpolygons",
                   .summary = "Watt 1990: the same beams, kept by the polygons of the receivers",
                   .serves = "as `beamtree`",
                   .work = {.parameter = "mesh_resolution", .power = 2, .first = 8, .most = 4096}},
         .parameters = joined(
             beam_param_table<P>(),
             {parameter::whole_number<P>(
                 &P::receiver_resolution, 2, 4096,
                 {.key = "receiver_resolution",
                  .meaning =
                      "Polygons along each parameter of exact receivers; meshes are taken as they "
                      "are.",
                  .unit = "polygons",
                  .source = "[Watt 1990]"})}),
         .take_least_work = [](P& params) { params.sampled = true; },
         .take_share = [](P& params, double share) { return params.polygon_share = share; }});
    return method;
}

std::unique_ptr<const CausticEstimator> build(const Scene& scene,
                                              const CausticPolygonsParams& params,
                                              const RunOptions& options) {
    if (params.sampled) return sampled_beams(scene, "causticpolygons", params, options);
    TracedScene traced = trace_scene(scene, "causticpolygons", params, options);
    options.phase("polygons");
    ReceiverPolygons receivers(scene, params.receiver_resolution);
    std::vector<std::vector<BeamNumber>> lists(receivers.polygons().size());
    TraceProgress progress(options);
    parallel_for(options.threads, lists.size(), [&](std::size_t i, std::size_t) {
        lists[i] = Sweep(receivers.polygons()[i], traced.sets).run();
        progress.add(1 / static_cast<double>(lists.size()));
    });
    return std::make_unique<CausticPolygons>(scene, std::move(traced), std::move(receivers),
                                             std::move(lists));
}

}  // namespace caustics::beamtree
