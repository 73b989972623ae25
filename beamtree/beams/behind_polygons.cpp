#include "beamtree/beams/behind_polygons.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "core/base/error.h"

namespace caustics::beamtree {
namespace {

// How far beside its triangle, in its own edges, the foot of a light may lie: two triangles that bulge outwards leave
// a wedge open between what lies straight above them.
constexpr double beside = 0.01;

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

}  // namespace

void refuse_light_behind_polygons(const Scene& scene, const LitCaster& surface) {
    const CasterMesh& caster = surface.caster();
    if (!caster.tessellated || surface.light().kind == LightSample::Kind::directional) return;
    for (std::uint32_t i = 0; i < caster.mesh.triangles.size(); ++i) {
        const std::optional<Gap> gap = gap_round(scene, surface, i);
        if (!gap) continue;
        const Vec3d at = surface.world(surface.light().position);
        // What a polygon leaves of its surface falls with the square of its size.
        const double finer = 1.5 * std::sqrt(1 + gap->polygon / gap->surface);
        throw UnsupportedScene(fmt::format(
            "{}: the light at ({:g}, {:g}, {:g}) is {:.2g} m from the curved surface, and behind "
            "the "
            "polygons that stand for it: beams would lose its light (take a mesh_resolution {:.0f} "
            "times as fine, move the light away, or use photonmap)",
            surface.name(), at.x(), at.y(), at.z(), gap->surface, std::ceil(finer)));
    }
}

}  // namespace caustics::beamtree
