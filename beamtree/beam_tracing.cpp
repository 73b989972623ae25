#include "beamtree/beam_tracing.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/optics.h"
#include "core/parallel.h"

namespace caustics {
namespace {

enum Event : std::size_t { reflection, refraction };
constexpr std::array<Event, 2> events = {reflection, refraction};

/// What the surface does with the light at one point.
struct BentLight {
    bool front = false;  ///< the light comes to the normal's side
    std::array<Vec3, 2> direction;
    std::array<Spectrum, 2> weight = {black(), black()};  ///< strength after each event
};

/// A beam while it is put together.
struct Corner {
    std::uint32_t ray;
    Spectrum weight;
    Vec3 normal;
};

/// The part of one or two triangles of the mesh that sends light on.
struct Polygon {
    std::vector<Corner> corners;  ///< three or four
    std::uint32_t triangle;       ///< the first
    std::uint32_t triangle_count;
    bool front;  ///< the light comes to its front
};

class BeamTracer {
public:
    BeamTracer(const Scene& scene, const CasterMesh& caster, const LightSample& light)
        : scene_(scene),
          bsdf_(scene.shapes()[caster.shape].bsdf),
          caster_(caster),
          mesh_(caster.mesh),
          light_(light),
          hidden_(caster.closed.hidden_from(caster.mesh, light)),
          surface_offset_(scene.offset(caster.shape)) {
        for (const Event event : events) {
            sets_[event].light = light;
            sets_[event].caster = caster.shape;
            sets_[event].refracted = event == refraction;
            if (const auto* medium = std::get_if<Dielectric>(&bsdf_.model))
                sets_[event].absorption = {medium->ext_absorption, medium->absorption};
            ray_of_vertex_[event].assign(mesh_.positions.size(), Beam::none);
        }
    }

    std::array<BeamSet, 2> run() {
        for (std::size_t i = 0; i < mesh_.positions.size(); ++i)
            at_vertex_.push_back(bend(mesh_.positions[i], mesh_.normals[i], mesh_.normals[i]));
        auto quad = caster_.quads.begin();
        for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
            if (quad != caster_.quads.end() && quad->triangle == i) {
                trace_quad(*quad++);
                ++i;
            } else if (!caster_.left_out[i]) {
                trace_triangle(i, facing_of(i));
            }
        }
        return std::move(sets_);
    }

private:
    BentLight bend(const Vec3& position, const Vec3& ng, const Vec3& ns) const {
        BentLight bent;
        const Vec3 w = to_light(light_, position);
        if (w.isZero(0) || ns.isZero(0)) return bent;
        bent.front = ng.dot(w) > 0;
        const SpecularSplit split = split_specular(bsdf_, ng, ns, w);
        const Spectrum* const medium = medium_absorption(bsdf_, ng, w);
        const Spectrum arriving =
            strength_along(light_, w) *
            segment_transmittance(nullptr, medium, distance_from(light_, position));
        bent.direction = {split.reflected, split.refracted};
        bent.weight = {split.reflected_weight * arriving, split.refracted_weight * arriving};
        return bent;
    }

    /// How a triangle stands to the light.
    struct Facing {
        Vec3 normal;
        bool front;   ///< the light comes to its front
        bool hidden;  ///< and no light can come to that side
    };

    Facing facing_of(std::uint32_t index) const {
        const auto& [i, j, k] = mesh_.triangles[index];
        const Vec3& a = mesh_.positions[i];
        const Vec3& b = mesh_.positions[j];
        const Vec3& c = mesh_.positions[k];
        Facing facing{triangle_normal(a, b, c), false, false};
        const Vec3 middle = (a + b + c) / 3;
        facing.front = facing.normal.dot(to_light(light_, middle)) > 0;
        // A surface that meets itself may be lit on what counts as its inside.
        facing.hidden = hidden_(index, facing.front) &&
                        !sees(scene_, {middle, facing.normal, surface_offset_}, light_);
        return facing;
    }

    void trace_triangle(std::uint32_t index, const Facing& facing) {
        for (const Event event : events) trace_triangle(index, facing, event);
    }

    void trace_triangle(std::uint32_t index, const Facing& facing, Event event) {
        if (facing.hidden) return;
        const auto& triangle = mesh_.triangles[index];
        std::array<bool, 3> bends{};
        for (std::size_t i = 0; i < 3; ++i)
            bends[i] = sends_on(at_vertex_[triangle[i]], event, facing);
        const auto count = std::count(bends.begin(), bends.end(), true);
        if (count == 0) return;
        add_beam({count == 3 ? whole(triangle, event) : cut(triangle, bends, event, facing), index,
                  1, facing.front},
                 event);
    }

