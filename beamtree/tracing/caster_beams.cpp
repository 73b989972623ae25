#include "beamtree/tracing/caster_beams.h"

#include <algorithm>
#include <optional>
#include <span>

#include "beamtree/beams/behind_polygons.h"
#include "beamtree/beams/lit_caster.h"
#include "beamtree/beams/near_light.h"
#include "beamtree/beams/ray_spread.h"
#include "beamtree/light/root_beams.h"
#include "beamtree/tracing/cut_piece.h"
#include "beamtree/tracing/kept_beams.h"
#include "beamtree/tracing/set_chunk.h"
#include "core/base/parallel.h"

namespace caustics::beamtree {
namespace {

// How often a triangle is quartered whose corners do not tell what it does.
constexpr int most_splits = 5;
// How often an edge is halved to find where light stops going on.
constexpr int bisections = 20;
// What threads take at a time.
constexpr std::size_t vertices_together = 1024;
constexpr std::size_t polygons_together = 256;
// The rays of a polygon's beam part by less than 60 degrees, those of a quartered one's by less
// than 30.
constexpr float widest_cosine = 0.5F;
constexpr float widest_cosine_of_parts = 0.866F;

/// What a piece of the mesh is part of, and what happens there.
struct Origin {
    std::uint32_t triangle;  ///< the first, of a quad
    std::uint32_t triangle_count;
    const Facing& facing;
    Event event;
};

using Corners = std::span<const MeshPoint* const>;

bool part_widely(Corners corners, Event event, bool whole) {
    const float widest = whole ? widest_cosine : widest_cosine_of_parts;
    for (std::size_t i = 0; i < corners.size(); ++i)
        for (std::size_t j = i + 1; j < corners.size(); ++j)
            if (corners[i]->bent.direction[event].dot(corners[j]->bent.direction[event]) < widest)
                return true;
    return false;
}

/// The vertices of a caster's mesh in its light.
std::vector<MeshPoint> bent_vertices(const LitCaster& surface, int threads) {
    const TriangleMesh& mesh = surface.caster().mesh;
    std::vector<MeshPoint> vertices(mesh.positions.size());
    parallel_chunks(threads, vertices.size(), vertices_together, [&](const Chunk& chunk) {
        for (std::size_t i = chunk.first; i < chunk.end; ++i) {
            vertices[i] = surface.bender().at(mesh.positions[i], mesh.normals[i]);
            vertices[i].vertex = static_cast<std::uint32_t>(i);
        }
    });
    return vertices;
}

/// Traces some polygons of a caster; keys of their rays are vertices.
class BeamTracer {
public:
    BeamTracer(const LitCaster& surface, const NearLight& near_light,
               const std::vector<MeshPoint>& vertices)
        : surface_(surface),
          bender_(surface.bender()),
          caster_(surface.caster()),
          mesh_(surface.caster().mesh),
          near_light_(near_light),
          vertices_(vertices) {}

    // Triangles from `first` to `end`; a quad belongs to its first one.
    std::array<SetChunk, 2> run(std::size_t first, std::size_t end, const ProgressPart& part) {
        const auto begins_before = [](const CellQuad& quad, std::size_t triangle) {
            return quad.triangle < triangle;
        };
        auto quad =
            std::lower_bound(caster_.quads.begin(), caster_.quads.end(), first, begins_before);
        if (quad != caster_.quads.begin() && std::prev(quad)->triangle + 1 == first) ++first;
        for (auto i = static_cast<std::uint32_t>(first); i < end; ++i) {
            if (quad != caster_.quads.end() && quad->triangle == i) {
                trace_quad(*quad++);
                ++i;
            } else if (!caster_.left_out[i]) {
                const Facing facing = surface_.facing(i);
                for (const Event event : events) trace_triangle({i, 1, facing, event});
            }
        }
        part.progress.add(part.share * static_cast<double>(end - first) /
                          static_cast<double>(mesh_.triangles.size()));
        return std::move(traced_);
    }

private:
    void trace_triangle(const Origin& origin) {
        if (origin.facing.hidden) return;
        const auto& [i, j, k] = mesh_.triangles[origin.triangle];
        const MeshPoint& a = vertices_[i];
        const MeshPoint& b = vertices_[j];
        const MeshPoint& c = vertices_[k];
        const std::array<const MeshPoint*, 3> corners = {&a, &b, &c};
        if (near_light_.is_near(corners)) {
            for (const MeshPiece& piece : near_light_.pieces({a, b, c}))
                trace_piece(piece, origin, most_splits);
            return;
        }
        const bool plain =
            sends_on(a, origin.facing, origin.event) && sends_on(b, origin.facing, origin.event) &&
            sends_on(c, origin.facing, origin.event) && !part_widely(corners, origin.event, true) &&
            !weights_differ(corners, origin.event);
        if (plain)
            add_beam(corners, origin);
        else
            trace_piece({a, b, c}, origin, most_splits);
    }

