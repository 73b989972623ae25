#include "beamtree/tracing/piece_detail.h"

#include <algorithm>

namespace caustics::beamtree {
namespace {

constexpr float most_turn = 0.1F;  // between unit normals
// A caster is small if its box has less of a diagonal than so many times the piece's longest side.
constexpr float small_share = 4;

bool is_flat(const RayOrigin& a, const RayOrigin& b) { return is_flat_between(a.normal, b.normal); }

}  // namespace

bool is_coarse(const RayOrigin& from, const RayArrival& a, const RayOrigin& other,
               const RayArrival& b) {
    return is_flat(from, other) && (a.shading_normal - b.shading_normal).norm() > most_turn;
}

bool may_pass_round_caster(const SceneBoxes& boxes, const Piece& piece) {
    const auto& [a, b, c] = piece;
    if (!is_flat(a.origin, b.origin) || !is_flat(b.origin, c.origin)) return false;
    Box light;
    float longest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const VertexRay& ray = piece[i].ray;
        light.extend(ray.position);
        light.extend(ray.position + boxes.diameter * ray.direction);
        longest = std::max(longest, (ray.position - piece[(i + 1) % 3].ray.position).norm());
    }
    return std::ranges::any_of(boxes.casters, [&](const Box& caster) {
        return caster.diagonal().norm() < small_share * longest && light.intersects(caster);
    });
}

}  // namespace caustics::beamtree
