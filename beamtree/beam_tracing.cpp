#include "beamtree/beam_tracing.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "beamtree/bent_light.h"
#include "beamtree/ray_spread.h"
#include "core/optics.h"
#include "core/parallel.h"

namespace caustics {
namespace {

// How often a triangle is quartered whose corners do not tell what it does.
constexpr int most_splits = 5;
// The rays of a polygon's beam part by less than 60 degrees, those of a quartered one's by less than 30.
constexpr float widest_cosine = 0.5F;
constexpr float widest_cosine_of_parts = 0.866F;

/// How a triangle of the mesh stands to the light.
struct Facing {
    Vec3 normal;
    bool front;   ///< the light comes to its front
    bool hidden;  ///< and no light can come to that side
};

/// What a piece of the mesh is part of, and what happens there.
struct Origin {
    std::uint32_t triangle;  ///< the first, of a quad
    std::uint32_t triangle_count;
    const Facing& facing;
    Event event;
};

// The rule of split_specular, for a point whose light was bent by the vertex normal alone: the
// light must come to the same side of both normals, and leave on the right side of both.
bool sends_on(const MeshPoint& point, const Origin& origin) {
    const BentLight& bent = point.bent;
    const Facing& facing = origin.facing;
    const bool leaves_front = facing.normal.dot(bent.direction[origin.event]) > 0;
    return bent.front == facing.front &&
           leaves_front == (facing.front == (origin.event == reflection)) &&
           !is_black(bent.weight[origin.event]);
}

bool part_widely(std::span<const MeshPoint> corners, Event event, bool whole) {
    const float widest = whole ? widest_cosine : widest_cosine_of_parts;
    for (const MeshPoint& a : corners)
        for (const MeshPoint& b : corners)
            if (a.bent.direction[event].dot(b.bent.direction[event]) < widest) return true;
    return false;
}

class BeamTracer {
public:
    BeamTracer(const Scene& scene, const CasterMesh& caster, const LightSample& light)
        : scene_(scene),
          bsdf_(scene.shapes()[caster.shape].bsdf),
          caster_(caster),
          mesh_(caster.mesh),
          light_(light),
          bender_(scene, caster.shape, light),
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

    /// With `neighbours` the sets are refined by them.
    std::array<BeamSet, 2> run(const MeshNeighbours* neighbours) {
        for (std::uint32_t i = 0; i < mesh_.positions.size(); ++i) {
            vertices_.push_back(bender_.at(mesh_.positions[i], mesh_.normals[i]));
            vertices_.back().vertex = i;
        }
        auto quad = caster_.quads.begin();
        for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
            if (quad != caster_.quads.end() && quad->triangle == i) {
                trace_quad(*quad++);
                ++i;
            } else if (!caster_.left_out[i]) {
                const Facing facing = facing_of(i);
                for (const Event event : events) trace_triangle({i, 1, facing, event});
            }
        }
        if (neighbours != nullptr)
            for (const Event event : events) refine(sets_[event], origins_[event], *neighbours);
        return std::move(sets_);
    }

private:
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

    void trace_triangle(const Origin& origin) {
        if (origin.facing.hidden) return;
        const auto& [a, b, c] = mesh_.triangles[origin.triangle];
        trace_piece({vertices_[a], vertices_[b], vertices_[c]}, origin, most_splits);
    }

    // One polygon where both of its triangles send all of their light on, else they go by themselves.
    void trace_quad(const CellQuad& quad) {
        const std::array<Facing, 2> sides = {facing_of(quad.triangle),
                                             facing_of(quad.triangle + 1)};
        const bool alike = sides[0].front == sides[1].front && !sides[0].hidden && !sides[1].hidden;
        const auto& [a, b, c, d] = quad.corners;
        const std::array<MeshPoint, 4> corners = {vertices_[a], vertices_[b], vertices_[c],
                                                  vertices_[d]};
        for (const Event event : events) {
            const Origin whole{quad.triangle, 2, sides[0], event};
            const Origin second{quad.triangle + 1, 1, sides[1], event};
            bool is_whole = alike && !part_widely(corners, event, true);
            for (const std::size_t i : {0, 1, 2})
                is_whole = is_whole && sends_on(corners[i], whole);
            for (const std::size_t i : {0, 2, 3})
                is_whole = is_whole && sends_on(corners[i], second);
            if (is_whole) {
                add_beam(corners, whole);
            } else {
                trace_triangle({quad.triangle, 1, sides[0], event});
                trace_triangle(second);
            }
        }
    }

    void trace_piece(const MeshPiece& piece, const Origin& origin, int splits) {
        const std::vector<MeshPoint> lit = lit_part(piece, origin);
        if (splits > 0 &&
            (part_widely(lit, origin.event, splits == most_splits) || deceives(piece, origin))) {
            const auto& [a, b, c] = piece;
            const MeshPoint ab = bender_.between(a, b, 0.5F);
            const MeshPoint bc = bender_.between(b, c, 0.5F);
            const MeshPoint ca = bender_.between(c, a, 0.5F);
            for (const MeshPiece& part : {MeshPiece{a, ab, ca}, MeshPiece{ab, b, bc},
                                          MeshPiece{ca, bc, c}, MeshPiece{ab, bc, ca}})
                trace_piece(part, origin, splits - 1);
        } else if (!lit.empty()) {
            add_beam(lit, origin);
        }
    }

