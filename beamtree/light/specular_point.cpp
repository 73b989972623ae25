#include "beamtree/light/specular_point.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "beamtree/light/beam_point.h"

namespace caustics::beamtree {
namespace {

constexpr int most_steps = 10;
// How near to the point a ray has to come, for the length of its way.
constexpr double tolerance = 1e-10;
// What rounding leaves of a place in double, for its distance from the origin.
constexpr double place_rounding = 4 * std::numeric_limits<double>::epsilon();

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
    double eta = 1;   ///< relative refractive index, of refraction

    bool from_front() const { return normal.dot(to_light) > 0; }
};

/// The plane across the guessed ray through the point, and the surface's tangent plane at the guess.
class SpecularSearch::Sheet {
public:
    Sheet(const Vec3d& point, const Vec3d& direction, const SpecularSurface& surface,
          const Vec3d& beside)
        : point_(point), direction_(direction), surface_(surface), beside_(beside) {
        across_ = axes(direction);
        along_ = axes(surface.across(beside));
    }

    const Vec3d& direction() const { return direction_; }
    const SpecularSurface& surface() const { return surface_; }
    /// Two axes of the surface's frame.
    const std::array<Vec3d, 2>& along() const { return along_; }
    /// In the surface's frame, beside it.
    Vec3d place(const Vec2d& at) const { return beside_ + at.x() * along_[0] + at.y() * along_[1]; }
    Vec2d coordinates(const Vec3d& local) const {
        return {along_[0].dot(local - beside_), along_[1].dot(local - beside_)};
    }
    double way(const Vec3d& position, const Vec3d& direction) const {
        return direction_.dot(point_ - position) / direction_.dot(direction);
    }
    /// Where a ray meets the plane, from the point.
    Vec2d miss(const Vec3d& position, const Vec3d& direction) const {
        return on_plane(position + way(position, direction) * direction - point_);
    }
    /// How that place moves with the ray.
    Vec2d miss_change(const Exit& exit, const Vec3d& by_position, const Vec3d& by_direction) const {
        const Vec3d moved = by_position + way(exit.position, exit.direction) * by_direction;
        return on_plane(moved -
                        direction_.dot(moved) / direction_.dot(exit.direction) * exit.direction);
    }

private:
    static std::array<Vec3d, 2> axes(const Vec3d& n) {
        const Vec3d s = n.unitOrthogonal();
        return {s, n.cross(s)};
    }
    Vec2d on_plane(const Vec3d& at) const { return {across_[0].dot(at), across_[1].dot(at)}; }

