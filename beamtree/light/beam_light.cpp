#include "beamtree/light/beam_light.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "beamtree/beams/caster_mesh.h"
#include "beamtree/light/refined_density.h"
#include "beamtree/light/resolvable_area.h"
#include "core/material/optics.h"
#include "core/scene/same_surface.h"

namespace caustics::beamtree {
namespace {

/// The ray of a hit that arrives at the point.
struct ArrivingRay {
    SegmentEnd start;                            ///< where the light was bent
    Vec3 direction;                              ///< unit, the way the light goes
    std::optional<SegmentEnd> other_start = {};  ///< to be tried where the first is not free
};

Vec3 longest_side(const std::array<VertexRay, 3>& rays) {
    Vec3 longest = Vec3::Zero();
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 side = rays[(i + 1) % 3].position - rays[i].position;
        if (side.squaredNorm() > longest.squaredNorm()) longest = side;
    }
    return longest;
}

// Where light leaves a sliver. Corners that lie on a curved surface do not tell how it lies there: the sliver's plane may stand
// on the surface, and a start that is moved along that plane's normal stays inside. Where light leaves nearly along a flat surface
// this start stays inside instead. None for other triangles.
std::optional<SegmentEnd> start_on_sliver(const std::array<VertexRay, 3>& rays,
                                          const Vec3& position, const Vec3& direction,
                                          float offset) {
    constexpr float least_height = 0.1F;  // of the longest side
    const Vec3 &a = rays[0].position, &b = rays[1].position, &c = rays[2].position;
    const Vec3 longest = longest_side(rays);
    if (longest.isZero(0)) return SegmentEnd{position, direction, offset};  // bent all at one place
    if ((b - a).cross(c - a).norm() >= least_height * longest.squaredNorm()) return {};
    const Vec3 along = longest.stableNormalized();
    const Vec3 across = direction - direction.dot(along) * along;
    return SegmentEnd{position, across.isZero(0) ? direction : across.normalized(), 2 * offset};
}

ArrivingRay arriving_ray(const BeamSet& set, const BeamHit& hit) {
    const Beam& beam = set.beams[hit.beam];
    const auto rays = set.triangle(beam, hit.triangle, hit.place());
    Vec3 position = Vec3::Zero();
    Vec3 direction = Vec3::Zero();
    for (std::size_t i = 0; i < 3; ++i) {
        const float weight = hit.weights[static_cast<Eigen::Index>(i)];
        position += weight * rays[i].position;
        direction += weight * rays[i].direction;
    }
    direction.normalize();
    const SegmentEnd on_plane{position,
                              triangle_normal(rays[0].position, rays[1].position, rays[2].position),
                              beam.offset};
    const auto on_sliver = start_on_sliver(rays, position, direction, beam.offset);
    return {on_sliver.value_or(on_plane), direction,
            on_sliver ? std::optional(on_plane) : std::nullopt};
}

// Whether what light meets first on its way to a part of a cell is the receiver: the same shape about where the part lies, or
// any other just there, of a floor in pieces. Surfaces bend away from the point's tangent plane.
bool meets_receiver(const Scene& scene, const ReceiverPoint& point, const BeamHit& hit,
                    const SegmentEnd& start) {
    const Vec3 middle = point.position + hit.offset;
    Ray ray = spawn_ray(start, (middle - start.position).normalized());
    ray.direction = (middle - ray.origin).normalized();
    const auto met = scene.intersect(ray);
    if (!met) return false;
    const float away = (met->position - middle).norm();
    if (away <= std::max(hit.cell_radius / 100, 4 * point.offset)) return true;
    const float slant = std::abs(point.geometric_normal.dot(ray.direction));
    return met->shape == point.shape && away * slant <= 2 * hit.cell_radius + 4 * point.offset &&
           std::abs(met->geometric_normal.dot(point.geometric_normal)) >= same_surface_cosine;
}

// True where light is even over a polygon's image, but for its perspective: no facet bends neighbouring rays differently.
bool meets_flat_facets_alone(const Scene& scene, const BeamSet& set) {
    return std::ranges::all_of(set.path, [&](const SpecularEvent& event) {
        const Shape& shape = scene.shapes()[event.shape];
        return shape.primitive == Primitive::mesh && shape.mesh.normals.empty();
    });
}

// Both polygons of an edge find what lies on it.
bool was_found_before(const Root& root, RootScratch& scratch) {
    if (root.edge_room == 0) return false;
    constexpr float same_direction = 1e-3F;
    for (const Root& other : scratch.on_edge)
        if ((other.first - root.first).norm() <= std::max(root.edge_room, other.edge_room) &&
            (other.direction - root.direction).norm() < same_direction)
            return true;
    scratch.on_edge.push_back(root);
    return false;
}

}  // namespace

