#include "beamtree/beams/caster_sample.h"

#include "core/geometry/tessellate.h"

namespace caustics::beamtree {

CasterMesh draw_polygons(const CasterMesh& caster, std::size_t count, Rng& rng) {
    CasterMesh drawn;
    drawn.shape = caster.shape;
    drawn.tessellated = caster.tessellated;
    drawn.flat = caster.mesh.normals.empty();
    const std::vector<Vec3>& p = caster.mesh.positions;
    for (std::size_t i = 0; i < count; ++i) {
        const auto at = static_cast<std::size_t>(rng.next_fine() *
                                                 static_cast<double>(caster.mesh.triangles.size()));
        const auto& triangle = caster.mesh.triangles[at];
        const Vec3 normal = triangle_normal(p[triangle[0]], p[triangle[1]], p[triangle[2]]);
        const auto first = static_cast<std::uint32_t>(drawn.mesh.positions.size());
        for (const std::uint32_t corner : triangle) {
            drawn.mesh.positions.push_back(p[corner]);
            drawn.mesh.normals.push_back(drawn.flat ? normal : caster.mesh.normals[corner]);
        }
        drawn.mesh.triangles.push_back({first, first + 1, first + 2});
        drawn.left_out.push_back(normal.isZero(0));
    }
    return drawn;
}

CasterMesh undivided_caster(const Scene& scene, std::uint32_t shape, int resolution) {
    CasterMesh caster;
    caster.shape = shape;
    caster.tessellated = scene.shapes()[shape].primitive != Primitive::mesh;
    caster.mesh = caster.tessellated ? tessellate_shape(scene.shapes()[shape], resolution)
                                     : scene.shapes()[shape].mesh;
    return caster;
}

}  // namespace caustics::beamtree
