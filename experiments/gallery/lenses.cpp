#include <cmath>

#include "experiments/gallery/parts.h"

namespace caustics::experiments {

using namespace gallery_parts;

namespace {

const Vec2d up(0, 1);

// Rays of a point light on the axis at the height z, by their angle to the axis.
PlaneRay from_light(double z, double u) { return {{0, z}, {std::sin(u), -std::cos(u)}}; }

// Rays that fall along the axis, by their distance from it.
PlaneRay falling(double u) { return {{u, 10}, {0, -1}}; }

// 2 pi I sin u du into the angles u to u + du; 2 pi E rho drho through a ring.
std::function<double(double)> of_angle(double intensity) {
    return [intensity](double u) { return 2 * pi_d * intensity * std::sin(u); };
}
std::function<double(double)> of_ring(double irradiance) {
    return [irradiance](double rho) { return 2 * pi_d * irradiance * rho; };
}

// Paths of these events alone, so that light reflected to and fro inside counts for no method.
void allow_events(GalleryScene& scene, const std::string& count) {
    for (Series& each : scene.series)
        for (Effort& effort : each.efforts) effort.parameters.push_back("max_bounces=" + count);
}

// A plane-parallel slab of glass, 0.5 thick: two refractions by Snell, twice Fresnel's transmittance;
// a ray of angle u lands 2.5 tan u + 0.5 tan u' from the axis.
GalleryScene slab() {
    static constexpr double n = 1.5, intensity = 5;
    GalleryScene scene{"slab", "two refractions by planes", {}, {}, {}};
    scene.make = [](int) {
        SceneDesc desc;
        desc.shapes = {square("floor", 0, 5, true, grey()), square("top", 1.5, 3, true, glass(n)),
                       square("bottom", 1, 3, false, glass(n))};
        desc.lights = {point_light({0, 0, 3}, intensity)};
        return desc;
    };
    const auto land = [](double u) -> std::optional<Landing> {
        PlaneRay ray = from_light(3, u);
        ray.reach_plane(1.5);
        ray.refract(up, n);
        ray.reach_plane(1);
        ray.refract(up, 1 / n);
        ray.reach_plane(0);
        return Landing{ray.origin.x(), ray.share};
    };
    scene.points = known_on_ring({land, of_angle(intensity), 0, 1.2}, 0, true, 0.1, 1.5);
    scene.series = usual_series(0.1, 2, 0.05);
    allow_events(scene, "2");
    return scene;
}

// One sine of water under vertical sunlight: what falls on dx leaves by Snell from (x, h(x)) along the
// normal (-h', 1) and lands on |dX/dx| dx, so E = E0 sum T / |dX/dx|. Too shallow for folds.
GalleryScene sine_water() {
    static constexpr double n = 1.333, irradiance = 2, amplitude = 0.02, k = 6, depth = 1;
    GalleryScene scene{"sine_water", "one refraction by a sine", {}, {}, {}};
    scene.make = [](int) {
        Shape water;
        water.name = "water";
        water.primitive = Primitive::heightfield;
        water.field.waves = {{amplitude, {k, 0}, 0}};
        water.field.half_size = Vec2d::Constant(1.5);
        water.bsdf = glass(n);
        SceneDesc desc;
        desc.shapes = {square("floor", -depth, 3, true, grey()), water};
        desc.lights = {directional_light(-Vec3d::UnitZ(), irradiance)};
        return desc;
    };
    const auto land = [](double x) -> std::optional<Landing> {
        PlaneRay ray{{x, amplitude * std::sin(k * x)}, {0, -1}};
        ray.refract(Vec2d(-amplitude * k * std::cos(k * x), 1).normalized(), n);
        ray.reach_plane(-depth);
        return Landing{ray.origin.x(), ray.share};
    };
    const Meridian light{land, [](double) { return irradiance; }, -1.5, 1.5};
    for (const Vec2d& p : spread(asked, {0, 0}, 0.9))
        scene.points.push_back(
            {{p.x(), p.y(), -depth}, Vec3d::UnitZ(), Vec3d::Zero(), light.density(p.x())});
    scene.series = usual_series(0.05, 2, 0.03);
    return scene;
}

/// A ball of glass, what fills it and what is round it.
struct Ball {
    double n = 1.5, around = 1;            ///< iors
    double absorption = 0, of_around = 0;  ///< [1/m]
    double inner = 0.01, outer = 0.06;     ///< of the ring on the floor that is asked for [m]
};

// A ball of glass above its focus: two refractions by a sphere, and exp(-sigma d) on each way [Beer].
GalleryScene ball(const std::string& name, const std::string& answer, const Ball& ball) {
    static constexpr double intensity = 5, centre = 0.7, radius = 0.5, light_z = 3;
    GalleryScene scene{name, answer, {}, {}, {}};
    scene.make = [ball](int) {
        Dielectric inside;
        inside.int_ior = static_cast<float>(ball.n);
        inside.ext_ior = static_cast<float>(ball.around);
        inside.absorption = Spectrum::Constant(static_cast<float>(ball.absorption));
        inside.ext_absorption = Spectrum::Constant(static_cast<float>(ball.of_around));
        Shape sphere;
        sphere.name = "ball";
        sphere.primitive = Primitive::sphere;
        sphere.to_world = Eigen::Translation3d(0, 0, centre) * Eigen::Scaling(radius);
        sphere.bsdf = {inside, false};
        SceneDesc desc;
        desc.shapes = {square("floor", 0, 2, true, grey()), sphere};
        desc.lights = {point_light({0, 0, light_z}, intensity)};
        return desc;
    };
    const auto land = [ball](double u) -> std::optional<Landing> {
        PlaneRay ray = from_light(light_z, u);
        const Vec2d middle(0, centre), start = ray.origin;
        const double n = ball.n / ball.around;
        if (!ray.reach_circle(centre, radius, true)) return {};
        const Vec2d entry = ray.origin;
        ray.refract((entry - middle) / radius, n);
        ray.reach_circle(centre, radius, false);
        const Vec2d exit = ray.origin;
        if (!ray.refract((exit - middle) / radius, 1 / n)) return {};
        if (!ray.reach_plane(0)) return {};
        const double round = (entry - start).norm() + (ray.origin - exit).norm();
        return Landing{ray.origin.x(),
                       ray.share * std::exp(-ball.of_around * round -
                                            ball.absorption * (exit - entry).norm())};
    };
    const double edge = std::asin(radius / (light_z - centre));
    scene.points =
        known_on_ring({land, of_angle(intensity), 0, edge}, 0, true, ball.inner, ball.outer);
    // What is asked for lies in a spot that the innermost polygons light: they have to be small.
    scene.series = usual_series(0.005, 2, 0.05, 64);
    allow_events(scene, "2");
    return scene;
}

// Dark glass in dark water: of what goes through the middle a thousandth is left, and all that comes
// to the floor is as weak.
GalleryScene dark_ball() {
    GalleryScene scene =
        ball("dark_ball", "a sphere times exp(-sigma d)",
             {.around = 1.333, .absorption = 7, .of_around = 1, .inner = 0.1, .outer = 0.18});
    scene.series = {light_trace(0.01, 0.05, 400'000), beam_tree(2, 0.08, "preset=chuang1995", 64),
                    beam_tree(2, 0.08, "", 64)};
    allow_events(scene, "2");
    return scene;
}

// A cap of a sphere of radius 1 on a flat base, in vertical sunlight.
GalleryScene plano_convex_lens() {
    static constexpr double n = 1.5, irradiance = 2, aperture = 0.5, base = 1;
    const double centre = base - std::sqrt(1 - aperture * aperture);
    GalleryScene scene{"plano_convex_lens", "a sphere, then a plane", {}, {}, {}};
    scene.make = [centre](int bands) {
        const auto cap = [centre](double t) {
            const double angle = t * std::asin(aperture);
            const Vec2d out(std::sin(angle), std::cos(angle));
            return ProfilePoint{out.x(), centre + out.y(), out};
        };
        const auto disk = [](double t) { return ProfilePoint{t * aperture, base, -up}; };
        SceneDesc desc;
        desc.shapes = {square("floor", 0, 2, true, grey()),
                       mesh("lens", joined(turned(cap, bands), turned(disk, bands)), glass(n))};
        desc.lights = {directional_light(-Vec3d::UnitZ(), irradiance)};
        return desc;
    };
    const auto land = [centre](double rho) -> std::optional<Landing> {
        PlaneRay ray = falling(rho);
        if (!ray.reach_circle(centre, 1, true)) return {};
        ray.refract(ray.origin - Vec2d(0, centre), n);
        ray.reach_plane(base);
        if (!ray.refract(up, 1 / n)) return {};
        ray.reach_plane(0);
        return Landing{ray.origin.x(), ray.share};
    };
    scene.points = known_on_ring({land, of_ring(irradiance), 0, aperture}, 0, true, 0.03, 0.18);
    scene.series = usual_series(0.01, 2, 0.05);
    allow_events(scene, "2");
    return scene;
}

// A wedge of glass in sunlight: an even beam, whose irradiance across itself changes at each face by
// T cos(in) / cos(out), because its width does; on the floor by the cosine there.
GalleryScene prism() {
    static constexpr double n = 1.5, irradiance = 2, half = 0.6, base = 1, rise = 0.35;
    GalleryScene scene{"prism", "two refractions of an even beam", {}, {}, {}};
    scene.make = [](int) {
        TriangleMesh wedge;
        for (const float y : {-0.6F, 0.6F})
            for (const Vec2d& corner :
                 {Vec2d(-half, base), Vec2d(half, base), Vec2d(half, base + rise)})
                wedge.positions.emplace_back(static_cast<float>(corner.x()), y,
                                             static_cast<float>(corner.y()));
        // Bottom, back, top, two ends; their fronts outside.
        wedge.triangles = {{0, 4, 1}, {0, 3, 4}, {1, 5, 2}, {1, 4, 5},
                           {0, 2, 5}, {0, 5, 3}, {0, 1, 2}, {3, 5, 4}};
        SceneDesc desc;
        desc.shapes = {square("floor", 0, 3, true, grey()), mesh("wedge", wedge, glass(n))};
        desc.lights = {directional_light(-Vec3d::UnitZ(), irradiance)};
        return desc;
    };
    const Vec2d top = Vec2d(-rise, 2 * half).normalized();
    PlaneRay ray{{0, base + rise / 2}, {0, -1}};
    double truth = irradiance;
    const auto pass = [&](const Vec2d& normal, double eta) {
        truth *= std::abs(ray.direction.dot(normal));
        ray.refract(normal, eta);
        truth /= std::abs(ray.direction.dot(normal));
    };
    pass(top, n);
    ray.reach_plane(base);
    pass(up, 1 / n);
    ray.reach_plane(0);
    truth *= ray.share * -ray.direction.y();
    for (const Vec2d& p : spread(asked, {ray.origin.x(), 0}, 0.25))
        scene.points.push_back({{p.x(), p.y(), 0}, Vec3d::UnitZ(), Vec3d::Zero(), truth});
    scene.series = usual_series(0.05, 2, 0.01);
    allow_events(scene, "2");
    return scene;
}

}  // namespace

// n = 1.333, one metre deep, under a light two metres above it: Snell and Fresnel, and exp(-sigma d) on
// the d metres to the floor [Beer].
GalleryScene still_water(const std::string& name, const std::string& answer, double sigma) {
    static constexpr double n = 1.333, intensity = 10;
    GalleryScene scene{name, answer, {}, {}, {}};
    scene.make = [sigma](int) {
        SceneDesc desc;
        desc.shapes = {square("floor", -1, 5, true, grey()),
                       square("water", 0, 3, true, glass(n, sigma))};
        desc.lights = {point_light({0, 0, 2}, intensity)};
        return desc;
    };
    const auto land = [sigma](double u) -> std::optional<Landing> {
        PlaneRay ray = from_light(2, u);
        ray.reach_plane(0);
        ray.refract(up, n);
        const Vec2d entry = ray.origin;
        ray.reach_plane(-1);
        return Landing{ray.origin.x(), ray.share * std::exp(-sigma * (ray.origin - entry).norm())};
    };
    scene.points = known_on_ring({land, of_angle(intensity), 0, 0.95}, -1, true, 0.1, 1.5);
    scene.series = usual_series(0.1, 2, 0.05);
    return scene;
}

std::vector<GalleryScene> lenses() {
    return {slab(),       still_water("flat_water", "one refraction by a plane", 0),
            sine_water(), ball("ball_lens", "two refractions by a sphere", {}),
            dark_ball(),  plano_convex_lens(),
            prism()};
}

}  // namespace caustics::experiments