BeamLight::BeamLight(const Scene& scene, const std::vector<BeamSet>& sets)
    : scene_(scene), sets_(sets), searches_(sets.size()) {
    for (std::size_t i = 0; i < sets.size(); ++i)
        if (sets[i].has_roots()) searches_[i].emplace(scene, sets[i]);
}

template <typename Weight>
SpectrumSum BeamLight::of_root(const ReceiverPoint& point, const BeamHit& hit, const Root& root,
                               const Spectrum& share, const Weight& weight) const {
    const float slant = -point.geometric_normal.dot(root.direction);
    if (!(slant > 0)) return SpectrumSum::Zero();
    const Spectrum factor = share * weight(Vec3(-root.direction));
    if (is_black(factor)) return SpectrumSum::Zero();
    if (scene_.occluded({point.position, point.geometric_normal, point.offset}, root.start))
        return SpectrumSum::Zero();
    const BeamSet& set = sets_[hit.set];
    const Spectrum left = transmittance(set.absorption[set.beams[hit.beam].inside ? 1 : 0],
                                        (point.position - root.start.position).norm());
    return (factor * root.weight * left).template cast<double>() * root.density *
           static_cast<double>(slant);
}

template <typename Weight>
SpectrumSum BeamLight::of_polygon(const ReceiverPoint& point, const BeamHit& hit,
                                  const Spectrum& share, const Weight& weight) const {
    const BeamSet& set = sets_[hit.set];
    const Beam& beam = set.beams[hit.beam];
    const ArrivingRay ray = arriving_ray(set, hit);
    if (!(point.geometric_normal.dot(ray.direction) < 0)) return SpectrumSum::Zero();
    const Spectrum factor = share * weight(Vec3(-ray.direction));
    if (is_black(factor)) return SpectrumSum::Zero();
    const SegmentEnd receiver{point.position, point.geometric_normal, point.offset};
    const auto is_free = [&](const SegmentEnd& start) {
        if (hit.cell_radius > 0 ? !meets_receiver(scene_, point, hit, start)
                                : scene_.occluded(receiver, start))
            return false;
        // Of light after several events the earlier legs were seen to be free when it was traced.
        return set.path.size() > 1 || sees(scene_, start, set.light);
    };
    if (!is_free(ray.start) && !(ray.other_start && is_free(*ray.other_start)))
        return SpectrumSum::Zero();
    const double cosine = std::abs(static_cast<double>(point.geometric_normal.dot(ray.direction)));
    const Spectrum left = transmittance(set.absorption[beam.inside ? 1 : 0],
                                        (point.position - ray.start.position).norm());
    // Of a small polygon in a cell no more than the cell's area counts.
    const double area =
        hit.is_part_of_cell() ? hit.area : std::max(hit.area, resolvable_area(point.position));
    double density =
        refined_density(set, hit, point.position).value_or(hit.flux_share / area);  // [CC95 (11)]
    density *= hit.coverage;
    // The caustic polygon lies on the test's plane; the receiver's is turned against it.
    density *= cosine / std::abs(static_cast<double>(hit.plane_normal.dot(ray.direction)));
    return (factor * beam.flux * left).template cast<double>() * density;
}

