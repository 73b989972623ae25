#include <cmath>

#include "experiments/gallery/parts.h"

namespace caustics::experiments {

using namespace gallery_parts;

namespace {

// A point light under a horizontal mirror shines on the floor from its image S' = (0, 0, 3):
//   E = I cos / d^2 = I 3 / (r^2 + 9)^(3/2).
GalleryScene plane_mirror() {
    static constexpr double intensity = 4;
    GalleryScene scene{"plane_mirror", "image of the light", {}, {}, {}};
    scene.make = [](int) {
        SceneDesc desc;
        desc.shapes = {square("floor", 0, 4, true, grey()),
                       square("mirror", 2, 1.5, false, mirror())};
        desc.lights = {point_light({0, 0, 1}, intensity)};
        return desc;
    };
    for (const Vec2d& p : spread(asked, {0, 0}, 1.5))
        scene.points.push_back({{p.x(), p.y(), 0},
                                Vec3d::UnitZ(),
                                Vec3d::Zero(),
                                intensity * 3 / std::pow(p.squaredNorm() + 9, 1.5)});
    scene.series = usual_series(0.1, 2, 0.05);
    scene.series.push_back({"illuminationmap",
                            {{0, {"emitted=20000", "resolution=16"}},
                             {0, {"emitted=320000", "resolution=32"}},
                             {0, {"emitted=5120000", "resolution=64"}}},
                            2,
                            0.03,
                            0,
                            {}});
    return scene;
}

// The paraboloid z = rho^2 / (4 f) sends light that falls along its axis to the focus (0, 0, f): the
// ray at rho meets the plane z = h at radius rho (f - h) / (f - z). A ring of it, so that the
// receiver, which faces down, is in no ray's way.
GalleryScene parabolic_mirror() {
    static constexpr double f = 1, h = 0.7, inner = 0.6, outer = 1, irradiance = 2;
    GalleryScene scene{"parabolic_mirror", "every ray through the focus", {}, {}, {}};
    scene.make = [](int n) {
        const auto profile = [](double t) {
            const double rho = inner + t * (outer - inner);
            return ProfilePoint{rho, rho * rho / (4 * f), Vec2d(-rho / (2 * f), 1).normalized()};
        };
        SceneDesc desc;
        desc.shapes = {disk_facing_down("screen", h, 0.5, grey()),
                       mesh("mirror", turned(profile, n), mirror())};
        desc.lights = {directional_light(-Vec3d::UnitZ(), irradiance)};
        return desc;
    };
    const Meridian light{
        [](double rho) { return Landing{rho * (f - h) / (f - rho * rho / (4 * f)), 1}; },
        [](double rho) { return irradiance * 2 * pi_d * rho; }, inner, outer};
    scene.points = known_on_ring(light, h, false, 0.25, 0.35);
    scene.series = usual_series(0.01, 2, 0.02);
    return scene;
}

// A belt of a spheroid with half axes a (along z) and b sends the light from one focus (0, 0, -c) to
// the other. Its point at the angle u from the axis is s = a (1 - e^2) / (1 - e cos u) away, e = c / a;
// beyond the second focus the light spreads again.
GalleryScene elliptic_mirror() {
    static constexpr double a = 1, c = 0.6, e = c / a, h = 1.3, intensity = 3;
    static constexpr double lowest = -0.2, highest = 0.4;
    const double b = std::sqrt(a * a - c * c);
    GalleryScene scene{"elliptic_mirror", "from focus to focus", {}, {}, {}};
    scene.make = [b](int n) {
        const auto profile = [b](double t) {
            const double z = lowest + t * (highest - lowest);
            const double rho = b * std::sqrt(1 - z * z / (a * a));
            return ProfilePoint{rho, z, -Vec2d(rho / (b * b), z / (a * a)).normalized()};
        };
        SceneDesc desc;
        desc.shapes = {square("screen", h, 3, false, grey()),
                       mesh("mirror", turned(profile, n), mirror())};
        desc.lights = {point_light({0, 0, -c}, intensity)};
        return desc;
    };
    const auto land = [](double u) {
        const double s = a * (1 - e * e) / (1 - e * std::cos(u));
        const Vec2d at(s * std::sin(u), s * std::cos(u) - c);
        return Landing{-at.x() * (h - c) / (c - at.y()), 1};
    };
    const auto angle_of = [b](double z) {
        return std::atan2(b * std::sqrt(1 - z * z / (a * a)), z + c);
    };
    const Meridian light{land, [](double u) { return intensity * 2 * pi_d * std::sin(u); },
                         angle_of(highest), angle_of(lowest)};
    scene.points = known_on_ring(light, h, false, 0.9, 1.8);
    scene.series = usual_series(0.12, 2, 0.03);
    return scene;
}

// Sunlight (cos e, 0, -sin e) on the inside of an upright cylinder of radius 1. From the place at the
// angle u and the height z it runs on in the horizontal direction d = -(cos 2u, sin 2u) for
// s = z / tan e. A patch du dz takes E0 cos e cos u du dz, and lands on |dp/du x dp/dz| du dz:
//   E = E0 sin e cos u / |dp/du x d|,  dp/du = (-sin u, cos u) + 2 s (sin 2u, -cos 2u).
GalleryScene circular_mirror() {
    const double elevation = pi_d / 3;
    static constexpr double irradiance = 2, height = 0.5;
    GalleryScene scene{"circular_mirror", "rays in a ring", {}, {}, {}};
    scene.make = [elevation](int) {
        Shape ring;
        ring.name = "ring";
        ring.primitive = Primitive::cylinder;
        ring.to_world = Transform(Eigen::Scaling(1.0, 1.0, height));
        ring.bsdf = mirror();
        SceneDesc desc;
        desc.shapes = {square("floor", 0, 2, true, grey()), ring};
        desc.lights = {
            directional_light({std::cos(elevation), 0, -std::sin(elevation)}, irradiance)};
        return desc;
    };
    // Near the wall, where z stays below the ring's height and there is one such place: (u, s) by
    // Newton's method.
    for (const Vec2d& p : spread(asked, {0.87, 0}, 0.06)) {
        double u = std::atan2(p.y(), p.x()), s = 1 - p.norm();
        Vec2d along, d;
        for (int round = 0; round < 30; ++round) {
            d = -Vec2d(std::cos(2 * u), std::sin(2 * u));
            along =
                Vec2d(-std::sin(u), std::cos(u)) + 2 * s * Vec2d(std::sin(2 * u), -std::cos(2 * u));
            const Vec2d miss = Vec2d(std::cos(u), std::sin(u)) + s * d - p;
            const Vec2d better =
                Eigen::Matrix2d{{along.x(), d.x()}, {along.y(), d.y()}}.inverse() * miss;
            u -= better.x();
            s -= better.y();
        }
        const double area = std::abs(along.x() * d.y() - along.y() * d.x());
        scene.points.push_back({{p.x(), p.y(), 0},
                                Vec3d::UnitZ(),
                                Vec3d::Zero(),
                                irradiance * std::sin(elevation) * std::cos(u) / area});
    }
    scene.series = usual_series(0.025, 2, 0.03);
    for (Series& each : scene.series)
        for (Effort& effort : each.efforts) effort.parameters.emplace_back("max_bounces=1");
    return scene;
}

}  // namespace

std::vector<GalleryScene> mirrors() {
    return {plane_mirror(), parabolic_mirror(), elliptic_mirror(), circular_mirror()};
}

}  // namespace caustics::experiments
