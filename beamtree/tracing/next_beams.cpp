#include "beamtree/tracing/next_beams.h"

#include <algorithm>
#include <cmath>

#include "beamtree/tracing/cut_edge.h"

namespace caustics::beamtree {
namespace {

// Corners' light is a bound to a few times: between them a surface may reflect less.
constexpr double corners_slack = 4;
// Where corners' weights do not give the mean, so many parts of a side do: the most for a beam with the light of
// the first events' mean.
constexpr int fewest_parts = 2;
constexpr int most_parts = 5;

// What media have left of a beam's light. Where they absorb much, all light that passes is weak.
double left_of(const BeamCorners& corners) {
    double left = 0;
    for (const BeamCorner& corner : corners)
        left = std::max(left, static_cast<double>(corner.origin->left) *
                                  static_cast<double>(corner.arrival->left));
    return left;
}

// How far the surface may lie off the triangle of the corners, as LitCaster::offset. Facets of a
// mesh turn by steps.
float bulge(const BeamCorners& corners) {
    float largest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const RayArrival& a = *corners[i].arrival;
        const RayArrival& b = *corners[(i + 1) % 3].arrival;
        const float turn = std::max((a.shading_normal - b.shading_normal).norm(),
                                    (a.geometric_normal - b.geometric_normal).norm());
        largest = std::max(largest, (a.position - b.position).norm() * turn);
    }
    return largest / 4;
}

// Beams that meet in a ray of the parent's share the one it goes on as.
std::uint32_t ray_of(SetChunk& chunk, const BeamCorner& corner, Event event) {
    const bool shared = corner.parent_ray != Beam::none;
    if (shared) {
        const std::uint32_t found = chunk.rays.find(corner.parent_ray);
        if (found != Beam::none) return found;
    }
    const RayArrival& arrival = *corner.arrival;
    const auto ray = static_cast<std::uint32_t>(chunk.keys.size());
    chunk.traced.set.rays.push_back({arrival.position, arrival.direction[event]});
    RayOrigin origin = *corner.origin;
    origin.weight *= arrival.weight[event];
    origin.left *= arrival.left;
    if (!shared) origin.vertex = RayOrigin::no_vertex;
    chunk.traced.origins.push_back(origin);
    chunk.departures.push_back(arrival.after(event));
    chunk.keys.push_back(corner.parent_ray);
    if (shared) chunk.rays.add(corner.parent_ray, ray);
    return ray;
}

// Without beams.
Level level_after(const Scene& scene, const Level& parent, std::uint32_t shape, Event event) {
    Level level;
    level.parent = &parent;
    level.exact = parent.exact;
    level.event = event;
    const BeamSet& before = parent.traced.set;
    BeamSet& set = level.traced.set;
    set.light = before.light;
    set.caster = before.caster;
    set.refracted = event == refraction;
    set.path = before.path;
    set.path.push_back({shape, event == refraction});
    // A mirror leaves light where it was.
    const auto* const medium = std::get_if<Dielectric>(&scene.shapes()[shape].bsdf.model);
    set.absorption = medium != nullptr ? std::array{medium->ext_absorption, medium->absorption}
                                       : before.absorption;
    return level;
}

void fill(Level& level, std::span<NextChunk* const> chunks, std::size_t parent_rays, int threads) {
    std::vector<SetChunk*> beams;
    for (NextChunk* chunk : chunks) {
        beams.push_back(&chunk->beams);
        level.parents.insert(level.parents.end(), chunk->parents.begin(), chunk->parents.end());
        level.places.insert(level.places.end(), chunk->places.begin(), chunk->places.end());
        level.shares.insert(level.shares.end(), chunk->shares.begin(), chunk->shares.end());
        level.worth += chunk->worth;
    }
    join(beams, parent_rays, threads, level.traced, level.departures);
}

}  // namespace

std::vector<Level> join_levels(const Scene& scene, const Level& parent,
                               std::vector<std::vector<NextChunk>> parts, int threads) {
    std::vector<std::vector<NextChunk*>> kinds;
    for (std::vector<NextChunk>& part : parts)
        for (NextChunk& chunk : part) {
            const auto same = [&](const std::vector<NextChunk*>& kind) {
                return kind.front()->shape == chunk.shape && kind.front()->event == chunk.event;
            };
            const auto kind = std::ranges::find_if(kinds, same);
            (kind == kinds.end() ? kinds.emplace_back() : *kind).push_back(&chunk);
        }
    std::vector<Level> levels;
    for (const std::vector<NextChunk*>& kind : kinds) {
        const NextChunk& first = *kind.front();
        levels.push_back(level_after(scene, parent, first.shape, first.event));
        fill(levels.back(), kind, parent.traced.set.rays.size(), threads);
    }
    return levels;
}

NextBeams::NextBeams(const Scene& scene, const LitCaster& surface, const Level& level,
                     const LeastLight& least, const RestPhotons& rest, FluxBalance& balance)
    : scene_(scene),
      surface_(surface),
      level_(level),
      set_(level.traced.set),
      least_(least),
      rest_(rest),
      balance_(balance) {}

double NextBeams::size(const Piece& piece) const {
    const auto& [a, b, c] = piece;
    return measure(set_.light, a.origin.position, b.origin.position, c.origin.position);
}

double NextBeams::flux(const Piece& piece) const {
    const auto& [a, b, c] = piece;
    const Spectrum weight = (a.origin.weight + b.origin.weight + c.origin.weight) / 3;
    return static_cast<double>(weight.mean()) * size(piece);
}

double NextBeams::most_light(const Piece& piece, const PathPoint* inside) const {
    const auto strength = [](const PathPoint& point) {
        return static_cast<double>(point.origin.weight.mean()) /
               static_cast<double>(point.origin.left);
    };
    double most = inside != nullptr ? strength(*inside) : 0;
    for (const PathPoint& corner : piece) most = std::max(most, strength(corner));
    return corners_slack * most * size(piece);
}

