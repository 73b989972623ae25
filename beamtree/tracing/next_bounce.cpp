#include "beamtree/tracing/next_bounce.h"

#include <algorithm>
#include <atomic>

#include "beamtree/tracing/cut_edge.h"
#include "beamtree/tracing/cut_piece.h"
#include "beamtree/tracing/next_beams.h"
#include "beamtree/tracing/piece_detail.h"
#include "core/base/interrupt.h"
#include "core/base/parallel.h"

namespace caustics::beamtree {
namespace {

// How often a polygon is quartered.
constexpr int most_quarterings = 3;
// What is left of a polygon that is quartered because it is too large for what it meets: ten times.
constexpr float least_share = 1.0F / (1 << 20);
constexpr float widest_cosine_on = 0.5F;

// What threads take at a time.
constexpr std::size_t rays_together = 256;
constexpr std::size_t beams_together = 32;

/// What some beams of a set do next.
struct Followed {
    std::vector<NextChunk> chunks;
    std::vector<bool> stays;
    std::vector<RestPhoton> rest;
    FluxBalance balance;
    BeamBudget budget;
};

/// Sends rays on to the next surfaces.
void land_all(const Scene& scene, const LitCaster& surface, Level& level, int threads,
              const ProgressPart& part) {
    const bool is_first = level.parent == nullptr;
    const BeamSet& set = level.traced.set;
    level.arrivals.resize(set.rays.size());
    parallel_chunks(threads, set.rays.size(), rays_together, [&](const Chunk& chunk) {
        for (std::size_t i = chunk.first; i < chunk.end; ++i) {
            const VertexRay& ray = set.rays[i];
            const Departure& from = level.departures[i];
            const bool blocked =
                is_first && !sees(scene, {ray.position, from.normal, from.offset}, surface.light());
            if (!blocked) level.arrivals[i] = land(scene, ray, from, set.light.bin.nm);
        }
        part.progress.add(part.share * static_cast<double>(chunk.end - chunk.first) /
                          static_cast<double>(set.rays.size()));
    });
}

/// What the light of some beams of a set, whose rays have arrived, does next: beams of all casters it meets, after each event.
class NextBounce {
public:
    NextBounce(const Scene& scene, const SceneBoxes& boxes, const LitCaster& surface,
               const Level& level, const LeastLight& least, const RestPhotons& rest,
               BeamBudget budget)
        : scene_(scene),
          boxes_(boxes),
          surface_(surface),
          level_(level),
          set_(level.traced.set),
          budget_(std::move(budget)),
          next_(scene, surface, level, {least.mean, least.of_polygon, least.to_divide, budget_},
                rest, balance_) {}

    // `goes_on` is asked after each beam.
    template <typename GoesOn>
    Followed run(const Chunk& beams, const ProgressPart& part, const GoesOn& more) {
        first_ = beams.first;
        stays_.resize(beams.end - beams.first);
        const ProgressPart one = part.of(1 / static_cast<double>(set_.beams.size()));
        ProgressSteps steps(one.of(static_cast<double>(stays_.size())), stays_.size(), 8);
        for (auto beam = static_cast<std::uint32_t>(beams.first); beam < beams.end; ++beam) {
            for (std::size_t i = 0; i < set_.beams[beam].triangle_count(); ++i)
                follow_triangle(beam, i);
            steps.step();
            if (!more(budget_)) break;
        }
        return {next_.take(), std::move(stays_), next_.take_rest(), balance_, std::move(budget_)};
    }

private:
    void follow_triangle(std::uint32_t beam, std::size_t which) {
        const Beam& parent = set_.beams[beam];
        const std::array<std::uint32_t, 3> rays = parent.triangle_corners(which);
        const RayArrival& a = level_.arrivals[rays[0]];
        const RayArrival& b = level_.arrivals[rays[1]];
        const RayArrival& c = level_.arrivals[rays[2]];
        const bool alike = same_piece(a, b) && same_piece(b, c) && same_piece(c, a);
        if (alike && !a.goes_on()) {
            end(beam, rays);
            return;
        }
        count_lit(parent);
        if (a.goes_on() && is_receiver(scene_.shapes()[a.shape].bsdf)) stay(beam);
        const bool wide = is_wide(rays);
        if (alike && goes_plainly(a, b, c) && !is_coarse(rays) && !wide) {
            for (const Event event : events)
                if (!is_black(a.weight[event])) {
                    BeamCorners corners;
                    for (std::size_t i = 0; i < 3; ++i)
                        corners[i] = {&level_.traced.origins[rays[i]], &level_.arrivals[rays[i]],
                                      rays[i]};
                    next_.add(beam, corners, event, share_of(beam));
                }
            return;
        }
        if (!alike || wide) stay(beam);
        cut_triangle(beam, rays);
    }

