#include "beamtree/light/root_beams.h"

#include "beamtree/light/cut_triangles.h"
#include "beamtree/light/first_polygon.h"
#include "beamtree/light/projected.h"
#include "core/base/parallel.h"

namespace caustics::beamtree {
namespace {

constexpr int most_root_quarters = 3;
constexpr int most_cut_quarters = 1;
// By how much an image may be off its quadratic where light has gone as far as the scene is wide, over the polygon's
// size on the first surface: less does no harm. Directions may be off by this share of how far they part, whatever the
// scene: a wave of two radians a polygon has 0.03, and half the polygon a quarter of that.
constexpr double most_off_image = 0.1;
constexpr double most_off_directions = 0.02;
constexpr int most_lit_halvings = 12;
constexpr std::size_t root_beams_together = 256;  // that threads take at a time

// Corners of a triangle, in its own coordinates.
const std::array<Vec2d, 3> unit_corners = {Vec2d(0, 0), Vec2d(1, 0), Vec2d(0, 1)};

/// A place of a triangle, with its ray.
struct RootNode {
    Vec2d at;
    Vec3 origin;  ///< in the polygon's plane
    VertexRay ray;
    bool is_lit = true;                 ///< light of it goes the set's way
    Vec3d facets = Vec3d::Zero();       ///< that it meets (ChainRay::facets)
    std::uint32_t number = Beam::none;  ///< of the ray, where it is a corner
};

/// A beam, or a part of one, with its edges' middles.
struct RootBeam {
    Beam beam;
    std::uint32_t from = 0;  ///< the beam of the set that it is, or is part of
    bool is_part = false;
    std::array<EdgeMiddles, 2> middles = {no_middles(), no_middles()};

    /// Rays without a direction, of a triangle that a beam does not have.
    static EdgeMiddles no_middles() {
        const VertexRay none{Vec3::Zero(), Vec3::Zero()};
        return {none, none, none};
    }
};

/// The prepared beams of a part of a set. Rays of new corners are numbered from the set's last ray on.
struct RootBeams {
    std::vector<RootBeam> beams;
    std::vector<VertexRay> rays;
    std::vector<Vec3> origins;
};

/// Divides one triangle of a beam.
class Divider {
public:
    /// New rays are numbered from `first_number` on. What is lit of a triangle has a smooth border unless its light
    /// `meets_mesh` after the first surface.
    Divider(const LightChain& chain, const FirstPolygon& polygon, double reach, bool meets_mesh,
            std::uint32_t first_number, RootBeams& out)
        : chain_(chain),
          polygon_(polygon),
          reach_(reach),
          meets_mesh_(meets_mesh),
          first_number_(first_number),
          out_(out) {}

    /// A triangle with a dark part, and a place whose light goes the set's way.
    void add_cut(const RootBeam& beam, const std::array<Vec3, 3>& origins, const Vec2d& lit) {
        std::array<RootNode, 3> corners;
        for (std::size_t i = 0; i < 3; ++i) {
            corners[i] = node(unit_corners[i]);
            corners[i].origin = origins[i];
        }
        if (meets_mesh_)
            add_dark(corners, beam, lit);
        else
            divide_cut(corners, beam, lit, most_cut_quarters);
    }

