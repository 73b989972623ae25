#include "core/geometry/exact_shape.h"

namespace caustics {

std::optional<ExactHit> intersect_exact(const Shape& shape, const Vec3d& o, const Vec3d& d,
                                        double t_min, double t_max) {
    if (shape.primitive == Primitive::mesh) return {};
    const RayInterval range{t_min, t_max};
    return ask_exact(shape, [&](const auto& kind) { return kind.intersect(o, d, range); });
}

bool exact_is_flat(const Shape& shape) {
    return shape.primitive != Primitive::mesh &&
           ask_exact(shape, [](const auto& kind) { return kind.is_flat; });
}

Vec3d exact_normal(const Shape& shape, const Vec3d& local) {
    return ask_exact(shape, [&](const auto& kind) { return kind.normal(local); });
}

Vec3d exact_onto(const Shape& shape, const Vec3d& local) {
    return ask_exact(shape, [&](const auto& kind) { return kind.onto(local); });
}

Vec3d exact_onto_change(const Shape& shape, const Vec3d& local, const Vec3d& way) {
    return ask_exact(shape, [&](const auto& kind) { return kind.onto_change(local, way); });
}

Vec3d exact_normal_change(const Shape& shape, const Vec3d& on, const Vec3d& way) {
    return ask_exact(shape, [&](const auto& kind) { return kind.normal_change(on, way); });
}

Vec2 exact_uv(const Shape& shape, const Vec3d& local) {
    return ask_exact(shape, [&](const auto& kind) { return kind.uv(local); }).cast<float>();
}

double exact_area_element(const Shape& shape, const Vec2d& uv) {
    const auto [du, dv] = ask_exact(shape, [&](const auto& kind) { return kind.tangents(uv); });
    return (shape.to_world.linear() * du).cross(shape.to_world.linear() * dv).norm();
}

}  // namespace caustics
