#include "core/mesh/mesh.h"

#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/base/interrupt.h"

namespace caustics {
namespace {

// The matrix of cofactors is det(A) times the inverse transpose: normals keep only its direction,
// and no inverse has to be formed.
Eigen::Matrix3d cofactors(const Eigen::Matrix3d& a) {
    Eigen::Matrix3d c;
    c.col(0) = a.col(1).cross(a.col(2));
    c.col(1) = a.col(2).cross(a.col(0));
    c.col(2) = a.col(0).cross(a.col(1));
    return c;
}

// Calls `visit` with each item; throws Interrupted between two of them when somebody asked.
template <typename Item, typename Visit>
void visit_all(std::vector<Item>& items, const Visit& visit) {
    constexpr std::size_t items_between_looks = 1 << 16;
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (i % items_between_looks == 0) throw_if_interrupted();
        visit(items[i]);
    }
}

void turn_triangles(TriangleMesh& mesh) {
    visit_all(mesh.triangles, [](auto& triangle) { std::swap(triangle[1], triangle[2]); });
}

}  // namespace

void flip(TriangleMesh& mesh) {
    turn_triangles(mesh);
    visit_all(mesh.normals, [](Vec3& normal) { normal = -normal; });
}

void transform(TriangleMesh& mesh, const Transform& to_world) {
    const Eigen::Matrix3d linear = to_world.linear();
    const double determinant = linear.determinant();
    if (determinant == 0 || !to_world.matrix().allFinite())
        throw InputError("the transform of a mesh must be finite and invertible");
    const Eigen::Matrix3d to_normal = std::copysign(1.0, determinant) * cofactors(linear);
    for (std::size_t i = 0; i < mesh.exact_positions.size(); ++i)
        mesh.positions[i] = Vec3d(to_world * mesh.exact_positions[i]).cast<float>();
    if (mesh.exact_positions.empty())
        visit_all(mesh.positions, [&](Vec3& position) {
            const Vec3d moved = to_world * position.cast<double>();
            position = moved.cast<float>();
        });
    mesh.exact_positions = {};
    visit_all(mesh.normals, [&](Vec3& normal) {
        const Vec3d turned = to_normal * normal.cast<double>();
        // stableNormalized: cofactors are squares of scales, whose squares may leave double.
        normal = turned.stableNormalized().cast<float>();
    });
    if (determinant < 0) turn_triangles(mesh);
}

}  // namespace caustics