bool NextBeams::is_too_weak(const Piece& piece) const {
    return least_.budget.least() > 0 && most_light(piece) < least_.budget.least();
}

int NextBeams::halvings(const Piece& piece) const {
    constexpr int fewest = 4;
    if (least_.to_divide == 0) return most_halvings;
    const double times = most_light(piece) / least_.to_divide;
    if (!(times > 0.25)) return fewest;
    return std::min(6 + static_cast<int>(std::log2(std::min(times, 1e9))), most_halvings);
}

void NextBeams::count_search(const Piece& piece) { least_.budget.count(most_light(piece)); }

// Each place stands for as much light, whatever the beam has.
int NextBeams::parts_of_side(double light) const {
    const double wanted = most_parts * std::sqrt(light / least_.mean);
    return static_cast<int>(std::ceil(
        std::clamp(wanted, static_cast<double>(fewest_parts), static_cast<double>(most_parts))));
}

// As LightBender::flux: by the corners' weights where they are alike, or where the beam is too dim whatever is between.
Spectrum NextBeams::flux(std::uint32_t parent, const BeamCorners& corners, Event event,
                         double dim) const {
    std::array<Spectrum, 3> weights;
    for (std::size_t i = 0; i < 3; ++i)
        weights[i] = corners[i].origin->weight * corners[i].arrival->weight[event];
    const double whole = measure(set_.light, corners[0].origin->position,
                                 corners[1].origin->position, corners[2].origin->position);
    const Spectrum sum = weights[0] + weights[1] + weights[2];
    const Spectrum by_corners = sum * (static_cast<float>(whole) / 3);
    const auto mean = static_cast<double>(by_corners.mean());
    if (!weights_differ({weights[0].mean(), weights[1].mean(), weights[2].mean()}) ||
        corners_slack * mean < dim)
        return by_corners;
    return weight_inside(parent, corners, event, parts_of_side(mean)) * static_cast<float>(whole);
}

// Near total reflection the way is gone from places inside as well.
Spectrum NextBeams::weight_inside(std::uint32_t parent, const BeamCorners& corners, Event event,
                                  int parts) const {
    const std::array<const RayOrigin*, 3> at = {corners[0].origin, corners[1].origin,
                                                corners[2].origin};
    const Path path(scene_, surface_, level_, parent);
    Spectrum sum = black();
    const auto add = [&](int i, int j, float to_middle) {
        const auto n = static_cast<float>(parts);
        const float u = (static_cast<float>(i) + to_middle) / n;
        const float v = (static_cast<float>(j) + to_middle) / n;
        const PathPoint point = path.inside(at, {1 - u - v, u, v});
        if (goes_on(point) && same_piece(point.next, *corners[0].arrival))
            sum += point.origin.weight * point.next.weight[event];
    };
    for (int i = 0; i < parts; ++i)
        for (int j = 0; i + j < parts; ++j) {
            add(i, j, 1.0F / 3);
            if (i + j + 2 <= parts) add(i, j, 2.0F / 3);
        }
    return sum / static_cast<float>(parts * parts);
}

void NextBeams::add(std::uint32_t parent, const BeamCorners& corners, Event event, float share,
                    float part) {
    const RayArrival& first = *corners[0].arrival;
    const double left = left_of(corners);
    const float own_share = share * part;
    Beam beam;
    beam.flux = flux(
        parent, corners, event,
        left * std::max(least_.of_polygon * static_cast<double>(own_share), least_.budget.least()));
    const auto mean = static_cast<double>(beam.flux.mean());
    if (!(mean > 0)) return;
    const double clear = mean / left;
    const double worth = clear / static_cast<double>(own_share);
    if (worth < least_.of_polygon || clear < least_.budget.least()) {
        leave_out({parent,
                   {corners[0].origin, corners[1].origin, corners[2].origin},
                   event,
                   mean,
                   worth >= least_.of_polygon},
                  mean);
        return;
    }
    least_.budget.count(clear);
    NextChunk& chunk = chunk_of(first.shape, event);
    beam.triangle = set_.beams[parent].triangle;
    const bool is_interface =
        std::holds_alternative<Dielectric>(scene_.shapes()[first.shape].bsdf.model);
    beam.inside = is_interface ? first.front == (event == refraction) : set_.beams[parent].inside;
    for (const BeamCorner& corner : corners)
        beam.offset = std::max(beam.offset, 2 * corner.arrival->offset);
    beam.offset += bulge(corners);
    beam.corners.fill(Beam::none);
    for (std::size_t i = 0; i < 3; ++i) beam.corners[i] = ray_of(chunk.beams, corners[i], event);
    chunk.beams.traced.set.beams.push_back(beam);
    chunk.worth += clear / static_cast<double>(share);
    chunk.shares.push_back(own_share);
    chunk.parents.push_back(parent);
    chunk.places.push_back(first);
}

void NextBeams::leave_out(const LeftOut& part, double flux) {
    balance_.lost += flux;
    (part.over_budget ? balance_.over_budget : balance_.pruned) += flux;
    complete(part);
}

void NextBeams::complete(const LeftOut& part) {
    // Where the budget is over all is traced again.
    if (!least_.budget.is_over()) rest_.trace(level_, part, photons_);
}

NextChunk& NextBeams::chunk_of(std::uint32_t shape, Event event) {
    for (NextChunk& chunk : chunks_)
        if (chunk.shape == shape && chunk.event == event) return chunk;
    return chunks_.emplace_back(NextChunk{shape, event, {}, {}, {}, {}});
}

}  // namespace caustics::beamtree
