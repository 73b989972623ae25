#include "beamtree/pencils/light_patch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "core/math/frame.h"

namespace caustics::beamtree {
namespace {

using Corners = std::array<Vec3d, 8>;

// Cosine of the angle up to which a caster's corners lie round the direction to its middle: else the light is near.
constexpr double widest_cosine = 0.5;
// The least cosine of a spot's half angle with which its rays go through one rectangle.
constexpr double widest_cosine_of_spot = 0.4;
// Rounding of floats, over the patch.
constexpr double slack = 1e-5;
constexpr int turns = 8;
// Along each side of a patch, where its light is looked at.
constexpr int places = 8;

Corners box_corners(const Box& box) {
    Corners corners;
    for (int i = 0; i < 8; ++i)
        corners[static_cast<std::size_t>(i)] =
            box.corner(static_cast<Box::CornerType>(i)).cast<double>();
    return corners;
}

/// A rectangle along two unit directions of a plane.
struct Rectangle {
    std::array<Vec3d, 2> axes;
    Vec2d low = Vec2d::Constant(std::numeric_limits<double>::infinity());
    Vec2d high = -low;

    void add(const Vec2d& point) {
        low = low.cwiseMin(point);
        high = high.cwiseMax(point);
    }
    Vec2d size() const { return high - low; }
    double area() const { return size().prod(); }
};

// The smallest of several turns about the plane's normal that holds the points.
Rectangle smallest_round(const std::array<Vec3d, 8>& points, const Vec3d& normal) {
    const Frame frame(normal.cast<float>());
    const Vec3d s =
        (frame.s.cast<double>() - normal.dot(frame.s.cast<double>()) * normal).normalized();
    const Vec3d t = normal.cross(s);
    std::optional<Rectangle> best;
    for (int i = 0; i < turns; ++i) {
        const double angle = i * std::numbers::pi / (2 * turns);
        Rectangle turned{.axes = {std::cos(angle) * s + std::sin(angle) * t,
                                  std::cos(angle) * t - std::sin(angle) * s}};
        for (const Vec3d& point : points)
            turned.add({turned.axes[0].dot(point), turned.axes[1].dot(point)});
        if (!best || turned.area() < best->area()) best = turned;
    }
    const Vec2d margin = slack * (best->size() + Vec2d::Constant(best->size().maxCoeff()));
    best->low -= margin;
    best->high += margin;
    return *best;
}

// The corners on the plane across an axis at a distance of 1; empty where one lies far off the axis.
std::optional<Corners> seen_round(const Vec3d& from, const Vec3d& axis, const Corners& corners) {
    if (!axis.allFinite()) return {};
    Corners seen;
    for (std::size_t i = 0; i < 8; ++i) {
        const Vec3d way = corners[i] - from;
        if (!(axis.dot(way) > widest_cosine * way.norm())) return {};
        seen[i] = way / axis.dot(way);
    }
    return seen;
}

class Patches {
public:
    Patches(const Scene& scene, std::span<const LightSample> lights)
        : scene_(scene), lights_(lights) {}

    std::vector<LightPatch> find() {
        for (std::uint32_t light = 0; light < lights_.size(); ++light)
            for (const std::uint32_t caster : scene_.casters()) add(light, caster);
        return std::move(patches_);
    }

private:
    void add(std::uint32_t light, std::uint32_t caster) {
        const LightSample& sample = lights_[light];
        const Corners corners = box_corners(bounds(scene_.shapes()[caster]));
        if (sample.kind == LightSample::Kind::directional) {
            const Vec3d along = sample.travel.cast<double>().normalized();
            push(light, caster, smallest_round(corners, along), along.dot(corners[0]) * along);
            return;
        }
        const Vec3d from = sample.position.cast<double>();
        if (sample.spot &&
            std::cos(static_cast<double>(sample.spot->cutoff)) > widest_cosine_of_spot) {
            add_spot(light, caster, from, corners);
            return;
        }
        const Vec3d axis = ((corners[0] + corners[7]) / 2 - from).normalized();
        if (const auto seen = seen_round(from, axis, corners))
            push(light, caster, smallest_round(*seen, axis), from + axis);
        else
            add_faces(light, caster, from, corners);
    }