    void stay(std::uint32_t beam) { stays_[beam - first_] = true; }

    bool is_coarse(const std::array<std::uint32_t, 3>& rays) const {
        const auto coarse = [this](std::uint32_t i, std::uint32_t j) {
            return beamtree::is_coarse(level_.traced.origins[i], level_.arrivals[i],
                                       level_.traced.origins[j], level_.arrivals[j]);
        };
        return coarse(rays[0], rays[1]) || coarse(rays[1], rays[2]) || coarse(rays[2], rays[0]);
    }
    static bool is_coarse(const PathPoint& a, const PathPoint& b) {
        return goes_on(a) && goes_on(b) && beamtree::is_coarse(a.origin, a.next, b.origin, b.next);
    }

    // True where the rays of an exact surface part so widely after their last event that the corners' tell little of
    // those between.
    bool is_wide(const Piece& piece) const {
        constexpr float most_apart = 0.3F;  // between unit directions
        const auto part = [](const PathPoint& p, const PathPoint& q) {
            return p.alive && q.alive && (p.ray.direction - q.ray.direction).norm() > most_apart;
        };
        const auto& [a, b, c] = piece;
        return level_.exact != nullptr && (part(a, b) || part(b, c) || part(c, a));
    }
    bool is_wide(const std::array<std::uint32_t, 3>& rays) const {
        return level_.exact != nullptr && is_wide(piece_of(rays));
    }

    // Where no corner goes on.
    bool hides_a_caster(const Piece& piece) const {
        const auto& [a, b, c] = piece;
        return a.alive && b.alive && c.alive && may_pass_round_caster(boxes_, piece);
    }

    float share_of(std::uint32_t beam) const {
        return level_.shares.empty() ? 1 : level_.shares[beam];
    }

    // Whether the rays after an event part too far for one beam.
    static bool part_widely(const RayArrival& a, const RayArrival& b, const RayArrival& c,
                            Event event) {
        const auto far = [event](const RayArrival& p, const RayArrival& q) {
            return p.direction[event].dot(q.direction[event]) < widest_cosine_on;
        };
        return !is_black(a.weight[event]) && !is_black(b.weight[event]) &&
               !is_black(c.weight[event]) && (far(a, b) || far(b, c) || far(c, a));
    }
    static bool part_widely(const RayArrival& a, const RayArrival& b, const RayArrival& c) {
        return part_widely(a, b, c, reflection) || part_widely(a, b, c, refraction);
    }
    // Whether all corners do the same at the piece they meet, and go on side by side.
    static bool goes_plainly(const RayArrival& a, const RayArrival& b, const RayArrival& c) {
        for (const Event event : events) {
            const bool black = is_black(a.weight[event]);
            if (is_black(b.weight[event]) != black || is_black(c.weight[event]) != black)
                return false;
        }
        return !part_widely(a, b, c);
    }

    // Light that goes no further; unless the ray in the middle says another thing than the corners.
    void end(std::uint32_t beam, const std::array<std::uint32_t, 3>& rays) {
        stay(beam);
        const Beam& parent = set_.beams[beam];
        Departure from = level_.departures[rays[0]];
        from.offset = parent.offset;
        VertexRay ray{Vec3::Zero(), Vec3::Zero()};
        for (const std::uint32_t i : rays) {
            ray.position += set_.rays[i].position / 3;
            ray.direction += set_.rays[i].direction;
        }
        ray.direction.normalize();
        const SegmentEnd middle{ray.position, from.normal, parent.offset};
        if (level_.parent == nullptr) {
            if (!sees(scene_, middle, surface_.light())) return;
            count_lit(parent);
        }
        if (land(scene_, ray, from, set_.light.bin.nm).goes_on() ||
            hides_a_caster(piece_of(rays)) || is_wide(rays))
            cut_triangle(beam, rays);
    }

