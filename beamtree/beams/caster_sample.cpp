#include "beamtree/beams/caster_sample.h"

namespace caustics::beamtree {

CasterMesh draw_polygons(const TriangleMesh& mesh, std::size_t count, Rng& rng) {
    CasterMesh drawn;
    drawn.flat = mesh.normals.empty();
    const std::vector<Vec3>& p = mesh.positions;
    for (std::size_t i = 0; i < count; ++i) {
        const auto at =
            static_cast<std::size_t>(rng.next_fine() * static_cast<double>(mesh.triangles.size()));
        const auto& triangle = mesh.triangles[at];
        const Vec3 normal = triangle_normal(p[triangle[0]], p[triangle[1]], p[triangle[2]]);
        const auto first = static_cast<std::uint32_t>(drawn.mesh.positions.size());
        for (const std::uint32_t corner : triangle) {
            drawn.mesh.positions.push_back(p[corner]);
            drawn.mesh.normals.push_back(drawn.flat ? normal : mesh.normals[corner]);
        }
        drawn.mesh.triangles.push_back({first, first + 1, first + 2});
        drawn.left_out.push_back(normal.isZero(0));
    }
    return drawn;
}

}  // namespace caustics::beamtree
