#include "beamtree/light/root_divider.h"

#include <algorithm>
#include <limits>

#include "beamtree/light/projected.h"

namespace caustics::beamtree {
namespace {

constexpr int most_cut_quarters = 1;
// By how much an image may be off its quadratic where light has gone as far as the scene is wide, over the polygon's
// size on the first surface: less does no harm. Directions may be off by this share of how far they part, whatever the
// scene: a wave of two radians a polygon has 0.03, and half the polygon a quarter of that.
constexpr double most_off_image = 0.1;
constexpr double most_off_directions = 0.02;
constexpr int most_lit_halvings = 12;

}  // namespace

void RootDivider::add_cut(const RootBeam& beam, const std::array<Vec3, 3>& origins,
                          const Vec2d& lit) {
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

bool RootDivider::take_own_rays(std::array<RootNode, 3>& corners) {
    constexpr float most_apart = 0.01F;  // of how far the rays part
    constexpr float least_apart = 1e-4F;
    std::array<RootNode, 3> own = corners;
    for (RootNode& each : own)
        if (const RootNode here = node(each.at); here.is_lit) each.ray = here.ray;
    float spread = 0;
    for (std::size_t i = 0; i < 3; ++i)
        spread = std::max(spread, (own[i].ray.direction - own[(i + 1) % 3].ray.direction).norm());
    bool takes = false;
    for (std::size_t i = 0; i < 3; ++i) {
        const float apart = (own[i].ray.direction - corners[i].ray.direction).norm();
        // A node lies a little inside: where rays hardly part, the shared ray is nearer to the corner's own.
        if (!(apart > std::max(least_apart, most_apart * spread))) continue;
        corners[i].ray = own[i].ray;
        number(corners[i]);
        takes = true;
    }
    return takes;
}

void RootDivider::divide(const std::array<RootNode, 3>& corners, const RootBeam& beam,
                         int quarters) {
    const std::array<RootNode, 3> middles = {between(corners[0], corners[1]),
                                             between(corners[1], corners[2]),
                                             between(corners[2], corners[0])};
    // The image of several facets is in pieces, of which each has roots of its own: polygons serve there.
    if (meet_facets(middles)) {
        out_.beams.push_back(beam);
        for (std::size_t i = 0; i < 3; ++i) out_.beams.back().beam.corners[i] = corners[i].number;
        return;
    }
    const std::array<RootNode, 3> quarter_nodes = {quarter(corners[0], corners[1]),
                                                   quarter(corners[1], corners[2]),
                                                   quarter(corners[2], corners[0])};
    if (!are_lit(middles) || !are_lit(quarter_nodes)) {
        if (!meets_mesh_ &&
            divide_cut({node(corners[0].at), node(corners[1].at), node(corners[2].at)}, beam, {},
                       std::min(quarters, most_cut_quarters)))
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

std::array<std::array<RootNode, 3>, 4> RootDivider::quartered(
    const std::array<RootNode, 3>& corners, const std::array<RootNode, 3>& m) {
    const auto& [a, b, c] = corners;
    return {{{a, m[0], m[2]}, {m[0], b, m[1]}, {m[2], m[1], c}, {m[0], m[1], m[2]}}};
}

bool RootDivider::divide_cut(const std::array<RootNode, 3>& corners, const RootBeam& beam,
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

void RootDivider::cut(const std::array<RootNode, 3>& corners, RootBeam beam,
                      const std::optional<Vec2d>& lit, int quarters) {
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

int RootDivider::changes(const std::array<RootNode, 12>& edges) {
    int count = 0;
    for (std::size_t i = 0; i < edges.size(); ++i)
        count += edges[i].is_lit != edges[(i + 1) % edges.size()].is_lit ? 1 : 0;
    return count;
}

bool RootDivider::add_lit_side(const std::array<RootNode, 3>& corners, const RootBeam& beam) {
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

bool RootDivider::add_to_horizon(const std::array<RootNode, 3>& corners, const RootBeam& beam) {
    constexpr double most_beyond = 0.2;
    constexpr double room = 1e-3;  // more than the last halving
    const Vec2d chord = (corners[1].at + corners[2].at) / 2;
    const Vec2d out = chord - corners[0].at;
    const Vec2d farthest = chord + most_beyond * out;
    if (node(farthest).is_lit) return false;
    const bool is_chord_lit = node(chord).is_lit;
    const RootNode middle = is_chord_lit ? horizon(chord, farthest) : horizon(corners[0].at, chord);
    add_lit(corners, beam);
    out_.beams.back().middles[0][1] = middle.ray;
    const double beyond = room + (is_chord_lit ? 1.5 * (middle.at - chord).norm() / out.norm() : 0);
    out_.beams.back().beam.beyond = static_cast<std::uint16_t>(65536 * beyond);
    return true;
}

void RootDivider::add_lit(std::array<RootNode, 3> corners, const RootBeam& beam) {
    std::array<RootNode, 3> middles;
    for (std::size_t i = 0; i < 3; ++i) middles[i] = between(corners[i], corners[(i + 1) % 3]);
    for (RootNode& corner : corners) number(corner);
    add(corners, middles, beam);
}

bool RootDivider::holds(const std::array<RootNode, 3>& corners, const Vec2d& at) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec2d side = corners[(i + 1) % 3].at - corners[i].at;
        const Vec2d way = at - corners[i].at;
        const Vec2d across = corners[(i + 2) % 3].at - corners[i].at;
        least = std::min(least, cross(side, way) / cross(side, across));
    }
    return least >= 0;
}

void RootDivider::add_dark(std::array<RootNode, 3> corners, const RootBeam& beam,
                           const Vec2d& lit) {
    std::array<RootNode, 3> middles;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec2d at = (corners[i].at + corners[(i + 1) % 3].at) / 2;
        middles[i] = node(at);
        if (!middles[i].is_lit) middles[i] = horizon(lit, at);
    }
    for (RootNode& corner : corners) {
        if (!corner.is_lit) corner.ray = horizon(lit, corner.at).ray;
        number(corner);
    }
    add(corners, middles, beam);
    out_.beams.back().beam.has_dark_part = true;
}

RootNode RootDivider::horizon(const Vec2d& lit, const Vec2d& dark) const {
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

RootNode RootDivider::node(const Vec2d& at) const {
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

RootNode RootDivider::between(const RootNode& a, const RootNode& b) const {
    RootNode middle = node((a.at + b.at) / 2);
    if (!middle.is_lit)
        middle.ray = {(a.ray.position + b.ray.position) / 2,
                      (a.ray.direction + b.ray.direction).normalized()};
    return middle;
}

bool RootDivider::meet_facets(const std::array<RootNode, 3>& middles) {
    constexpr double rounding = 1e-6;
    return std::ranges::any_of(middles, [&](const RootNode& node) {
        return node.is_lit && middles[0].is_lit &&
               (node.facets - middles[0].facets).norm() > rounding;
    });
}

double RootDivider::light_area(const std::array<RootNode, 3>& corners) const {
    const auto ray =
        chain_.ray(polygon_.start((corners[0].at + corners[1].at + corners[2].at) / 3));
    return ray ? ray->light_area : 0;
}

bool RootDivider::are_lit(const std::array<RootNode, 3>& nodes) {
    return std::ranges::all_of(nodes, &RootNode::is_lit);
}

RootNode RootDivider::quarter(const RootNode& a, const RootNode& b) const {
    return node(0.75 * a.at + 0.25 * b.at);
}

bool RootDivider::is_rough(const std::array<RootNode, 3>& corners,
                           const std::array<RootNode, 3>& middles,
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
        off_image = std::max(off_image, (off(&VertexRay::position) + reach_ * direction) / size);
        for (const RootNode* other : {&b, &middle})
            apart = std::max(apart,
                             static_cast<double>((other->ray.direction - a.ray.direction).norm()));
    }
    return off_image > most_off_image && off_directions > most_off_directions * apart;
}

void RootDivider::number(RootNode& node) {
    node.number = first_number_ + static_cast<std::uint32_t>(out_.rays.size());
    out_.rays.push_back(node.ray);
    out_.origins.push_back(node.origin);
}

void RootDivider::add(const std::array<RootNode, 3>& corners,
                      const std::array<RootNode, 3>& middles, const RootBeam& beam) {
    RootBeam& added = out_.beams.emplace_back(beam);
    for (std::size_t i = 0; i < 3; ++i) added.beam.corners[i] = corners[i].number;
    added.middles[0] = {middles[0].ray, middles[1].ray, middles[2].ray};
}

}  // namespace caustics::beamtree