    // Whether corners that are all lit or all dark do not tell what the piece does: inside it, or
    // straight below the light, it is another thing.
    bool deceives(const MeshPiece& piece, const Origin& origin) const {
        const auto& [a, b, c] = piece;
        const auto middle = [&] {
            return sends_on(bender_.inside(piece, Vec3::Constant(1.0F / 3)), origin);
        };
        const int lit = sends_on(a, origin) + sends_on(b, origin) + sends_on(c, origin);
        if (lit > 0) return lit == 3 && weights_differ(piece, origin.event) && !middle();
        if (origin.event == refraction && !std::holds_alternative<Dielectric>(bsdf_.model))
            return false;
        return middle() || sends_on(bender_.nearest_to_light(piece), origin) ||
               sends_on(bender_.between(a, b, 0.5F), origin) ||
               sends_on(bender_.between(b, c, 0.5F), origin) ||
               sends_on(bender_.between(c, a, 0.5F), origin);
    }

    // The corners of what sends light on, by the piece's own corners: none, three or four.
    std::vector<MeshPoint> lit_part(const MeshPiece& piece, const Origin& origin) const {
        std::vector<MeshPoint> left;
        for (std::size_t i = 0; i < 3; ++i) {
            const MeshPoint& a = piece[i];
            const MeshPoint& b = piece[(i + 1) % 3];
            const bool a_sends = sends_on(a, origin);
            if (a_sends) left.push_back(a);
            if (a_sends != sends_on(b, origin))
                left.push_back(a_sends ? cut_edge(a, b, origin) : cut_edge(b, a, origin));
        }
        return left;
    }

    // The last point of an edge, from its good end, where light is still sent on.
    MeshPoint cut_edge(const MeshPoint& good, const MeshPoint& bad, const Origin& origin) const {
        MeshPoint last = good;
        last.vertex = MeshPoint::no_vertex;
        float low = 0;
        float high = 1;
        for (int step = 0; step < 20; ++step) {
            const float t = (low + high) / 2;
            const MeshPoint here = bender_.between(good, bad, t);
            const bool sends = sends_on(here, origin);
            (sends ? low : high) = t;
            if (sends) last = here;
        }
        return last;
    }

    void add_beam(std::span<const MeshPoint> corners, const Origin& origin) {
        BeamSet& set = sets_[origin.event];
        Beam beam;
        std::array<Spectrum, 2> flux = {black(), black()};
        for (std::size_t i = 0; i + 2 < corners.size(); ++i)
            flux[i] = bender_.flux({corners[0], corners[1 + i], corners[2 + i]}, origin.event);
        beam.flux = flux[0] + flux[1];
        if (!(beam.flux.mean() > 0)) return;
        beam.first_share = flux[0].mean() / beam.flux.mean();
        beam.triangle = origin.triangle;
        beam.inside = origin.facing.front == (origin.event == refraction);
        for (std::uint32_t i = 0; i < origin.triangle_count; ++i)
            beam.offset = std::max(beam.offset,
                                   surface_offset_ + distance_to_exact_surface(beam.triangle + i));
        beam.corners.fill(Beam::none);
        for (std::size_t i = 0; i < corners.size(); ++i)
            beam.corners[i] = ray_of(corners[i], origin.event);
        set.beams.push_back(beam);
    }

    // Beams that meet in a vertex share its ray.
    std::uint32_t ray_of(const MeshPoint& point, Event event) {
        std::vector<VertexRay>& rays = sets_[event].rays;
        const bool shared = point.vertex != MeshPoint::no_vertex;
        if (shared && ray_of_vertex_[event][point.vertex] != Beam::none)
            return ray_of_vertex_[event][point.vertex];
        rays.push_back({point.position, point.bent.direction[event]});
        origins_[event].push_back(
            {point.position, point.normal, point.bent.weight[event], point.vertex});
        const auto ray = static_cast<std::uint32_t>(rays.size() - 1);
        if (shared) ray_of_vertex_[event][point.vertex] = ray;
        return ray;
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
    LightBender bender_;
    ClosedParts::Hidden hidden_;
    float surface_offset_;
    std::vector<MeshPoint> vertices_;
    std::array<std::vector<std::uint32_t>, 2> ray_of_vertex_;
    std::array<BeamSet, 2> sets_;
    std::array<std::vector<RayOrigin>, 2> origins_;  ///< one a ray
};

}  // namespace

std::array<BeamSet, 2> trace_beams(const Scene& scene, const CasterMesh& caster,
                                   const LightSample& light) {
    return BeamTracer(scene, caster, light).run(nullptr);
}

std::vector<BeamSet> trace_all_beams(const Scene& scene, const std::vector<CasterMesh>& casters,
                                     const std::vector<LightSample>& lights,
                                     const RunOptions& options, Intensity intensity) {
    std::vector<MeshNeighbours> neighbours;
    if (intensity == Intensity::refined)
        for (const CasterMesh& caster : casters) neighbours.emplace_back(caster);
    std::vector<std::array<BeamSet, 2>> pairs(lights.size() * casters.size());
    parallel_for(options.threads, pairs.size(), [&](std::size_t i, std::size_t) {
        const std::size_t caster = i % casters.size();
        pairs[i] = BeamTracer(scene, casters[caster], lights[i / casters.size()])
                       .run(neighbours.empty() ? nullptr : &neighbours[caster]);
    });
    std::vector<BeamSet> sets;
    for (std::array<BeamSet, 2>& pair : pairs)
        for (BeamSet& set : pair)
            if (!set.beams.empty()) sets.push_back(std::move(set));
    return sets;
}

}  // namespace caustics