    Vec3d point_;
    Vec3d direction_;
    const SpecularSurface& surface_;
    Vec3d beside_;
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
    double reach;  ///< its longest side, in the surface's frame
};

SpecularSearch::SpecularSearch(const Scene& scene, const BeamSet& set)
    : set_(set),
      light_(set.light),
      shape_(scene.shapes()[set.caster]),
      bender_(scene, set.caster, set.light),
      event_(set.refracted ? refraction : reflection) {
    if (shape_.primitive != Primitive::mesh) exact_.emplace(shape_);
}

std::optional<SpecularSearch::Exit> SpecularSearch::exit_at(const SpecularSurface& surface,
                                                            const Vec3d& local) const {
    const Vec3d on = surface.onto(local);
    Exit exit;
    exit.position = surface.world(on);
    exit.normal = surface.normal(on);
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
    exit.eta = relative_index(shape_.bsdf, exit.from_front(), light_.bin.nm);
    const double inner = 1 - (1 - cosine * cosine) / (exit.eta * exit.eta);
    if (!(inner > 0)) return {};
    exit.direction = (cosine * n - w) / exit.eta - std::sqrt(inner) * n;
    return exit;
}

// The laws of reflection and of refraction, differentiated: a light may be much nearer to the
// surface than any step over which differences of directions would be taken.
Vec3d SpecularSearch::direction_change(const Exit& exit, const Vec3d& by_position,
                                       const Vec3d& by_normal) const {
    const Vec3d& w = exit.to_light;
    Vec3d by_light = Vec3d::Zero();
    if (light_.kind != LightSample::Kind::directional)
        by_light = (w.dot(by_position) * w - by_position) / exit.distance;
    const double side = exit.from_front() ? 1 : -1;
    const Vec3d n = side * exit.normal;
    const Vec3d by_n = side * by_normal;
    const double cosine = n.dot(w);
    const double by_cosine = by_n.dot(w) + n.dot(by_light);
    if (event_ == reflection) return 2 * (by_cosine * n + cosine * by_n) - by_light;
    const double eta = exit.eta;
    const double inner = std::sqrt(1 - (1 - cosine * cosine) / (eta * eta));
    const double by_inner = cosine * by_cosine / (eta * eta * inner);
    return (by_cosine * n + cosine * by_n - by_light) / eta - by_inner * n - inner * by_n;
}

SpecularSearch::Derivatives SpecularSearch::derivatives(const Sheet& sheet, const Vec3d& local,
                                                        const Exit& exit) const {
    const SpecularSurface::Tangents by = sheet.surface().tangents(local, sheet.along());
    Derivatives found;
    found.position = by.position;
    for (std::size_t i = 0; i < 2; ++i)
        found.miss.col(static_cast<Eigen::Index>(i)) = sheet.miss_change(
            exit, by.position[i], direction_change(exit, by.position[i], by.normal[i]));
    return found;
}

// What rounding of the surface's place may make of the miss.
double SpecularSearch::miss_rounding(const Vec3d& local, const Exit& exit,
                                     const Derivatives& found) const {
    const double scale = std::max(found.position[0].norm(), found.position[1].norm());
    return place_rounding * (local.norm() + exit.position.norm() / scale) * found.miss.norm();
}

SpecularPoint SpecularSearch::made(const Sheet& sheet, const Exit& exit,
                                   const Derivatives& found) const {
    const double area = std::abs(exit.to_light.dot(found.position[0].cross(found.position[1])));
    SpecularPoint point;
    point.position = exit.position.cast<float>();
    point.normal = exit.normal.cast<float>();
    point.direction = exit.direction.cast<float>();
    // A light may be so near that the place in float does not tell where it lies.
    const float distance = light_.kind == LightSample::Kind::directional
                               ? distance_from(light_, point.position)
                               : static_cast<float>(exit.distance);
    point.weight =
        bender_.along(point.normal, exit.to_light.cast<float>(), distance).weight[event_];
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
        from[i] = sheet.coordinates(sheet.surface().local(position));
        to[i] = sheet.miss(position, direction);
    }
    return Image{(cross(from[1] - from[0], from[2] - from[0]) > 0) !=
                     (cross(to[1] - to[0], to[2] - to[0]) > 0),
                 std::max({(from[1] - from[0]).norm(), (from[2] - from[1]).norm(),
                           (from[0] - from[2]).norm()})};
}

std::optional<SpecularPoint> SpecularSearch::find(const SpecularSurface& surface,
                                                  const std::array<const VertexRay*, 3>& triangle,
                                                  const VertexRay& guess, const Vec3& point) const {
    const Vec3d beside = surface.onto(surface.local(guess.position.cast<double>()));
    const Sheet sheet(point.cast<double>(), guess.direction.cast<double>().normalized(), surface,
                      beside);
    const auto start = exit_at(surface, beside);
    const auto whole = image(sheet, triangle);
    if (!start || !whole) return {};
    Vec2d at = Vec2d::Zero();
    for (int step = 0; step < most_steps && at.norm() <= whole->reach; ++step) {
        const Vec3d local = sheet.place(at);
        const auto exit = exit_at(surface, local);
        if (!exit || exit->from_front() != start->from_front()) return {};
        const Derivatives found = derivatives(sheet, local, *exit);
        const double way = sheet.way(exit->position, exit->direction);
        const Vec2d miss = sheet.miss(exit->position, exit->direction);
        if (miss.norm() <= tolerance * way + miss_rounding(local, *exit, found)) {
            if ((found.miss.determinant() < 0) != whole->turned) return {};
            return made(sheet, *exit, found);
        }
        at -= found.miss.inverse() * miss;
    }
    return {};
}

std::optional<SpecularPoint> SpecularSearch::find(const Beam& beam, std::size_t triangle,
                                                  const VertexRay& guess, const Vec3& point) const {
    const std::array<const VertexRay*, 3> rays = set_.triangle(beam, triangle);
    if (exact_) return find(*exact_, rays, guess, point);
    const auto facet = SpecularSurface::facet(shape_.mesh, beam.mesh_triangle(triangle));
    if (!facet) return {};
    return find(*facet, rays, guess, point);
}

}  // namespace caustics::beamtree