    void divide(const std::array<RootNode, 3>& corners, const RootBeam& beam, int quarters) {
        const std::array<RootNode, 3> middles = {between(corners[0], corners[1]),
                                                 between(corners[1], corners[2]),
                                                 between(corners[2], corners[0])};
        // The image of several facets is in pieces, of which each has roots of its own: polygons serve there.
        if (meet_facets(middles)) {
            out_.beams.push_back(beam);
            for (std::size_t i = 0; i < 3; ++i)
                out_.beams.back().beam.corners[i] = corners[i].number;
            return;
        }
        const std::array<RootNode, 3> quarter_nodes = {quarter(corners[0], corners[1]),
                                                       quarter(corners[1], corners[2]),
                                                       quarter(corners[2], corners[0])};
        if (!are_lit(middles) || !are_lit(quarter_nodes)) {
            if (!meets_mesh_ &&
                divide_cut({node(corners[0].at), node(corners[1].at), node(corners[2].at)}, beam,
                           {}, std::min(quarters, most_cut_quarters)))
                return;
            add(corners, middles, beam);
            out_.beams.back().beam.has_dark_part = true;
            return;
        }
        if (quarters == 0 || !is_rough(corners, middles, quarter_nodes)) {
            add(corners, middles, beam);
            return;
        }
        std::array<RootNode, 3> m = middles;
        for (RootNode& node : m) number(node);
        const std::array<std::array<RootNode, 3>, 4> parts = quartered(corners, m);
        std::array<double, 4> area;
        double sum = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            area[i] = light_area(parts[i]);
            sum += area[i];
        }
        for (std::size_t i = 0; i < 4; ++i) {
            RootBeam part = beam;
            part.is_part = true;
            part.beam.flux *= sum > 0 ? static_cast<float>(area[i] / sum) : 0.25F;
            divide(parts[i], part, quarters - 1);
        }
    }

private:
    static std::array<std::array<RootNode, 3>, 4> quartered(const std::array<RootNode, 3>& corners,
                                                            const std::array<RootNode, 3>& m) {
        const auto& [a, b, c] = corners;
        return {{{a, m[0], m[2]}, {m[0], b, m[1]}, {m[2], m[1], c}, {m[0], m[1], m[2]}}};
    }
    // The parts that have light share the beam's flux; false if there are none. `lit`: see add_cut.
    bool divide_cut(const std::array<RootNode, 3>& corners, const RootBeam& beam,
                    const std::optional<Vec2d>& lit, int quarters) {
        const std::size_t before = out_.beams.size();
        RootBeam part = beam;
        part.is_part = true;
        cut(corners, part, lit, quarters);
        Spectrum sum = black();
        for (std::size_t i = before; i < out_.beams.size(); ++i) sum += out_.beams[i].beam.flux;
        for (std::size_t i = before; i < out_.beams.size(); ++i)
            for (Eigen::Index k = 0; k < sum.size(); ++k)
                if (sum[k] > 0) out_.beams[i].beam.flux[k] *= beam.beam.flux[k] / sum[k];
        return out_.beams.size() > before;
    }
    // A part that is dark all along its edges is left out, unless it has the place `lit`. One that is lit there is like any
    // other beam.
    void cut(const std::array<RootNode, 3>& corners, RootBeam beam, const std::optional<Vec2d>& lit,
             int quarters) {
        std::array<RootNode, 12> edges;
        for (std::size_t i = 0; i < 3; ++i) {
            const RootNode& a = corners[i];
            const RootNode& b = corners[(i + 1) % 3];
            edges[4 * i] = a;
            edges[4 * i + 1] = quarter(a, b);
            edges[4 * i + 2] = node((a.at + b.at) / 2);
            edges[4 * i + 3] = quarter(b, a);
        }
        const bool is_lit_inside = lit && holds(corners, *lit);
        const auto is_lit = [](const RootNode& node) { return node.is_lit; };
        if (std::ranges::none_of(edges, is_lit) && !is_lit_inside) return;
        if (std::ranges::all_of(edges, is_lit)) {
            std::array<RootNode, 3> numbered = corners;
            for (RootNode& corner : numbered) number(corner);
            beam.beam.has_dark_part = false;
            divide(numbered, beam, quarters);
        } else if (quarters > 0) {
            beam.beam.flux /= 4;
            for (const std::array<RootNode, 3>& part :
                 quartered(corners, {edges[2], edges[6], edges[10]}))
                cut(part, beam, lit, quarters - 1);
        } else if (changes(edges) != 2 || !add_lit_side(corners, beam)) {
            const auto first = std::ranges::find_if(edges, is_lit);
            add_dark(corners, beam, first == edges.end() ? *lit : first->at);
        }
    }
    // How often light begins or ends to go the set's way round a triangle.
    static int changes(const std::array<RootNode, 12>& edges) {
        int count = 0;
        for (std::size_t i = 0; i < edges.size(); ++i)
            count += edges[i].is_lit != edges[(i + 1) % edges.size()].is_lit ? 1 : 0;
        return count;
    }
    // What is lit of a triangle that the horizon cuts once. False where that is not known well enough.
    bool add_lit_side(const std::array<RootNode, 3>& corners, const RootBeam& beam) {
        const auto lit = std::ranges::count_if(corners, &RootNode::is_lit);
        if (lit == 0 || lit == 3) return false;
        // The only lit corner, or the one after the only dark one.
        std::size_t first = 0;
        while (lit == 1 ? !corners[first].is_lit : corners[(first + 2) % 3].is_lit) ++first;
        const RootNode& a = corners[first];
        const RootNode& b = corners[(first + 1) % 3];
        const RootNode& c = corners[(first + 2) % 3];
        const RootNode beside_a = horizon(a.at, c.at);
        if (lit == 1) return add_to_horizon({a, horizon(a.at, b.at), beside_a}, beam);
        const RootNode beside_b = horizon(b.at, c.at);
        if (!add_to_horizon({a, beside_b, beside_a}, beam)) return false;
        add_lit({a, b, beside_b}, beam);
        return true;
    }
    // Its second edge is a chord of the horizon, beyond which there is light.
    bool add_to_horizon(const std::array<RootNode, 3>& corners, const RootBeam& beam) {
        constexpr double most_beyond = 0.2;
        constexpr double room = 1e-3;  // more than the last halving
        const Vec2d chord = (corners[1].at + corners[2].at) / 2;
        const Vec2d out = chord - corners[0].at;
        const Vec2d farthest = chord + most_beyond * out;
        if (node(farthest).is_lit) return false;
        const bool is_chord_lit = node(chord).is_lit;
        const RootNode middle =
            is_chord_lit ? horizon(chord, farthest) : horizon(corners[0].at, chord);
        add_lit(corners, beam);
        out_.beams.back().middles[0][1] = middle.ray;
        const double beyond =
            room + (is_chord_lit ? 1.5 * (middle.at - chord).norm() / out.norm() : 0);
        out_.beams.back().beam.beyond = static_cast<std::uint16_t>(65536 * beyond);
        return true;
    }
    void add_lit(std::array<RootNode, 3> corners, const RootBeam& beam) {
        std::array<RootNode, 3> middles;
        for (std::size_t i = 0; i < 3; ++i) middles[i] = between(corners[i], corners[(i + 1) % 3]);
        for (RootNode& corner : corners) number(corner);
        add(corners, middles, beam);
        out_.beams.back().beam.has_dark_part = false;
    }
    static bool holds(const std::array<RootNode, 3>& corners, const Vec2d& at) {
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec2d side = corners[(i + 1) % 3].at - corners[i].at;
            const Vec2d way = at - corners[i].at;
            const Vec2d across = corners[(i + 2) % 3].at - corners[i].at;
            least = std::min(least, cross(side, way) / cross(side, across));
        }
        return least >= 0;
    }
    // The rays of dark places are those of the last lit ones towards them.
    void add_dark(std::array<RootNode, 3> corners, const RootBeam& beam, const Vec2d& lit) {
        std::array<RootNode, 3> middles;
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec2d at = (corners[i].at + corners[(i + 1) % 3].at) / 2;
            middles[i] = node(at).is_lit ? node(at) : horizon(lit, at);
        }
        for (RootNode& corner : corners) {
            if (!corner.is_lit) corner.ray = horizon(lit, corner.at).ray;
            number(corner);
        }
        add(corners, middles, beam);
        out_.beams.back().beam.has_dark_part = true;
    }
    // The last place from a lit one towards a dark one of which the light goes the set's way.
    RootNode horizon(const Vec2d& lit, const Vec2d& dark) const {
        RootNode found = node(lit);
        double low = 0;
        double high = 1;
        for (int halving = 0; halving < most_lit_halvings; ++halving) {
            const double middle = (low + high) / 2;
            const RootNode here = node(lit + middle * (dark - lit));
            (here.is_lit ? low : high) = middle;
            if (here.is_lit) found = here;
        }
        return found;
    }
    // Its ray starts a little inside the triangle: an edge may lie along one of the next surface, behind which normals are
    // another facet's.
    RootNode node(const Vec2d& at) const {
        constexpr double inset = 1e-4;
        const Vec2d middle = Vec2d::Constant(1.0 / 3);
        RootNode node{at, polygon_.position(at).cast<float>(), {}};
        const auto ray = chain_.ray(polygon_.start(at + inset * (middle - at)));
        node.is_lit = ray.has_value();
        if (!ray) return node;
        node.ray = {ray->position.cast<float>(), ray->direction.cast<float>()};
        node.facets = ray->facets;
        return node;
    }
    RootNode between(const RootNode& a, const RootNode& b) const {
        RootNode middle = node((a.at + b.at) / 2);
        if (!middle.is_lit)
            middle.ray = {(a.ray.position + b.ray.position) / 2,
                          (a.ray.direction + b.ray.direction).normalized()};
        return middle;
    }
    // True where the triangle's middles meet different facets after the first surface.
    static bool meet_facets(const std::array<RootNode, 3>& middles) {
        constexpr double rounding = 1e-6;
        return std::ranges::any_of(middles, [&](const RootNode& node) {
            return node.is_lit && middles[0].is_lit &&
                   (node.facets - middles[0].facets).norm() > rounding;
        });
    }
    double light_area(const std::array<RootNode, 3>& corners) const {
        const auto ray =
            chain_.ray(polygon_.start((corners[0].at + corners[1].at + corners[2].at) / 3));
        return ray ? ray->light_area : 0;
    }
    static bool are_lit(const std::array<RootNode, 3>& nodes) {
        return std::ranges::all_of(nodes, &RootNode::is_lit);
    }
    // A quarter along an edge, where a cubic is off its quadratic most.
    RootNode quarter(const RootNode& a, const RootNode& b) const {
        return node(0.75 * a.at + 0.25 * b.at);
    }
    // `quarter_nodes`: of the three edges.
    bool is_rough(const std::array<RootNode, 3>& corners, const std::array<RootNode, 3>& middles,
                  const std::array<RootNode, 3>& quarter_nodes) const {
        double off_image = 0;
        double off_directions = 0;
        double apart = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const RootNode& a = corners[i];
            const RootNode& b = corners[(i + 1) % 3];
            const RootNode& middle = middles[i];
            const RootNode& here = quarter_nodes[i];
            const auto off = [&](Vec3 VertexRay::* part) {
                const Vec3 quadratic =
                    0.375F * a.ray.*part + 0.75F * middle.ray.*part - 0.125F * b.ray.*part;
                return static_cast<double>((here.ray.*part - quadratic).norm());
            };
            const double direction = off(&VertexRay::direction);
            const double size = static_cast<double>((b.origin - a.origin).norm());
            off_directions = std::max(off_directions, direction);
            off_image =
                std::max(off_image, (off(&VertexRay::position) + reach_ * direction) / size);
            for (const RootNode* other : {&b, &middle})
                apart = std::max(
                    apart, static_cast<double>((other->ray.direction - a.ray.direction).norm()));
        }
        return off_image > most_off_image && off_directions > most_off_directions * apart;
    }
    void number(RootNode& node) {
        node.number = first_number_ + static_cast<std::uint32_t>(out_.rays.size());
        out_.rays.push_back(node.ray);
        out_.origins.push_back(node.origin);
    }
    void add(const std::array<RootNode, 3>& corners, const std::array<RootNode, 3>& middles,
             const RootBeam& beam) {
        RootBeam& added = out_.beams.emplace_back(beam);
        for (std::size_t i = 0; i < 3; ++i) added.beam.corners[i] = corners[i].number;
        added.middles[0] = {middles[0].ray, middles[1].ray, middles[2].ray};
    }

    const LightChain& chain_;
    const FirstPolygon& polygon_;
    double reach_;
    bool meets_mesh_;
    std::uint32_t first_number_;
    RootBeams& out_;
};

