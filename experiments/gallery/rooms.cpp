#include <fmt/format.h>

#include <cmath>

#include "experiments/gallery/parts.h"

namespace caustics::experiments {

using namespace gallery_parts;

namespace {

Shape sphere(const std::string& name, double radius, bool inwards, const Bsdf& bsdf) {
    Shape shape;
    shape.name = name;
    shape.primitive = Primitive::sphere;
    shape.to_world = Transform(Eigen::Scaling(radius));
    shape.flip_normals = inwards;
    shape.bsdf = bsdf;
    return shape;
}

// Points spread over the inside of a sphere of radius 1 about the origin.
std::vector<KnownPoint> inside(double truth) {
    std::vector<KnownPoint> points;
    for (const Vec2d& u : spread(asked, {0.5, 0.5}, 0.5)) {
        const double z = 2 * u.x() - 1, angle = 2 * pi_d * u.y();
        const double across = std::sqrt(1 - z * z);
        const Vec3d out(across * std::cos(angle), across * std::sin(angle), z);
        points.push_back({out, -out, Vec3d::Zero(), truth});
    }
    return points;
}

// Of the map, four times the photons and the rays: scatter falls by two.
Series global_map(double tolerance, const std::string& more) {
    Series series{"globalphotonmap", {}, 2, tolerance, 0, more};
    int photons = 10'000, rays = 25;
    for (int step = 0; step < 3; ++step, photons *= 4, rays *= 4)
        series.efforts.push_back({0,
                                  {fmt::format("photons={}", photons), "nearest=50",
                                   fmt::format("gather={}", rays), more}});
    return series;
}

std::vector<Series> indirect_series() {
    std::vector<Series> all = {path_trace(0.05, 100), light_trace(0.1, 0.08),
                               global_map(0.05, "precompute=4"), global_map(0.05, "precompute=0")};
    for (Series& each : all) each.indirect = true;
    return all;
}

// The integrating sphere. Every point of a sphere sees every other alike, so that what has been reflected is
// even, wherever the lamp: of the flux Phi = 4 pi I the share rho is reflected each time,
//   E = Phi / (4 pi r^2) (rho + rho^2 + ...) = I / r^2 rho / (1 - rho).
GalleryScene integrating_sphere() {
    static constexpr double rho = 0.6;
    GalleryScene scene{"integrating_sphere", "I / r^2 rho / (1 - rho) everywhere", {}, {}, {}};
    scene.make = [](int) {
        SceneDesc desc;
        desc.shapes = {
            sphere("wall", 1, true,
                   {Diffuse{Spectrum(Spectrum::Constant(static_cast<float>(rho)))}, false})};
        desc.lights = {point_light({0.3, -0.5, 0.4}, 1)};
        return desc;
    };
    scene.points = inside(rho / (1 - rho));
    scene.series = indirect_series();
    return scene;
}

// Two concentric spheres, both grey; the inner one, of radius r1, shines with M. Of what leaves the outer one
// F = r1^2 meets the inner, the rest the outer again:
//   E1 = B2, B1 = M + rho E1, B2 = rho E2, E2 = F B1 + (1 - F) B2; without the lamp's own F M.
GalleryScene sphere_round_a_lamp() {
    static constexpr double rho = 0.5, inner = 0.4, radiance = 1;
    GalleryScene scene{"sphere_round_a_lamp", "radiosity of two spheres", {}, {}, {}};
    scene.make = [](int) {
        SceneDesc desc;
        desc.shapes = {sphere("wall", 1, true, grey()), sphere("lamp", inner, false, grey())};
        desc.shapes[1].radiance = Spectrum(Spectrum::Constant(static_cast<float>(radiance)));
        return desc;
    };
    const double f = inner * inner, m = pi_d * radiance;
    const double e2 = f * m / (1 - rho * (f * rho + 1 - f));
    scene.points = inside(e2 - f * m);
    scene.series = indirect_series();
    return scene;
}

}  // namespace

std::vector<GalleryScene> rooms() { return {integrating_sphere(), sphere_round_a_lamp()}; }

}  // namespace caustics::experiments
