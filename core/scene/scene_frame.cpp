#include "core/scene/scene_frame.h"

#include <algorithm>

namespace caustics::scene_file {
namespace {

constexpr double near_enough = 8;

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
        transform(shape.mesh, to_frame);
        shape.to_world = Transform::Identity();
    } else {
        shape.to_world = to_frame;
    }
}

}  // namespace caustics::scene_file