/// Prepares the beams of a set.
class RootPreparation {
public:
    RootPreparation(const Scene& scene, const TriangleMesh& polygons,
                    const std::vector<RayOrigin>& origins, const BeamSet& set)
        : scene_(scene),
          set_(set),
          chain_(scene, set),
          exact_(first_exact_surface(scene, set)),
          cut_(exact_ ? CutTriangles(polygons, origins, set,
                                     [this](CutTriangles::Whole& whole) { return find_lit(whole); })
                      : CutTriangles(set)),
          reach_(static_cast<double>(scene.diameter())),
          meets_mesh_(meets_mesh_after_first(scene, set)) {}

    RootBeams run(const Chunk& beams) const {
        RootBeams out;
        for (auto i = static_cast<std::uint32_t>(beams.first); i < beams.end; ++i) prepare(i, out);
        return out;
    }

private:
    void prepare(std::uint32_t number, RootBeams& out) const {
        for (const CutTriangles::Whole& whole : cut_.after(number)) add_cut(whole, number, out);
        if (cut_.has(number)) return;
        const Beam& beam = set_.beams[number];
        const std::size_t count = beam.triangle_count();
        const std::size_t before = out.beams.size();
        for (std::size_t which = 0; which < count; ++which) divide(number, which, out);
        if (count == 1 || out.beams.size() - before > count) return;
        // A cell that need not be divided stays one.
        RootBeam cell{.beam = beam, .from = number};
        for (std::size_t which = 0; which < count; ++which)
            cell.middles[which] = out.beams[before + which].middles[0];
        out.beams.resize(before);
        out.beams.push_back(cell);
    }

