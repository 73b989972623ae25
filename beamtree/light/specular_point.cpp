#include "beamtree/light/specular_point.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "beamtree/light/beam_point.h"
#include "core/geometry/exact_shape.h"

namespace caustics::beamtree {
namespace {

constexpr int most_steps = 10;
// How near to the point a ray has to come, for the length of its way.
constexpr double tolerance = 1e-10;
// Of the lengths over which the surface changes: central differences err by its square.
constexpr double relative_step = 1e-5;

// Refractive index on the far side over that on the side of arrival.
double relative_index(const Bsdf& bsdf, bool from_front, float nm) {
    const auto& glass = std::get<Dielectric>(bsdf.model);
    const double ratio = glass.int_ior.at(nm) / glass.ext_ior.at(nm);
    return from_front ? ratio : 1 / ratio;
}

}  // namespace

/// The light that leaves a place of the surface.
struct SpecularSearch::Exit {
    Vec3d position;
    Vec3d normal;     ///< unit, front side
    Vec3d to_light;   ///< unit
    Vec3d direction;  ///< unit
    double distance;  ///< from the light; 1 where it is at no place

    bool from_front() const { return normal.dot(to_light) > 0; }
};

/// The plane across the guessed ray through the point, and the surface's tangent plane at the guess.
class SpecularSearch::Sheet {
public:
    Sheet(const Vec3d& point, const Vec3d& direction, const Vec3d& surface,
          const Vec3d& surface_normal)
        : point_(point), direction_(direction), surface_(surface) {
        across_ = axes(direction);
        along_ = axes(surface_normal);
    }

    const Vec3d& direction() const { return direction_; }
    /// In the shape's frame, beside the surface.
    Vec3d place(const Vec2d& at) const {
        return surface_ + at.x() * along_[0] + at.y() * along_[1];
    }
    Vec2d coordinates(const Vec3d& local) const {
        return {along_[0].dot(local - surface_), along_[1].dot(local - surface_)};
    }
    double way(const Vec3d& position, const Vec3d& direction) const {
        return direction_.dot(point_ - position) / direction_.dot(direction);
    }
    /// Where a ray meets the plane, from the point.
    Vec2d miss(const Vec3d& position, const Vec3d& direction) const {
        const Vec3d at = position + way(position, direction) * direction - point_;
        return {across_[0].dot(at), across_[1].dot(at)};
    }

private:
    static std::array<Vec3d, 2> axes(const Vec3d& n) {
        const Vec3d s = n.unitOrthogonal();
        return {s, n.cross(s)};
    }