    // One polygon where both of its triangles send all of their light on, else they go by themselves.
    void trace_quad(const CellQuad& quad) {
        const std::array<Facing, 2> sides = {facing_of(quad.triangle),
                                             facing_of(quad.triangle + 1)};
        const bool alike = sides[0].front == sides[1].front && !sides[0].hidden && !sides[1].hidden;
        for (const Event event : events) {
            const auto& [a, b, c, d] = quad.corners;
            bool is_whole = alike;
            for (const std::uint32_t vertex : {a, b, c})
                is_whole = is_whole && sends_on(at_vertex_[vertex], event, sides[0]);
            for (const std::uint32_t vertex : {a, c, d})
                is_whole = is_whole && sends_on(at_vertex_[vertex], event, sides[1]);
            if (is_whole) {
                add_beam({whole(quad.corners, event), quad.triangle, 2, sides[0].front}, event);
            } else {
                trace_triangle(quad.triangle, sides[0], event);
                trace_triangle(quad.triangle + 1, sides[1], event);
            }
        }
    }

    // The rule of split_specular, for a corner whose light was bent by the vertex normal alone: the
    // light must come to the same side of both normals, and leave on the right side of both.
    static bool sends_on(const BentLight& bent, Event event, const Facing& facing) {
        const bool leaves_front = facing.normal.dot(bent.direction[event]) > 0;
        return bent.front == facing.front &&
               leaves_front == (facing.front == (event == reflection)) &&
               !is_black(bent.weight[event]);
    }

    std::vector<Corner> whole(std::span<const std::uint32_t> polygon, Event event) {
        std::vector<Corner> corners;
        for (const std::uint32_t vertex : polygon) corners.push_back(shared(vertex, event));
        return corners;
    }

    Corner shared(std::uint32_t vertex, Event event) {
        const BentLight& bent = at_vertex_[vertex];
        std::uint32_t& ray = ray_of_vertex_[event][vertex];
        if (ray == Beam::none) ray = add_ray(event, mesh_.positions[vertex], bent.direction[event]);
        return {ray, bent.weight[event], mesh_.normals[vertex]};
    }

    std::uint32_t add_ray(Event event, const Vec3& position, const Vec3& direction) {
        sets_[event].rays.push_back({position, direction});
        return static_cast<std::uint32_t>(sets_[event].rays.size() - 1);
    }

    std::vector<Corner> cut(const std::array<std::uint32_t, 3>& triangle,
                            const std::array<bool, 3>& bends, Event event, const Facing& facing) {
        std::vector<Corner> corners;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3;
            if (bends[i]) corners.push_back(shared(triangle[i], event));
            if (bends[i] == bends[j]) continue;
            const std::uint32_t good = triangle[bends[i] ? i : j];
            const std::uint32_t bad = triangle[bends[i] ? j : i];
            corners.push_back(cut_edge(good, bad, event, facing));
        }
        return corners;
    }

    // The last point of an edge, from its good end, where light is still sent on.
    Corner cut_edge(std::uint32_t good, std::uint32_t bad, Event event, const Facing& facing) {
        Vec3 position = mesh_.positions[good];
        Vec3 normal = mesh_.normals[good];
        BentLight bent = at_vertex_[good];
        float low = 0;
        float high = 1;
        for (int step = 0; step < 20; ++step) {
            const float t = (low + high) / 2;
            const Vec3 p =
                mesh_.positions[good] + t * (mesh_.positions[bad] - mesh_.positions[good]);
            const Vec3 n = (1 - t) * mesh_.normals[good] + t * mesh_.normals[bad];
            const Vec3 unit = n.squaredNorm() > 0 ? Vec3(n.normalized()) : n;
            const BentLight here = bend(p, unit, unit);
            if (!sends_on(here, event, facing)) {
                high = t;
                continue;
            }
            low = t;
            position = p;
            normal = unit;
            bent = here;
        }
        return {add_ray(event, position, bent.direction[event]), bent.weight[event], normal};
    }

    void add_beam(const Polygon& polygon, Event event) {
        const std::vector<Corner>& corners = polygon.corners;
        BeamSet& set = sets_[event];
        Beam beam;
        beam.corners = {corners[0].ray, corners[1].ray, corners[2].ray,
                        corners.size() > 3 ? corners[3].ray : Beam::none};
        beam.triangle = polygon.triangle;
        beam.inside = polygon.front == (event == refraction);
        for (std::uint32_t i = 0; i < polygon.triangle_count; ++i)
            beam.offset = std::max(beam.offset,
                                   surface_offset_ + distance_to_exact_surface(beam.triangle + i));
        std::array<Spectrum, 2> flux = {black(), black()};
        for (std::size_t i = 0; i < beam.triangle_count(); ++i) {
            flux[i] = triangle_flux({corners[0], corners[1 + i], corners[2 + i]}, event);
        }
        beam.flux = flux[0] + flux[1];
        if (!(beam.flux.mean() > 0)) return;
        beam.first_share = flux[0].mean() / beam.flux.mean();
        set.beams.push_back(beam);
    }