    // One polygon where both of its triangles send all of their light on, else they go by
    // themselves.
    void trace_quad(const CellQuad& quad) {
        const std::array<Facing, 2> sides = {surface_.facing(quad.triangle),
                                             surface_.facing(quad.triangle + 1)};
        const bool alike = sides[0].front == sides[1].front && !sides[0].hidden && !sides[1].hidden;
        const auto& [a, b, c, d] = quad.corners;
        const std::array<const MeshPoint*, 4> corners = {&vertices_[a], &vertices_[b],
                                                         &vertices_[c], &vertices_[d]};
        const bool near_light = near_light_.is_near({corners[0], corners[1], corners[2]}) ||
                                near_light_.is_near({corners[0], corners[2], corners[3]});
        for (const Event event : events) {
            const Origin whole{quad.triangle, 2, sides[0], event};
            bool is_whole = alike && !near_light && !part_widely(corners, event, true);
            for (const std::size_t i : {0U, 1U, 2U})
                is_whole = is_whole && sends_on(*corners[i], sides[0], event);
            for (const std::size_t i : {0U, 2U, 3U})
                is_whole = is_whole && sends_on(*corners[i], sides[1], event);
            if (is_whole) {
                add_beam(corners, whole);
            } else {
                trace_triangle({quad.triangle, 1, sides[0], event});
                trace_triangle({quad.triangle + 1, 1, sides[1], event});
            }
        }
    }

    void trace_piece(const MeshPiece& piece, const Origin& origin, int splits) {
        const auto between = [&](const MeshPoint& p, const MeshPoint& q, float t) {
            return bender_.between(p, q, t);
        };
        const CutPiece<MeshPoint> lit = cut_piece(
            piece, bisections,
            [&](const MeshPoint& p) { return sends_on(p, origin.facing, origin.event); }, between);
        std::array<const MeshPoint*, 4> all;
        for (std::size_t i = 0; i < lit.count; ++i) all[i] = &lit.corners[i];
        const Corners corners(all.data(), lit.count);
        if (splits > 0 && (part_widely(corners, origin.event, splits == most_splits) ||
                           deceives(piece, origin))) {
            for (const MeshPiece& part : quarters(piece, between))
                trace_piece(part, origin, splits - 1);
        } else if (!corners.empty()) {
            add_beam(corners, origin);
        }
    }

    // Whether corners that are all lit or all dark do not tell what the piece does: inside it, or
    // straight below the light, it is another thing.
    bool deceives(const MeshPiece& piece, const Origin& origin) const {
        const auto& [a, b, c] = piece;
        const auto sends = [&](const MeshPoint& p) {
            return sends_on(p, origin.facing, origin.event);
        };
        const auto middle = [&] { return sends(bender_.inside(piece, Vec3::Constant(1.0F / 3))); };
        const int lit = sends(a) + sends(b) + sends(c);
        const std::array<const MeshPoint*, 3> corners = {&a, &b, &c};
        if (lit > 0) return lit == 3 && weights_differ(corners, origin.event) && !middle();
        if (origin.event == refraction &&
            !std::holds_alternative<Dielectric>(surface_.bsdf().model))
            return false;
        return middle() || sends(bender_.nearest_to_light(piece)) ||
               sends(bender_.between(a, b, 0.5F)) || sends(bender_.between(b, c, 0.5F)) ||
               sends(bender_.between(c, a, 0.5F));
    }

    void add_beam(Corners corners, const Origin& origin) {
        BeamSet& set = traced_[origin.event].traced.set;
        Beam beam;
        std::array<Spectrum, 2> flux = {black(), black()};
        for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
            const std::array<const MeshPoint*, 3> piece = {corners[0], corners[1 + i],
                                                           corners[2 + i]};
            flux[i] = bender_.flux(piece, origin.event);
        }
        beam.flux = flux[0] + flux[1];
        if (!(beam.flux.mean() > 0)) return;
        beam.first_share = flux[0].mean() / beam.flux.mean();
        beam.triangle = origin.triangle;
        beam.is_cell = origin.triangle_count == 2;
        beam.inside = origin.facing.front == (origin.event == refraction);
        for (std::uint32_t i = 0; i < origin.triangle_count; ++i)
            beam.offset = std::max(beam.offset, surface_.offset(beam.triangle + i));
        beam.corners.fill(Beam::none);
        for (std::size_t i = 0; i < corners.size(); ++i)
            beam.corners[i] = ray_of(*corners[i], origin.event);
        set.beams.push_back(beam);
    }

