#include "beamtree/beams/behind_polygons.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/base/error.h"
#include "core/geometry/segment.h"

namespace caustics::beamtree {
namespace {

// How far beside its triangle, in its own edges, the foot of a light may lie: two triangles that bulge outwards leave
// a wedge open between what lies straight above them.
constexpr double beside = 0.01;

constexpr std::size_t most_looked_at = 400;

// What a polygon leaves of its surface falls with the square of its size.
double finer_by(double over_gap) { return 1.5 * std::sqrt(over_gap); }

struct Gap {
    double polygon;  ///< height of the light above the polygon [m]
    double surface;  ///< and of the surface above the light
};

bool is_above(const Vec3d& place, const std::array<Vec3d, 3>& corners, const Vec3d& normal) {
    const double area2 = (corners[1] - corners[0]).cross(corners[2] - corners[0]).dot(normal);
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3d& a = corners[i];
        const Vec3d& b = corners[(i + 1) % 3];
        if ((b - a).cross(place - a).dot(normal) < -beside * area2) return false;
    }
    return true;
}

std::optional<Gap> gap_round(const Scene& scene, const LitCaster& surface, std::uint32_t triangle) {
    const double bulge = static_cast<double>(surface.offset(triangle)) -
                         static_cast<double>(surface.corner_offset(triangle));
    const TriangleMesh& mesh = surface.caster().mesh;
    std::array<Vec3d, 3> corners;
    for (std::size_t i = 0; i < 3; ++i)
        corners[i] = mesh.positions[mesh.triangles[triangle][i]].cast<double>();
    const Vec3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
    const Vec3 light = surface.light().position;
    const double height = normal.dot(light.cast<double>() - corners[0]);
    if (!(std::abs(height) < bulge) || !is_above(light.cast<double>(), corners, normal)) return {};
    const Vec3 away = (height > 0 ? normal : -normal).cast<float>();
    const auto hit = scene.intersect({light, away, static_cast<float>(bulge)});
    if (!hit || hit->shape != surface.caster().shape) return {};
    return Gap{std::abs(height), static_cast<double>(hit->distance)};
}

// The middle of a triangle's longest edge, which lies farthest from the surface.
Vec3 lowest(const std::array<Vec3, 3>& corners) {
    std::size_t longest = 0;
    const auto length = [&](std::size_t i) { return (corners[(i + 1) % 3] - corners[i]).norm(); };
    for (const std::size_t i : {1U, 2U})
        if (length(i) > length(longest)) longest = i;
    return (corners[longest] + corners[(longest + 1) % 3]) / 2;
}

// How far a polygon lies from its surface, over how far another surface below that does, where that is less than twice
// as far.
std::optional<double> depth_over_wall(const Scene& scene, const CasterMesh& caster,
                                      const std::array<Vec3, 3>& corners) {
    const auto& [a, b, c] = corners;
    const Vec3 middle = lowest(corners);
    const Vec3 normal = (b - a).cross(c - a).stableNormalized();
    const float far = (b - a).norm() + (c - a).norm();
    for (const Vec3& away : {normal, Vec3(-normal)}) {
        const auto first = scene.intersect({middle, away, far});
        if (!first) continue;
        float depth = first->distance;
        if (first->shape != caster.shape) {
            Ray on = spawn_ray({first->position, first->geometric_normal, first->offset}, away);
            on.max_distance = far;
            const auto own = scene.intersect(on);
            if (!own || own->shape != caster.shape) continue;
            depth += own->distance;
        }
        const auto wall = scene.intersect({middle - depth * away, away, 2 * depth});
        if (wall && wall->shape != caster.shape)
            return static_cast<double>(depth) /
                   static_cast<double>(std::max(2 * depth - wall->distance, wall->offset));
    }
    return {};
}

}  // namespace

WallsBehind walls_behind_polygons(const Scene& scene, const CasterMesh& caster) {
    WallsBehind walls;
    if (!caster.tessellated) return walls;
    const auto& triangles = caster.mesh.triangles;
    const std::size_t stride = 1 + triangles.size() / most_looked_at;
    double looked_at = 0;
    for (std::size_t i = 0; i < triangles.size(); i += stride) {
        std::array<Vec3, 3> corners;
        for (std::size_t k = 0; k < 3; ++k) corners[k] = caster.mesh.positions[triangles[i][k]];
        ++looked_at;
        const std::optional<double> over = depth_over_wall(scene, caster, corners);
        if (!over) continue;
        ++walls.share;
        walls.finer = std::max(walls.finer, finer_by(*over));
    }
    if (looked_at > 0) walls.share /= looked_at;
    return walls;
}

void refuse_light_behind_polygons(const Scene& scene, const LitCaster& surface) {
    const CasterMesh& caster = surface.caster();
    if (!caster.tessellated || surface.light().kind == LightSample::Kind::directional) return;
    for (std::uint32_t i = 0; i < caster.mesh.triangles.size(); ++i) {
        const std::optional<Gap> gap = gap_round(scene, surface, i);
        if (!gap) continue;
        const Vec3d at = surface.world(surface.light().position);
        const double finer = finer_by(1 + gap->polygon / gap->surface);
        throw UnsupportedScene(fmt::format(
            "{}: the light at ({:g}, {:g}, {:g}) is {:.2g} m from the curved surface, and behind "
            "the "
            "polygons that stand for it: beams would lose its light (take a mesh_resolution {:.0f} "
            "times as fine, move the light away, or use photonmap)",
            surface.name(), at.x(), at.y(), at.z(), gap->surface, std::ceil(finer)));
    }
}

}  // namespace caustics::beamtree