    void count_lit(const Beam& beam) {
        if (level_.parent == nullptr)
            balance_.lit +=
                static_cast<double>(beam.flux.mean()) / static_cast<double>(beam.triangle_count());
    }

    PathPoint corner(std::uint32_t ray) const {
        PathPoint point;
        point.origin = level_.traced.origins[ray];
        point.from = level_.departures[ray];
        point.ray = set_.rays[ray];
        point.alive = true;
        point.next = level_.arrivals[ray];
        return point;
    }

    Piece piece_of(const std::array<std::uint32_t, 3>& rays) const {
        return {corner(rays[0]), corner(rays[1]), corner(rays[2])};
    }

    void quarter(std::uint32_t beam, const Path& path, const Piece& piece, float share,
                 int splits) {
        const auto between = [&path](const PathPoint& p, const PathPoint& q, float t) {
            return path.between(p, q, t);
        };
        for (const Piece& part : quarters(piece, between)) cut(beam, path, part, share, splits);
    }

    bool may_search(const Piece& piece, float share) const {
        return share > least_share && next_.may_divide(piece);
    }
    // Quarters a piece that is too large for what it meets.
    void search(std::uint32_t beam, const Path& path, const Piece& piece, float share, int splits) {
        next_.count_search(piece);
        quarter(beam, path, piece, share / 4, splits);
    }

    void cut_triangle(std::uint32_t beam, const std::array<std::uint32_t, 3>& rays) {
        cut(beam, Path(scene_, surface_, level_, beam), piece_of(rays), share_of(beam),
            most_quarterings);
    }
    // With `up_to_third` none after one that hides a third thing is cut.
    std::array<CutEdge, 3> cut_edges(const Path& path, const Piece& piece, bool up_to_third) const {
        const int halvings = next_.halvings(piece);
        std::array<CutEdge, 3> edges;
        for (std::size_t i = 0; i < 3; ++i) {
            edges[i] = cut_edge(path, piece[i], piece[(i + 1) % 3], halvings, up_to_third);
            if (up_to_third && edges[i].hides_another) break;
        }
        return edges;
    }
    // Whether an edge is too long for what it meets up to where it is cut.
    static bool cuts_coarsely(const Piece& piece, const std::array<CutEdge, 3>& edges) {
        for (std::size_t i = 0; i < 3; ++i)
            if (edges[i].is_cut && (is_coarse(piece[i], edges[i].last) ||
                                    is_coarse(edges[i].first, piece[(i + 1) % 3])))
                return true;
        return false;
    }
    // What becomes of a piece whose corners do different things. It has `share` of its polygon.
    void cut(std::uint32_t beam, const Path& path, const Piece& piece, float share, int splits) {
        throw_if_interrupted();
        const auto& [a, b, c] = piece;
        if (next_.is_too_weak(piece)) {
            leave_out(beam, piece);
            return;
        }
        if (is_wide(piece) && may_search(piece, share)) {
            search(beam, path, piece, share, splits);
            return;
        }
        if (!goes_on(a) && !goes_on(b) && !goes_on(c)) {
            cut_dark(beam, path, piece, share, splits);
            return;
        }
        const bool one = alike(a, b) && alike(b, c) && alike(c, a);
        bool more = !alike(a, b) && !alike(b, c) && !alike(c, a);
        if (!next_.may_divide(piece)) splits = 0;
        if (splits > 0 && (more || (one && part_widely(a.next, b.next, c.next)))) {
            quarter(beam, path, piece, share, splits - 1);
            return;
        }
        bool coarse = one && (is_coarse(a, b) || is_coarse(b, c) || is_coarse(c, a));
        if (coarse && may_search(piece, share)) {
            search(beam, path, piece, share, splits);
            return;
        }
        const std::array<CutEdge, 3> edges = cut_edges(path, piece, splits > 0);
        more = more || std::ranges::any_of(edges, &CutEdge::hides_another);
        if (splits > 0 && more) {
            quarter(beam, path, piece, share, splits - 1);
            return;
        }
        coarse = coarse || cuts_coarsely(piece, edges);
        if (coarse && may_search(piece, share)) {
            search(beam, path, piece, share, splits);
            return;
        }
        if (more && next_.is_completed()) {
            complete(beam, piece, path.middle(piece));
            return;
        }
        const double carried = add_parts(beam, piece, edges, share);
        if (more) balance_.lost += std::max(0.0, next_.flux(piece) - carried);
    }

