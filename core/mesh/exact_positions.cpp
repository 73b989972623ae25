#include "core/mesh/exact_positions.h"

#include <cmath>

namespace caustics {
namespace {

constexpr double sizes_from_origin = 2;   // of the mesh's size, from its origin
constexpr double negligible_turn = 1e-4;  // [rad]
constexpr double right_angle = pi_d / 2;

Vec3d doubled_area(const Vec3d& a, const Vec3d& b, const Vec3d& c) { return (b - a).cross(c - a); }

bool is_near_origin(const Eigen::AlignedBox3d& box) {
    const double reach = box.max().cwiseAbs().cwiseMax(box.min().cwiseAbs()).maxCoeff();
    return reach <= sizes_from_origin * box.diagonal().norm();
}

}  // namespace

Eigen::AlignedBox3d exact_bounds(const TriangleMesh& mesh) {
    Eigen::AlignedBox3d box;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) box.extend(exact_position(mesh, i));
    return box;
}

double rounding_turn(const std::vector<Vec3d>& exact, const TriangleMesh& mesh) {
    double sum = 0;
    double area = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3d n = doubled_area(exact[a], exact[b], exact[c]);
        const Vec3d r =
            doubled_area(mesh.positions[a].cast<double>(), mesh.positions[b].cast<double>(),
                         mesh.positions[c].cast<double>());
        const double weight = n.norm();
        const double turn = r.isZero(0) ? right_angle : std::atan2(n.cross(r).norm(), n.dot(r));
        sum += weight * turn * turn;
        area += weight;
    }
    return area > 0 ? std::sqrt(sum / area) : 0;
}

void set_positions(TriangleMesh& mesh, std::vector<Vec3d> exact) {
    mesh.positions.clear();
    mesh.positions.reserve(exact.size());
    bool rounds = false;
    Eigen::AlignedBox3d box;
    for (const Vec3d& p : exact) {
        mesh.positions.emplace_back(p.cast<float>());
        rounds = rounds || mesh.positions.back().cast<double>() != p;
        box.extend(p);
    }
    const bool keeps =
        rounds && (!is_near_origin(box) || rounding_turn(exact, mesh) > negligible_turn);
    mesh.exact_positions = keeps ? std::move(exact) : std::vector<Vec3d>();
}

}  // namespace caustics
