#include "beamtree/tracing/piece_detail.h"

#include <algorithm>

namespace caustics {
namespace {

// Between unit normals.
constexpr float flat = 1e-3F;
constexpr float most_turn = 0.1F;
// A caster is small if its box has less of a diagonal than so many times the piece's longest side.
constexpr float small_share = 4;

}  // namespace

PieceDetail::PieceDetail(const Scene& scene) : far_(scene.diameter()) {
    for (const std::uint32_t caster : scene.casters())
        casters_.push_back(bounds(scene.shapes()[caster]));
}

bool PieceDetail::is_flat(const RayOrigin& a, const RayOrigin& b) {
    return (a.normal - b.normal).norm() < flat;
}

bool PieceDetail::is_coarse(const RayOrigin& from, const RayArrival& a, const RayOrigin& other,
                            const RayArrival& b) {
    return is_flat(from, other) && (a.shading_normal - b.shading_normal).norm() > most_turn;
}

bool PieceDetail::may_pass_round_caster(const std::array<const VertexRay*, 3>& rays) const {
    Box light;
    float longest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        light.extend(rays[i]->position);
        light.extend(rays[i]->position + far_ * rays[i]->direction);
        longest = std::max(longest, (rays[i]->position - rays[(i + 1) % 3]->position).norm());
    }
    return std::ranges::any_of(casters_, [&](const Box& caster) {
        return caster.diagonal().norm() < small_share * longest && light.intersects(caster);
    });
}

}  // namespace caustics