    Vec3d point_;
    Vec3d direction_;
    Vec3d surface_;
    std::array<Vec3d, 2> across_;
    std::array<Vec3d, 2> along_;
};

/// By the two coordinates on the surface.
struct SpecularSearch::Derivatives {
    Eigen::Matrix2d miss;
    std::array<Vec3d, 2> position;
};

/// What becomes of a whole triangle.
struct SpecularSearch::Image {
    bool turned;   ///< over on its way
    double reach;  ///< its longest side, in the shape's frame
};

SpecularSearch::SpecularSearch(const Scene& scene, const BeamSet& set)
    : shape_(scene.shapes()[set.caster]),
      light_(set.light),
      bender_(scene, set.caster, set.light),
      event_(set.refracted ? refraction : reflection),
      to_local_(shape_.to_world.inverse()),
      step_(relative_step *
            ask_exact(shape_, [](const auto& kind) { return kind.feature_size(); })) {}

std::optional<SpecularSearch::Exit> SpecularSearch::exit_at(const Vec3d& local) const {
    const Vec3d on = exact_onto(shape_, local);
    Exit exit;
    exit.position = shape_.to_world * on;
    exit.normal = (to_local_.linear().transpose() * exact_normal(shape_, on)).normalized();
    if (shape_.flip_normals) exit.normal = -exit.normal;
    exit.to_light = -light_.travel.cast<double>();
    exit.distance = 1;
    if (light_.kind != LightSample::Kind::directional) {
        exit.to_light = light_.position.cast<double>() - exit.position;
        exit.distance = exit.to_light.norm();
    }
    exit.to_light.normalize();
    const Vec3d& w = exit.to_light;
    const Vec3d n = exit.from_front() ? exit.normal : Vec3d(-exit.normal);
    const double cosine = n.dot(w);
    if (event_ == reflection) {
        exit.direction = 2 * cosine * n - w;
        return exit;
    }
    const double eta = relative_index(shape_.bsdf, exit.from_front(), light_.bin.nm);
    const double inner = 1 - (1 - cosine * cosine) / (eta * eta);
    if (!(inner > 0)) return {};
    exit.direction = (cosine * n - w) / eta - std::sqrt(inner) * n;
    return exit;
}

std::optional<SpecularSearch::Derivatives> SpecularSearch::derivatives(const Sheet& sheet,
                                                                       const Vec2d& at) const {
    Derivatives found;
    for (int i = 0; i < 2; ++i) {
        const auto before = exit_at(sheet.place(at - step_ * Vec2d::Unit(i)));
        const auto after = exit_at(sheet.place(at + step_ * Vec2d::Unit(i)));
        if (!before || !after) return {};
        found.miss.col(i) = (sheet.miss(after->position, after->direction) -
                             sheet.miss(before->position, before->direction)) /
                            (2 * step_);
        found.position[static_cast<std::size_t>(i)] =
            (after->position - before->position) / (2 * step_);
    }
    return found;
}

SpecularPoint SpecularSearch::made(const Sheet& sheet, const Exit& exit,
                                   const Derivatives& found) const {
    const double area = std::abs(exit.to_light.dot(found.position[0].cross(found.position[1])));
    SpecularPoint point;
    point.position = exit.position.cast<float>();
    point.normal = exit.normal.cast<float>();
    point.direction = exit.direction.cast<float>();
    point.weight = bender_.at(point.position, point.normal).bent.weight[event_];
    // On the sheet, which the ray may come to at a slant.
    point.density = area / (exit.distance * exit.distance * std::abs(found.miss.determinant()) *
                            sheet.direction().dot(exit.direction));
    return point;
}

// How the triangle lies on the surface and arrives at the sheet, which its light has to come to.
std::optional<SpecularSearch::Image> SpecularSearch::image(
    const Sheet& sheet, const std::array<const VertexRay*, 3>& triangle) const {
    std::array<Vec2d, 3> from;
    std::array<Vec2d, 3> to;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3d position = triangle[i]->position.cast<double>();
        const Vec3d direction = triangle[i]->direction.cast<double>();
        if (!(sheet.direction().dot(direction) > 0)) return {};
        from[i] = sheet.coordinates(to_local_ * position);
        to[i] = sheet.miss(position, direction);
    }
    return Image{(cross(from[1] - from[0], from[2] - from[0]) > 0) !=
                     (cross(to[1] - to[0], to[2] - to[0]) > 0),
                 std::max({(from[1] - from[0]).norm(), (from[2] - from[1]).norm(),
                           (from[0] - from[2]).norm()})};
}

std::optional<SpecularPoint> SpecularSearch::find(const std::array<const VertexRay*, 3>& triangle,
                                                  const VertexRay& guess, const Vec3& point) const {
    const Vec3d beside = exact_onto(shape_, to_local_ * guess.position.cast<double>());
    const Sheet sheet(point.cast<double>(), guess.direction.cast<double>().normalized(), beside,
                      exact_normal(shape_, beside));
    const auto start = exit_at(beside);
    const auto whole = image(sheet, triangle);
    if (!start || !whole) return {};
    Vec2d at = Vec2d::Zero();
    for (int step = 0; step < most_steps && at.norm() <= whole->reach; ++step) {
        const auto exit = exit_at(sheet.place(at));
        if (!exit || exit->from_front() != start->from_front()) return {};
        const auto found = derivatives(sheet, at);
        if (!found) return {};
        const double way = sheet.way(exit->position, exit->direction);
        const Vec2d miss = sheet.miss(exit->position, exit->direction);
        if (miss.norm() <= tolerance * way) {
            if ((found->miss.determinant() < 0) != whole->turned) return {};
            return made(sheet, *exit, *found);
        }
        at -= found->miss.inverse() * miss;
    }
    return {};
}

}  // namespace caustics::beamtree