    // Takes the part of the rectangle round the caster that a spot's cone reaches.
    void add_spot(std::uint32_t light, std::uint32_t caster, const Vec3d& from,
                  const Corners& corners) {
        const SpotCone& spot = *lights_[light].spot;
        const Vec3d axis = spot.axis.cast<double>().normalized();
        const double reach = (1 + slack) * std::tan(static_cast<double>(spot.cutoff));
        const Frame frame(axis.cast<float>());
        const Vec3d s =
            (frame.s.cast<double>() - axis.dot(frame.s.cast<double>()) * axis).normalized();
        Rectangle rectangle{{s, axis.cross(s)}, Vec2d::Constant(-reach), Vec2d::Constant(reach)};
        if (const auto seen = seen_round(from, axis, corners)) {
            Rectangle round{rectangle.axes};
            for (const Vec3d& point : *seen)
                round.add({round.axes[0].dot(point), round.axes[1].dot(point)});
            const Vec2d margin = Vec2d::Constant(slack * round.size().maxCoeff());
            rectangle.low = rectangle.low.cwiseMax(round.low - margin);
            rectangle.high = rectangle.high.cwiseMin(round.high + margin);
            if (!(rectangle.size().array() > 0).all()) return;
        }
        push(light, caster, rectangle, from + axis);
    }

    // Takes those faces of a cube round the light that see something of the caster's box.
    void add_faces(std::uint32_t light, std::uint32_t caster, const Vec3d& from,
                   const Corners& corners) {
        for (int face = 0; face < 6; ++face) {
            const Vec3d axis = (face % 2 == 0 ? 1 : -1) * Vec3d::Unit(face / 2);
            const Vec3d s = Vec3d::Unit((face / 2 + 1) % 3);
            const Vec3d t = axis.cross(s);
            const auto all_beyond = [&](const Vec3d& side) {
                return std::ranges::all_of(corners, [&](const Vec3d& corner) {
                    return (axis - side).dot(corner - from) < 0;
                });
            };
            if (all_beyond(s) || all_beyond(-s) || all_beyond(t) || all_beyond(-t) ||
                all_beyond(Vec3d::Zero()))
                continue;
            push(light, caster, {{s, t}, Vec2d::Constant(-1), Vec2d::Constant(1)}, from + axis);
        }
    }

    // `origin` is the point of the rectangle's plane that its coordinates begin at.
    void push(std::uint32_t light, std::uint32_t caster, const Rectangle& rectangle,
              const Vec3d& origin) {
        const auto& [s, t] = rectangle.axes;
        LightPatch patch{.light = light,
                         .caster = caster,
                         .corner = origin + rectangle.low.x() * s + rectangle.low.y() * t,
                         .sides = {rectangle.size().x() * s, rectangle.size().y() * t}};
        for (int i = 0; i < places; ++i)
            for (int j = 0; j < places; ++j) {
                const PatchRay ray =
                    ray_through(lights_[light], patch,
                                patch.corner + (i + 0.5) / places * patch.sides[0] +
                                    (j + 0.5) / places * patch.sides[1]);
                const Spectrum strength =
                    strength_along(lights_[light], -ray.direction.cast<float>());
                patch.watts += static_cast<double>(strength.mean()) * ray.measure *
                               rectangle.area() / (places * places);
            }
        if (patch.watts > 0) patches_.push_back(patch);
    }

    const Scene& scene_;
    std::span<const LightSample> lights_;
    std::vector<LightPatch> patches_;
};

}  // namespace

PatchRay ray_through(const LightSample& light, const LightPatch& patch, const Vec3d& point) {
    if (light.kind == LightSample::Kind::directional)
        return {light.travel.cast<double>().normalized(), 1};
    const Vec3d way = point - light.position.cast<double>();
    const double distance = way.norm();
    const Vec3d across = patch.sides[0].cross(patch.sides[1]).normalized();
    return {way / distance, std::abs(across.dot(way)) / (distance * distance * distance)};
}

std::vector<LightPatch> light_patches(const Scene& scene, std::span<const LightSample> lights) {
    return Patches(scene, lights).find();
}

}  // namespace caustics::beamtree