    // The mean of the corners' weights is right to second order where they are alike. Near total
    // reflection, where Fresnel's shares run like a root, the surface is asked inside as well.
    Spectrum triangle_flux(const std::array<Corner, 3>& corners, Event event) const {
        const std::vector<VertexRay>& rays = sets_[event].rays;
        const Vec3& a = rays[corners[0].ray].position;
        const Vec3& b = rays[corners[1].ray].position;
        const Vec3& c = rays[corners[2].ray].position;
        float least = corners[0].weight.mean();
        float most = least;
        for (const Corner& corner : corners) {
            least = std::min(least, corner.weight.mean());
            most = std::max(most, corner.weight.mean());
        }
        if (most <= 1.5F * least)
            return (corners[0].weight + corners[1].weight + corners[2].weight) *
                   static_cast<float>(measure(light_, a, b, c) / 3);
        const std::array<Vec3, 3> normals = {corners[0].normal, corners[1].normal,
                                             corners[2].normal};
        const auto at = [&](const Vec3& l) -> Vec3 { return l[0] * a + l[1] * b + l[2] * c; };
        const auto piece = [&](const Vec3& u, const Vec3& v, const Vec3& w) -> Spectrum {
            const Vec3 l = (u + v + w) / 3;
            const Vec3 n = l[0] * normals[0] + l[1] * normals[1] + l[2] * normals[2];
            const Vec3 unit = n.squaredNorm() > 0 ? Vec3(n.normalized()) : n;
            return bend(at(l), unit, unit).weight[event] *
                   static_cast<float>(measure(light_, at(u), at(v), at(w)));
        };
        constexpr int n = 8;
        const auto corner = [](int i, int j) -> Vec3 {
            const Vec2 share(static_cast<float>(i) / n, static_cast<float>(j) / n);
            return {1 - share.x() - share.y(), share.x(), share.y()};
        };
        Spectrum sum = black();
        for (int i = 0; i < n; ++i)
            for (int j = 0; i + j < n; ++j) {
                sum += piece(corner(i, j), corner(i + 1, j), corner(i, j + 1));
                if (i + j + 2 <= n)
                    sum += piece(corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1));
            }
        return sum;
    }

    // Bound of how far the exact shape bulges from its triangle: |edge| |turn of the normal| / 8 for
    // a circular arc, twice that for others and for what adds up inside the triangle.
    float distance_to_exact_surface(std::uint32_t index) const {
        if (!caster_.tessellated) return 0;
        const auto& triangle = mesh_.triangles[index];
        float bulge = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = triangle[i];
            const std::uint32_t b = triangle[(i + 1) % 3];
            bulge = std::max(bulge, (mesh_.positions[a] - mesh_.positions[b]).norm() *
                                        (mesh_.normals[a] - mesh_.normals[b]).norm());
        }
        return bulge / 4;
    }

    const Scene& scene_;
    const Bsdf& bsdf_;
    const CasterMesh& caster_;
    const TriangleMesh& mesh_;
    const LightSample& light_;
    ClosedParts::Hidden hidden_;
    float surface_offset_;
    std::vector<BentLight> at_vertex_;
    std::array<std::vector<std::uint32_t>, 2> ray_of_vertex_;
    std::array<BeamSet, 2> sets_;
};

}  // namespace

std::array<BeamSet, 2> trace_beams(const Scene& scene, const CasterMesh& caster,
                                   const LightSample& light) {
    return BeamTracer(scene, caster, light).run();
}

std::vector<BeamSet> trace_all_beams(const Scene& scene, const std::vector<CasterMesh>& casters,
                                     const std::vector<LightSample>& lights,
                                     const RunOptions& options) {
    std::vector<std::array<BeamSet, 2>> pairs(lights.size() * casters.size());
    parallel_for(options.threads, pairs.size(), [&](std::size_t i, std::size_t) {
        pairs[i] = trace_beams(scene, casters[i % casters.size()], lights[i / casters.size()]);
    });
    std::vector<BeamSet> sets;
    for (std::array<BeamSet, 2>& pair : pairs)
        for (BeamSet& set : pair)
            if (!set.beams.empty()) sets.push_back(std::move(set));
    return sets;
}

}  // namespace caustics