template <typename OfRoot, typename OfPolygon>
void BeamLight::visit(const ReceiverPoint& point, std::vector<BeamHit>& hits, RootScratch& scratch,
                      const OfRoot& of_root, const OfPolygon& of_polygon) const {
    std::sort(hits.begin(), hits.end(), [](const BeamHit& a, const BeamHit& b) {
        return std::tie(a.set, a.beam, a.triangle, a.from) <
               std::tie(b.set, b.beam, b.triangle, b.from);
    });
    std::uint32_t set = ~0U;
    for (const BeamHit& hit : hits) {
        const Spectrum share =
            share_of_wavelengths(sets_[hit.set].light, hit.from, hit.to, point.nm);
        if (is_black(share)) continue;
        if (!hit.has_roots) {
            of_polygon(hit, share);
            continue;
        }
        if (hit.set != set) scratch.on_edge.clear();
        set = hit.set;
        scratch.roots.clear();
        const bool settled =
            searches_[set]->find(hit.beam, hit.triangle, point.position, scratch.roots);
        for (const Root& root : scratch.roots) {
            if (was_found_before(root, scratch)) continue;
            ++scratch.found;
            of_root(hit, root, share);
        }
        if (settled || hit.winding == 0) continue;
        ++scratch.unsettled;
        of_polygon(hit, share);
    }
}

template <typename Weight>
Spectrum BeamLight::sum(const ReceiverPoint& point, std::vector<BeamHit>& hits,
                        RootScratch& scratch, const Weight& weight) const {
    SpectrumSum sum = SpectrumSum::Zero();
    visit(
        point, hits, scratch,
        [&](const BeamHit& hit, const Root& root, const Spectrum& share) {
            sum += of_root(point, hit, root, share, weight);
        },
        [&](const BeamHit& hit, const Spectrum& share) {
            sum += of_polygon(point, hit, share, weight);
        });
    return sum.cast<float>();
}

bool BeamLight::searches_roots() const {
    return std::ranges::any_of(searches_, [](const auto& search) { return search.has_value(); });
}

RayCount BeamLight::count(const ReceiverPoint& point, const Vec3& direction,
                          std::vector<BeamHit>& hits, RootScratch& scratch) const {
    constexpr float of_same_root = 1e-3F;
    constexpr float of_same_polygon = 0.1F;
    const SegmentEnd receiver{point.position, point.geometric_normal, point.offset};
    RayCount count = RayCount::missed;
    visit(
        point, hits, scratch,
        [&](const BeamHit&, const Root& root, const Spectrum&) {
            if ((root.direction - direction).norm() <= of_same_root &&
                !scene_.occluded(receiver, root.start))
                count = RayCount::exact;
        },
        [&](const BeamHit& hit, const Spectrum&) {
            const BeamSet& set = sets_[hit.set];
            const Vec3 middle = arriving_ray(set, hit).direction;
            if (count != RayCount::missed || (middle - direction).norm() > of_same_polygon) return;
            count = meets_flat_facets_alone(scene_, set) ? RayCount::exact : RayCount::spread;
        });
    return count;
}

Spectrum BeamLight::irradiance(const ReceiverPoint& point, std::vector<BeamHit>& hits,
                               RootScratch& scratch) const {
    return sum(point, hits, scratch, [](const Vec3&) { return Spectrum(Spectrum::Ones()); });
}

Spectrum BeamLight::radiance(const ReceiverPoint& point, std::vector<BeamHit>& hits,
                             RootScratch& scratch) const {
    return sum(point, hits, scratch, [&point](const Vec3& wi) {
        return evaluate(*point.bsdf, point.uv, point.shading_normal, point.wo, wi);
    });
}

}  // namespace caustics::beamtree