    FirstPolygon polygon(const CutTriangles::Whole& whole) const {
        return {scene_, set_, exact_, whole.beam, 0, whole.corners};
    }
    bool find_lit(CutTriangles::Whole& whole) const {
        const FirstPolygon triangle = polygon(whole);
        const std::array<Vec2d, 4> places = {triangle.coordinates(whole.middle), unit_corners[0],
                                             unit_corners[1], unit_corners[2]};
        bool is_lit = false;
        bool has_dark = false;
        for (const Vec2d& at : places) {
            const bool lit = chain_.ray(triangle.start(at)).has_value();
            if (lit && !is_lit) whole.lit = at;
            is_lit = is_lit || lit;
            has_dark = has_dark || !lit;
        }
        return is_lit && (has_dark || whole.is_covered);
    }
    void add_cut(const CutTriangles::Whole& whole, std::uint32_t number, RootBeams& out) const {
        const FirstPolygon triangle = polygon(whole);
        divider(triangle, out)
            .add_cut({.beam = whole.beam, .from = number, .is_part = true}, whole.corners,
                     whole.lit);
    }
    Divider divider(const FirstPolygon& polygon, RootBeams& out) const {
        return {chain_, polygon, reach_, meets_mesh_, static_cast<std::uint32_t>(set_.rays.size()),
                out};
    }

