#include "beamtree/beams/near_light.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace caustics::beamtree {
namespace {

// The angle under which the light may see an edge, and one in flat glass of a mesh as it is: what a
// plane mirror reflects comes from a point, what a plane refracts does not.
constexpr double widest = pi_d / 6;
constexpr double widest_in_flat_glass = pi_d / 24;
// How many edges span half of a spot light's cone.
constexpr double spot_parts = 8;
// How much longer than those of an even mesh edges may be.
constexpr double slack = 4;

// Whether there is no point between the two to speak of.
bool touch(const Vec3& a, const Vec3& b) {
    const float largest = std::max(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff());
    return (a - b).cwiseAbs().maxCoeff() <= 4 * std::numeric_limits<float>::epsilon() * largest;
}

}  // namespace

// Two edges of the angle u, at an angle of incidence i, enclose u^2 cos i / 2 of the 4 pi.
NearLight::NearLight(const LitCaster& surface)
    : bender_(surface.bender()),
      light_(surface.light()),
      most_(slack * slack * 8 * pi_d /
            static_cast<double>(std::max<std::size_t>(surface.caster().mesh.triangles.size(), 1))),
      is_glass_mesh_(!surface.caster().tessellated &&
                     std::holds_alternative<Dielectric>(surface.bsdf().model)) {}

bool NearLight::is_wide(const MeshPoint& a, const MeshPoint& b) const {
    if (light_.kind == LightSample::Kind::directional || touch(a.position, b.position))
        return false;
    const Vec3d u = (a.position - light_.position).cast<double>();
    const Vec3d v = (b.position - light_.position).cast<double>();
    const double angle = std::atan2(u.cross(v).norm(), u.dot(v));
    const bool is_flat_glass = is_glass_mesh_ && is_flat_between(a.normal, b.normal);
    if (angle > (is_flat_glass ? widest_in_flat_glass : widest)) return true;
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
    return is_wide(*a, *b) || is_wide(*b, *c) || is_wide(*c, *a);
}

std::vector<MeshPiece> NearLight::pieces(const MeshPiece& triangle) const {
    std::vector<MeshPiece> all;
    divide(triangle, all);
    return all;
}

void NearLight::divide(const MeshPiece& piece, std::vector<MeshPiece>& pieces) const {
    std::array<bool, 3> wide;
    for (std::size_t i = 0; i < 3; ++i) wide[i] = is_wide(piece[i], piece[(i + 1) % 3]);
    const auto count = std::count(wide.begin(), wide.end(), true);
    if (count == 0) {
        pieces.push_back(piece);
        return;
    }
    // With one wide edge it is the first, with two the third is not.
    std::size_t first = 0;
    while (count == 1 ? !wide[first] : count == 2 && wide[(first + 2) % 3]) ++first;
    const MeshPoint& a = piece[first];
    const MeshPoint& b = piece[(first + 1) % 3];
    const MeshPoint& c = piece[(first + 2) % 3];
    const MeshPoint ab = bender_.between(a, b, 0.5F);
    if (count == 1) {
        divide({a, ab, c}, pieces);
        divide({ab, b, c}, pieces);
        return;
    }
    const MeshPoint bc = bender_.between(b, c, 0.5F);
    divide({ab, b, bc}, pieces);
    if (count == 2) {
        divide({a, ab, c}, pieces);
        divide({ab, bc, c}, pieces);
        return;
    }
    const MeshPoint ca = bender_.between(c, a, 0.5F);
    divide({a, ab, ca}, pieces);
    divide({ca, bc, c}, pieces);
    divide({ab, bc, ca}, pieces);
}

}  // namespace caustics::beamtree
