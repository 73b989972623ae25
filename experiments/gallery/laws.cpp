#include <fmt/format.h>

#include <cmath>

#include "experiments/gallery/parts.h"

namespace caustics::experiments {

using namespace gallery_parts;

namespace {

// A lossless ball in a room whose walls all emit L: radiance is L along every ray, through the ball as
// well, so that a wall point is lit through it by pi L times the ball's form factor,
//   F = (R / d)^2 cos,
// with the distance d to its centre and the cosine there [Howell, catalogue of configuration factors,
// B-13]. The walls must not be hidden from each other by anything black, so the walls are asked.
GalleryScene furnace() {
    static constexpr double half = 2, radius = 0.8, radiance = 1;
    GalleryScene scene{"furnace", "radiance L everywhere: pi L F", {}, {}, {}};
    scene.make = [](int) {
        SceneDesc desc;
        for (int axis = 0; axis < 3; ++axis)
            for (const double side : {-1.0, 1.0}) {
                const Vec3d centre = side * half * Vec3d::Unit(axis);
                const Vec3d u = half * Vec3d::Unit((axis + 1) % 3);
                const Vec3d v = -side * half * Vec3d::Unit((axis + 2) % 3);
                desc.shapes.push_back(
                    rectangle(fmt::format("wall{}", desc.shapes.size()), centre, u, v, grey()));
                desc.shapes.back().radiance =
                    Spectrum(Spectrum::Constant(static_cast<float>(radiance)));
            }
        Shape ball;
        ball.name = "ball";
        ball.primitive = Primitive::sphere;
        ball.to_world = Transform(Eigen::Scaling(radius));
        ball.bsdf = glass(1.5);
        desc.shapes.push_back(ball);
        return desc;
    };
    for (const Vec2d& p : spread(4 * asked, {0, 0}, 1.2)) {
        const Vec3d at(p.x(), p.y(), -half);
        const double d = at.norm();
        scene.points.push_back({at, Vec3d::UnitZ(), Vec3d::Zero(),
                                pi_d * radiance * radius * radius / (d * d) * half / d});
    }
    // Light of lamps with area scatters more than that of points, even where its paths are spread evenly.
    scene.series = {path_trace(0.05, 100), light_trace(0.25, 0.05),
                    photon_map(0.08, {}, 20'000, 30)};
    for (Series& each : scene.series)
        for (Effort& effort : each.efforts) effort.parameters.emplace_back("max_bounces=100");
    return scene;
}

// [J96 (5)] and [J96 (6)] with t = n.h, in double.
double schlick(double alpha, const Vec3d& n, const Vec3d& wo, const Vec3d& wi) {
    const double v = n.dot(wo), v_in = n.dot(wi), t = n.dot((wo + wi).normalized());
    const double z = alpha / std::pow(1 + alpha * t * t - t * t, 2);
    const double g = v / (alpha - alpha * v + v) * (v_in / (alpha - alpha * v_in + v_in));
    return (1 - g) / pi_d + g * z / (4 * pi_d * v * v_in);
}

// A floor of Schlick's reflection under a plane mirror and a point light: what leaves towards a viewer
// is f_r(wo, wi) E, light coming from the image of the light.
GalleryScene schlick_floor() {
    static constexpr double intensity = 4, reflectance = 0.6;
    constexpr float alpha = 0.3F;
    GalleryScene scene{"schlick", "f_r(wo, wi) E in a plane mirror", {}, {}, {}};
    scene.make = [](int) {
        const Bsdf bsdf{
            Schlick{Spectrum(Spectrum::Constant(static_cast<float>(reflectance))), alpha}, false};
        SceneDesc desc;
        desc.shapes = {square("floor", 0, 4, true, bsdf),
                       square("mirror", 2, 1.5, false, mirror())};
        desc.lights = {point_light({0, 0, 1}, intensity)};
        return desc;
    };
    int i = 0;
    for (const Vec2d& p : spread(asked, {0, 0}, 1.2)) {
        const Vec3d at(p.x(), p.y(), 0);
        const Vec3d to_image = Vec3d(0, 0, 3) - at;
        const double turn = 2.4 * i++;
        const double tilt = 0.2 + 1.0 * (i % 7) / 7;
        const Vec3d wo(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn),
                       std::cos(tilt));
        const double irradiance = intensity * to_image.z() / std::pow(to_image.norm(), 3);
        scene.points.push_back(
            {at, Vec3d::UnitZ(), wo,
             reflectance *
                 schlick(static_cast<double>(alpha), Vec3d::UnitZ(), wo, to_image.normalized()) *
                 irradiance});
    }
    scene.series = usual_series(0.1, 2, 0.06);
    return scene;
}

// In an even field the N nearest photons make an estimate that scatters by exactly 1 / sqrt(N - 2)
// about the truth: (N - 1) / (pi r_N^2) of a Poisson process, whose pi r_N^2 times the density is a
// sum of N exponentials. Sunlight in an upright mirror lights the floor evenly, by E0 cos 45.
GalleryScene nearest_photons() {
    static constexpr double irradiance = 2;
    GalleryScene scene{"nearest_photons", "error 1 / sqrt(N - 2) in an even field", {}, {}, {}};
    scene.make = [](int) {
        SceneDesc desc;
        desc.shapes = {square("floor", 0, 4, true, grey()),
                       rectangle("mirror", {0, 1, 1.5}, {1.5, 0, 0}, {0, 0, 1.5}, mirror())};
        desc.lights = {directional_light({0, 1, -1}, irradiance)};
        return desc;
    };
    for (const Vec2d& p : spread(400, {0, -0.5}, 1.2))
        scene.points.push_back(
            {{p.x(), p.y(), 0}, Vec3d::UnitZ(), Vec3d::Zero(), irradiance * std::sqrt(0.5)});
    Series series{"photonmap", {}, 2, 1.1 / std::sqrt(318.0), 0, "kernel=point"};
    for (const int nearest : {20, 80, 320})
        series.efforts.push_back({0,
                                  {"photons=400000", "emission=random", "kernel=point",
                                   fmt::format("nearest={}", nearest)}});
    scene.series = {series, beam_tree(2, 0.001), caustic_polygons(2, 0.001)};
    return scene;
}

}  // namespace

std::vector<GalleryScene> laws() {
    return {furnace(), still_water("beer", "flat water times exp(-sigma d)", 0.8), schlick_floor(),
            nearest_photons()};
}

std::vector<GalleryScene> gallery() {
    std::vector<GalleryScene> all = mirrors();
    for (GalleryScene& scene : lenses()) all.push_back(std::move(scene));
    for (GalleryScene& scene : laws()) all.push_back(std::move(scene));
    for (GalleryScene& scene : rooms()) all.push_back(std::move(scene));
    return all;
}

}  // namespace caustics::experiments
