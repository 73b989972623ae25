#include "core/mesh/triangle_middles.h"

namespace caustics {

std::vector<TriangleMiddle> triangle_middles(const TriangleMesh& mesh, std::size_t most) {
    std::vector<TriangleMiddle> middles;
    const std::size_t stride = 1 + mesh.triangles.size() / most;
    for (std::size_t i = 0; i < mesh.triangles.size(); i += stride) {
        const auto& [a, b, c] = mesh.triangles[i];
        const Vec3 &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
        const Vec3 normal = (q - p).cross(r - p).stableNormalized();
        if (!normal.isZero(0)) middles.push_back({(p + q + r) / 3, normal});
    }
    return middles;
}

}  // namespace caustics
