#include "core/scene/scene_frame.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/mesh/exact_positions.h"

namespace caustics::scene_file {
namespace {

constexpr double near_enough = 8;

// How far rounding may turn triangles (rounding_turn()) [rad]. Light that flat facets bend is then good to 1 %. Smooth
// normals do not depend on positions, nor does light that is scattered depend much on them.
constexpr double most_turn_of_flat_casters = 2e-3;
constexpr double most_turn_of_smooth_casters = 2e-2;
constexpr double most_turn_of_receivers = 0.1;

double most_turn(const Shape& shape) {
    if (!is_caster(shape.bsdf)) return most_turn_of_receivers;
    return shape.mesh.normals.empty() ? most_turn_of_flat_casters : most_turn_of_smooth_casters;
}

void place_mesh(Shape& shape, const Transform& to_frame) {
    std::vector<Vec3d> exact;
    exact.reserve(shape.mesh.positions.size());
    for (std::size_t i = 0; i < shape.mesh.positions.size(); ++i)
        exact.emplace_back(to_frame * exact_position(shape.mesh, i));
    transform(shape.mesh, to_frame);
    shape.to_world = Transform::Identity();
    const double turn = rounding_turn(exact, shape.mesh);
    if (turn <= most_turn(shape)) return;
    double reach = 0;
    for (const Vec3d& p : exact) reach = std::max(reach, p.norm());
    throw InputError(fmt::format(
        "reaches {:.3g} m from the middle of the scene's casters, where floats are too coarse for "
        "its triangles: rounding turns them by {:.2g} degrees (bring it nearer, or make two scenes "
        "or two shapes of what lies far apart)",
        reach, turn * 180 / pi_d));
}

}  // namespace

Vec3d frame_origin(const std::vector<Shape>& shapes,
                   const std::vector<Eigen::AlignedBox3d>& boxes) {
    const bool any_caster =
        std::ranges::any_of(shapes, [](const Shape& shape) { return is_caster(shape.bsdf); });
    Vec3d sum = Vec3d::Zero();
    double weights = 0;
    bool is_near = true;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        if (any_caster && !is_caster(shapes[i].bsdf)) continue;
        const Eigen::AlignedBox3d& box = boxes[i];
        const double size = box.diagonal().norm();
        if (!(size > 0)) continue;
        is_near = is_near && box.center().norm() <= near_enough * size;
        sum += box.center() / (size * size);
        weights += 1 / (size * size);
    }
    return is_near ? Vec3d::Zero().eval() : Vec3d(sum / weights);
}

bool is_resolved(const Eigen::AlignedBox3d& box, const Vec3d& origin) {
    return box.diagonal().norm() > 1e-6 * (box.center() - origin).norm();
}

void place(Shape& shape, const Vec3d& origin) {
    const Transform to_frame = Eigen::Translation3d(-origin) * shape.to_world;
    if (shape.primitive == Primitive::mesh) {
        place_mesh(shape, to_frame);
    } else {
        shape.to_world = to_frame;
    }
}

}  // namespace caustics::scene_file
