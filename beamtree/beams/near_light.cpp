#include "beamtree/beams/near_light.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "core/base/error.h"

namespace caustics::beamtree {
namespace {

// The angle under which the light may see an edge, and one in flat glass of a mesh as it is: what a
// plane mirror reflects comes from a point, what a plane refracts does not.
constexpr double widest_seen = pi_d / 6;
constexpr double widest_in_flat_glass = pi_d / 24;
// Normals that turn by less, of the angle under which the light sees the edge, bend it as a plane does.
constexpr double flat_turn = 0.05;
// How many edges span half of a spot light's cone.
constexpr double spot_parts = 8;
// How much longer than those of an even mesh edges may be.
constexpr double slack = 4;
// An edge as long as the scene is halved so often down to what floats tell apart at the light.
constexpr int most_halvings = 48;
// Pieces of a caster's triangles in one light.
constexpr std::uint64_t most_pieces = 1U << 20U;

// Whether there is no point between the two to speak of. Each coordinate has a rounding of its own: above a level
// mirror a light may be nearer to it than floats are apart at its height.
bool touch(const Vec3& a, const Vec3& b) {
    constexpr float rounding = std::numeric_limits<float>::epsilon();
    const Eigen::Array3f largest = a.array().abs().max(b.array().abs());
    const Eigen::Array3f known = largest.max(rounding * largest.maxCoeff());
    return ((a - b).array().abs() <= 4 * rounding * known).all();
}

double angle_between(const Vec3d& u, const Vec3d& v) {
    return std::atan2(u.cross(v).norm(), u.dot(v));
}

}  // namespace

// Two edges of the angle u, at an angle of incidence i, enclose u^2 cos i / 2 of the 4 pi.
NearLight::NearLight(const LitCaster& surface)
    : surface_(surface),
      bender_(surface.bender()),
      light_(surface.light()),
      most_(slack * slack * 8 * pi_d /
            static_cast<double>(std::max<std::size_t>(surface.caster().mesh.triangles.size(), 1))),
      is_glass_mesh_(!surface.caster().tessellated &&
                     std::holds_alternative<Dielectric>(surface.bsdf().model)) {}

Vec3d NearLight::from_light(const MeshPoint& point) const {
    return (point.position - light_.position).cast<double>();
}

NearLight::Edge NearLight::edge(const MeshPoint& a, const MeshPoint& b) const {
    if (!is_glass_mesh_) return {widest_seen, 0};
    const double turn = static_cast<double>((a.normal - b.normal).norm());
    const bool is_flat = is_flat_between(a.normal, b.normal) ||
                         turn < flat_turn * angle_between(from_light(a), from_light(b));
    return {is_flat ? widest_in_flat_glass : widest_seen, 0};
}

bool NearLight::is_wide(const MeshPoint& a, const MeshPoint& b, const Edge& edge) const {
    if (edge.halvings == most_halvings || light_.kind == LightSample::Kind::directional ||
        touch(a.position, b.position))
        return false;
    const Vec3d u = from_light(a);
    const Vec3d v = from_light(b);
    const double angle = angle_between(u, v);
    if (angle > edge.widest) return true;
    if (light_.spot && angle > static_cast<double>(light_.spot->cutoff) / spot_parts) {
        const Vec3d middle = u.normalized() + v.normalized();
        if (static_cast<double>(light_.spot->angle_to(middle.cast<float>())) <
            static_cast<double>(light_.spot->cutoff) + angle)
            return true;
    }
    const double cosine = std::max(std::abs(a.normal.cast<double>().dot(u)) / u.norm(),
                                   std::abs(b.normal.cast<double>().dot(v)) / v.norm());
    return angle * angle * cosine > most_;
}

bool NearLight::is_near(const PieceCorners& corners) const {
    const auto& [a, b, c] = corners;
    return is_wide(*a, *b, edge(*a, *b)) || is_wide(*b, *c, edge(*b, *c)) ||
           is_wide(*c, *a, edge(*c, *a));
}

std::vector<MeshPiece> NearLight::pieces(const MeshPiece& triangle) const {
    const auto& [a, b, c] = triangle;
    std::vector<MeshPiece> all;
    divide(triangle, {edge(a, b), edge(b, c), edge(c, a)}, all);
    return all;
}

NearLight::Edge NearLight::half_of(const Edge& edge) { return {edge.widest, edge.halvings + 1}; }

NearLight::Edge NearLight::edge_inside(const Edges& edges) {
    Edge inside = edges[0];
    for (const Edge& edge : edges) {
        inside.widest = std::max(inside.widest, edge.widest);
        inside.halvings = std::max(inside.halvings, edge.halvings);
    }
    inside.halvings = std::min(inside.halvings + 1, most_halvings);
    return inside;
}

// Each part's edges have been halved more often, all in all, than the whole's: so it ends.
void NearLight::divide(const MeshPiece& piece, const Edges& edges,
                       std::vector<MeshPiece>& pieces) const {
    std::array<bool, 3> wide;
    for (std::size_t i = 0; i < 3; ++i) wide[i] = is_wide(piece[i], piece[(i + 1) % 3], edges[i]);
    const auto count = std::count(wide.begin(), wide.end(), true);
    if (count == 0) {
        count_piece();
        pieces.push_back(piece);
        return;
    }
    // With one wide edge it is the first, with two the third is not.
    std::size_t first = 0;
    while (count == 1 ? !wide[first] : count == 2 && wide[(first + 2) % 3]) ++first;
    const MeshPoint& a = piece[first];
    const MeshPoint& b = piece[(first + 1) % 3];
    const MeshPoint& c = piece[(first + 2) % 3];
    const Edge& to_b = edges[first];
    const Edge& to_c = edges[(first + 1) % 3];
    const Edge& to_a = edges[(first + 2) % 3];
    const Edge inner = edge_inside(edges);
    const MeshPoint ab = bender_.between(a, b, 0.5F);
    if (count == 1) {
        divide({a, ab, c}, {half_of(to_b), inner, to_a}, pieces);
        divide({ab, b, c}, {half_of(to_b), to_c, inner}, pieces);
        return;
    }
    const MeshPoint bc = bender_.between(b, c, 0.5F);
    divide({ab, b, bc}, {half_of(to_b), half_of(to_c), inner}, pieces);
    if (count == 2) {
        divide({a, ab, c}, {half_of(to_b), inner, to_a}, pieces);
        divide({ab, bc, c}, {inner, half_of(to_c), inner}, pieces);
        return;
    }
    const MeshPoint ca = bender_.between(c, a, 0.5F);
    divide({a, ab, ca}, {half_of(to_b), inner, half_of(to_a)}, pieces);
    divide({ca, bc, c}, {inner, half_of(to_c), half_of(to_a)}, pieces);
    divide({ab, bc, ca}, {inner, inner, inner}, pieces);
}

void NearLight::count_piece() const {
    if (++count_ <= most_pieces) return;
    const Vec3d position = surface_.world(light_.position);
    std::ostringstream message;
    message << surface_.name() << ": the light at (" << position.x() << ", " << position.y() << ", "
            << position.z() << ") is so near to polygons so long that beams would need more than "
            << most_pieces
            << " pieces of them (give them a more even length and width, move the light away, or "
               "use photonmap)";
    throw UnsupportedScene(message.str());
}

}  // namespace caustics::beamtree