    void divide(std::uint32_t number, std::size_t which, RootBeams& out) const {
        const Beam& beam = set_.beams[number];
        const std::array<std::uint32_t, 3> rays = beam.triangle_corners(which);
        std::array<RootNode, 3> corners;
        for (std::size_t i = 0; i < 3; ++i)
            corners[i] = {.at = unit_corners[i],
                          .origin = set_.origin(rays[i]),
                          .ray = set_.rays[rays[i]],
                          .number = rays[i]};
        RootBeam whole{.beam = beam, .from = number, .is_part = beam.triangle_count() > 1};
        whole.beam.flux *= static_cast<float>(beam.share_of(which));
        whole.beam.first_share = 1;
        whole.beam.triangle = beam.mesh_triangle(which);
        whole.beam.is_cell = false;
        whole.beam.corners[3] = Beam::none;
        const FirstPolygon polygon(scene_, set_, exact_, beam, which);
        divider(polygon, out).divide(corners, whole, most_root_quarters);
    }

    const Scene& scene_;
    const BeamSet& set_;
    LightChain chain_;
    std::optional<SpecularSurface> exact_;
    CutTriangles cut_;
    double reach_;
    bool meets_mesh_;
};

/// Puts prepared beams in the place of a set's.
class RootJoin {
public:
    explicit RootJoin(BeamSet& set) : set_(set), new_number_(set.beams.size(), Beam::none) {
        set_.beams.clear();
        set_.middles.clear();
    }