    // By photons, a piece that is too coarse for what it meets. Its corners may be all but dark, where total
    // reflection begins: the light of the middle counts as well, or photons would be few and bright.
    void complete(std::uint32_t beam, const Piece& piece, const PathPoint& middle) {
        next_.complete(left_out(beam, piece, next_.most_light(piece, &middle)));
    }
    static LeftOut left_out(std::uint32_t beam, const Piece& piece, double flux) {
        return {beam, {&piece[0].origin, &piece[1].origin, &piece[2].origin}, {}, flux};
    }

    // Light of a piece that goes on is not followed. Its corners tell about how much that is, but photons
    // are drawn from all of the piece, whatever its corners do.
    void leave_out(std::uint32_t beam, const Piece& piece) {
        const auto on = std::ranges::count_if(piece, goes_on);
        LeftOut part = left_out(beam, piece, next_.flux(piece));
        part.over_budget = true;
        next_.leave_out(part, part.flux * static_cast<double>(on) / 3);
    }

    // A piece none of whose corners goes on.
    void cut_dark(std::uint32_t beam, const Path& path, const Piece& piece, float share,
                  int splits) {
        if (may_search(piece, share) && hides_a_caster(piece)) {
            search(beam, path, piece, share, splits);
            return;
        }
        const PathPoint middle = path.middle(piece);
        if (!goes_on(middle)) return;
        if (splits > 0 && next_.may_divide(piece))
            quarter(beam, path, piece, share, splits - 1);
        else if (next_.is_completed())
            complete(beam, piece, middle);
        else
            balance_.lost += next_.flux(piece);
    }

    // Returns the flux of the parent's that goes on. A corner may do as both others that do different things: where
    // facets turn by little each.
    double add_parts(std::uint32_t beam, const Piece& piece, const std::array<CutEdge, 3>& edges,
                     float share) {
        double carried = 0;
        std::array<bool, 3> takes_part = {};
        for (std::size_t i = 0; i < 3; ++i) {
            takes_part[i] = goes_on(piece[i]);
            for (std::size_t k = 0; k < i; ++k)
                if (takes_part[k] && alike(piece[i], piece[k])) takes_part[i] = false;
            if (takes_part[i]) carried += add_part(beam, piece, edges, piece[i], share);
        }
        return carried;
    }

    // The part of a piece that does as one of its corners. Returns the flux of the parent's that it takes.
    double add_part(std::uint32_t beam, const Piece& piece, const std::array<CutEdge, 3>& edges,
                    const PathPoint& like, float share) {
        std::array<const PathPoint*, 6> part;
        std::size_t count = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const bool here = alike(piece[i], like);
            if (here) part[count++] = &piece[i];
            if (!edges[i].is_cut) continue;
            if (here) part[count++] = &edges[i].last;
            if (alike(piece[(i + 1) % 3], like)) part[count++] = &edges[i].first;
        }
        const double whole = next_.size(piece);
        double taken = 0;
        for (std::size_t i = 1; i + 1 < count; ++i) {
            const std::array<const PathPoint*, 3> points = {part[0], part[i], part[i + 1]};
            const Piece triangle = {*points[0], *points[1], *points[2]};
            const double size = next_.size(triangle);
            if (!(size > 0)) continue;
            BeamCorners corners;
            for (std::size_t k = 0; k < 3; ++k)
                corners[k] = {&points[k]->origin, &points[k]->next, Beam::none};
            const auto of_piece = static_cast<float>(std::min(1.0, size / whole));
            for (const Event event : events)
                if (!is_black(like.next.weight[event]))
                    next_.add(beam, corners, event, share, of_piece);
            taken += next_.flux(triangle);
        }
        return taken;
    }

