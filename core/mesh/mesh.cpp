#include "core/mesh/mesh.h"

#include <cmath>
#include <utility>

#include "core/base/error.h"

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

void turn_triangles(TriangleMesh& mesh) {
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
}

}  // namespace

void flip(TriangleMesh& mesh) {
    turn_triangles(mesh);
    for (Vec3& normal : mesh.normals) normal = -normal;
}

void transform(TriangleMesh& mesh, const Transform& to_world) {
    const Eigen::Matrix3d linear = to_world.linear();
    const double determinant = linear.determinant();
    if (determinant == 0 || !to_world.matrix().allFinite())
        throw InputError("the transform of a mesh must be finite and invertible");
    const Eigen::Matrix3d to_normal = std::copysign(1.0, determinant) * cofactors(linear);
    for (Vec3& position : mesh.positions) {
        const Vec3d moved = to_world * position.cast<double>();
        position = moved.cast<float>();
    }
    for (Vec3& normal : mesh.normals) {
        const Vec3d turned = to_normal * normal.cast<double>();
        // stableNormalized: cofactors are squares of scales, whose squares may leave double.
        normal = turned.stableNormalized().cast<float>();
    }
    if (determinant < 0) turn_triangles(mesh);
}

}  // namespace caustics