    void add(const RootBeams& some, std::size_t old_rays) {
        const auto moved = static_cast<std::uint32_t>(set_.rays.size() - old_rays);
        for (const RootBeam& each : some.beams) {
            if (!each.is_part)
                new_number_[each.from] = static_cast<std::uint32_t>(set_.beams.size());
            from_.push_back(each.is_part ? Beam::none : each.from);
            Beam& beam = set_.beams.emplace_back(each.beam);
            for (std::uint32_t& corner : beam.corners)
                if (corner != Beam::none && corner >= old_rays) corner += moved;
            for (std::size_t i = 0; i < set_.triangle_room; ++i)
                set_.middles.push_back(each.middles[i]);
        }
        set_.rays.insert(set_.rays.end(), some.rays.begin(), some.rays.end());
        if (!set_.origins.empty())
            set_.origins.insert(set_.origins.end(), some.origins.begin(), some.origins.end());
    }

    // Parts have no partners, and new rays no spreads.
    void finish() {
        if (!set_.spreads.empty()) set_.spreads.resize(set_.rays.size());
        if (set_.partners.empty()) return;
        std::vector<std::uint32_t> partners(set_.beams.size(), Beam::none);
        for (std::size_t i = 0; i < partners.size(); ++i) {
            if (from_[i] == Beam::none) continue;
            const std::uint32_t partner = set_.partners[from_[i]];
            if (partner != Beam::none) partners[i] = new_number_[partner];
        }
        set_.partners = std::move(partners);
    }

private:
    BeamSet& set_;
    std::vector<std::uint32_t> new_number_;  ///< one an old beam; none where it was divided
    std::vector<std::uint32_t> from_;        ///< one a beam: the old one, unless it is a part
};

bool comes_to_front(const LightSample& light, const std::vector<RayOrigin>& origins,
                    const Beam& beam) {
    float slant = 0;
    for (const std::uint32_t corner : beam.triangle_corners(0))
        slant += origins[corner].normal.dot(to_light(light, origins[corner].position));
    return slant > 0;
}

}  // namespace

void prepare_roots(const Scene& scene, const TriangleMesh& polygons,
                   const std::vector<RayOrigin>& origins, int threads, BeamSet& set) {
    if (set.beams.empty()) return;
    for (Beam& beam : set.beams) beam.front = comes_to_front(set.light, origins, beam);
    if (set.path.size() > 1)
        for (const RayOrigin& origin : origins) set.origins.push_back(origin.position);
    std::vector<RootBeams> chunks(chunk_count(set.beams.size(), root_beams_together));
    const RootPreparation preparation(scene, polygons, origins, set);
    parallel_chunks(threads, set.beams.size(), root_beams_together,
                    [&](const Chunk& chunk) { chunks[chunk.index] = preparation.run(chunk); });
    const bool divides =
        std::ranges::any_of(chunks, [](const RootBeams& some) { return !some.rays.empty(); });
    if (divides && set.origins.empty())
        for (const VertexRay& ray : set.rays) set.origins.push_back(ray.position);
    const bool has_cells =
        std::ranges::any_of(set.beams, [](const Beam& beam) { return beam.triangle_count() > 1; });
    set.triangle_room = has_cells ? 2 : 1;
    const std::size_t old_rays = set.rays.size();
    RootJoin join(set);
    for (const RootBeams& some : chunks) join.add(some, old_rays);
    join.finish();
}

}  // namespace caustics::beamtree