    const Scene& scene_;
    const SceneBoxes& boxes_;
    const LitCaster& surface_;
    const Level& level_;
    const BeamSet& set_;
    FluxBalance balance_;
    BeamBudget budget_;
    NextBeams next_;
    std::size_t first_ = 0;    ///< of the beams that are followed
    std::vector<bool> stays_;  ///< of these
};

/// Follows all beams of a level.
class Following {
public:
    Following(const Scene& scene, const SceneBoxes& boxes, const LitCaster& surface,
              const Level& level, const LeastLight& least, const RestPhotons& rest, int threads,
              const ProgressPart& part)
        : scene_(scene),
          boxes_(boxes),
          surface_(surface),
          level_(level),
          least_(least),
          rest_(rest),
          threads_(threads),
          part_(part) {}

    // The budget counts in the order of the beams, and what it has no room for ends the cutting of polygons. So beams are
    // followed side by side where it has room for all that come of them, and else one after the other.
    std::vector<Followed> run() {
        if (!least_.budget.is_over()) {
            auto followed = side_by_side();
            if (!followed.empty()) return followed;
        }
        std::vector<Followed> one;
        one.push_back(bounce(least_.budget).run({0, 0, beams()}, part_, [](const BeamBudget&) {
            return true;
        }));
        least_.budget = std::move(one.front().budget);
        return one;
    }

private:
    std::size_t beams() const { return level_.traced.set.beams.size(); }

    NextBounce bounce(BeamBudget budget) const {
        return {scene_, boxes_, surface_, level_, least_, rest_, std::move(budget)};
    }

    // Nothing where the budget has no room.
    std::vector<Followed> side_by_side() const {
        std::vector<Followed> followed(chunk_count(beams(), beams_together));
        std::atomic<std::uint64_t> made{0};
        parallel_chunks(threads_, beams(), beams_together, [&](const Chunk& chunk) {
            std::uint64_t counted = 0;
            const auto more = [&](const BeamBudget& budget) {
                made += budget.count() - counted;
                counted = budget.count();
                return least_.budget.has_room_for(made);
            };
            if (!least_.budget.has_room_for(made)) return;
            const BeamBudget own(BeamBudget::no_limit, least_.budget.least());
            followed[chunk.index] = bounce(own).run(chunk, part_, more);
        });
        if (!least_.budget.has_room_for(made)) return {};
        for (const Followed& one : followed) least_.budget.add(one.budget);
        return followed;
    }

    const Scene& scene_;
    const SceneBoxes& boxes_;
    const LitCaster& surface_;
    const Level& level_;
    const LeastLight& least_;
    const RestPhotons& rest_;
    int threads_;
    ProgressPart part_;
};

}  // namespace

NextSets next_sets(const Scene& scene, const SceneBoxes& boxes, const LitCaster& surface,
                   Level& level, const LeastLight& least, const RestPhotons& rest,
                   FluxBalance& balance, int threads, const ProgressPart& part) {
    land_all(scene, surface, level, threads, part.of(0.2));
    std::vector<Followed> followed =
        Following(scene, boxes, surface, level, least, rest, threads, part.of(0.8)).run();
    NextSets next;
    std::vector<std::vector<NextChunk>> chunks;
    for (Followed& one : followed) {
        balance.add(one.balance);
        next.rest.insert(next.rest.end(), one.rest.begin(), one.rest.end());
        next.stays.insert(next.stays.end(), one.stays.begin(), one.stays.end());
        chunks.push_back(std::move(one.chunks));
    }
    next.sets = join_levels(scene, level, std::move(chunks), threads);
    return next;
}

}  // namespace caustics::beamtree