    // Beams that meet in a vertex share its ray.
    std::uint32_t ray_of(const MeshPoint& point, Event event) {
        SetChunk& chunk = traced_[event];
        const bool shared = point.vertex != MeshPoint::no_vertex;
        if (shared) {
            const std::uint32_t found = chunk.rays.find(point.vertex);
            if (found != Beam::none) return found;
        }
        const auto ray = static_cast<std::uint32_t>(chunk.keys.size());
        chunk.traced.set.rays.push_back({point.position, point.bent.direction[event]});
        chunk.traced.origins.push_back(
            {point.position, point.normal, point.bent.weight[event], point.vertex});
        chunk.keys.push_back(point.vertex);
        if (shared) chunk.rays.add(point.vertex, ray);
        return ray;
    }

    const LitCaster& surface_;
    const LightBender& bender_;
    const CasterMesh& caster_;
    const TriangleMesh& mesh_;
    const NearLight& near_light_;
    const std::vector<MeshPoint>& vertices_;
    std::array<SetChunk, 2> traced_;
};

// A set without beams.
BeamSet set_of(const LitCaster& surface, Event event) {
    BeamSet set;
    set.light = surface.light();
    set.caster = surface.caster().shape;
    set.refracted = event == refraction;
    set.path = {{set.caster, set.refracted}};
    if (const auto* medium = std::get_if<Dielectric>(&surface.bsdf().model))
        set.absorption = {medium->ext_absorption, medium->absorption};
    else if (surface.light().medium != nullptr)
        set.absorption.fill(*surface.light().medium);
    return set;
}

// Of each place the most of the beams about it.
void set_offsets(TracedSet& traced) {
    for (const Beam& beam : traced.set.beams)
        for (const std::uint32_t corner : beam.corners)
            if (corner != Beam::none)
                traced.origins[corner].offset =
                    std::max(traced.origins[corner].offset, beam.offset);
}

// The first events of a caster's light, on all threads.
std::array<TracedSet, 2> first_sets(const LitCaster& surface, int threads,
                                    const ProgressPart& part) {
    const std::vector<MeshPoint> vertices = bent_vertices(surface, threads);
    const NearLight near_light(surface);
    const std::size_t triangles = surface.caster().mesh.triangles.size();
    std::vector<std::array<SetChunk, 2>> chunks(chunk_count(triangles, polygons_together));
    parallel_chunks(threads, triangles, polygons_together, [&](const Chunk& chunk) {
        chunks[chunk.index] =
            BeamTracer(surface, near_light, vertices).run(chunk.first, chunk.end, part);
    });
    std::array<TracedSet, 2> sets;
    for (const Event event : events) {
        sets[event].set = set_of(surface, event);
        std::vector<SetChunk*> of_event;
        for (auto& chunk : chunks) of_event.push_back(&chunk[event]);
        std::vector<Departure> no_departures;
        join(of_event, vertices.size(), threads, sets[event], no_departures);
        set_offsets(sets[event]);
    }
    return sets;
}

}  // namespace

std::array<BeamSet, 2> trace_beams(const Scene& scene, const CasterMesh& caster,
                                   const LightSample& light) {
    const RunOptions options;
    TraceProgress progress(options);
    std::array<TracedSet, 2> traced = first_sets(LitCaster(scene, caster, light), 1, {progress, 1});
    return {std::move(traced[0].set), std::move(traced[1].set)};
}

double first_flux(const Scene& scene, const CasterMesh& caster, const LightSample& light,
                  int threads) {
    const RunOptions options;
    TraceProgress progress(options);
    double sum = 0;
    for (const TracedSet& one : first_sets(LitCaster(scene, caster, light), threads, {progress, 0}))
        sum += flux_of(one.set);
    return sum;
}

TracedBeams trace_beams(const Scene& scene, const SceneBoxes& boxes, const CasterMesh& caster,
                        const MeshNeighbours* neighbours, const LightSample& light,
                        const TraceSettings& settings, BeamBudget& budget,
                        const ProgressPart& part) {
    const LitCaster surface(scene, caster, light);
    refuse_light_behind_polygons(scene, surface);
    std::optional<BeamDrift> drift;
    if (light.drifts) drift.emplace(scene, caster, light);
    const bool follows = settings.max_bounces > 1 || drift;
    std::array<TracedSet, 2> first =
        first_sets(surface, settings.threads, part.of(follows ? 0.1 : 0.9));
    TracedBeams traced;
    if (follows) {
        BeamBounces follower(scene, boxes, surface, {neighbours, drift ? &*drift : nullptr},
                             settings, budget);
        follower.follow(std::move(first), part.of(0.9));
        traced = follower.take();
    } else {
        for (auto& [set, origins] : first) {
            std::vector<bool> kept(set.beams.size(), true);
            traced.unreceived += leave_out_unreceived(kept, set, boxes, settings);
            if (neighbours != nullptr)
                refine(set, origins, *neighbours, kept, settings.threads, part.of(0.05));
            keep_only(set, kept);
            if (settings.intensity == Intensity::refined)
                prepare_roots(scene, caster.mesh, origins, settings.threads, set);
            traced.sets.push_back(std::move(set));
        }
    }
    return traced;
}

}  // namespace caustics::beamtree
