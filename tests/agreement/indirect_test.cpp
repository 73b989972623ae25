#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <regex>

#include "core/base/error.h"
#include "core/reference/indirect_path_trace.h"
#include "core/reference/light_trace.h"
#include "core/render/direct_light.h"
#include "core/render/renderer.h"
#include "photonmap/global_photon_map.h"
#include "photonmap/photon_map.h"
#include "tests/support/build_scene.h"
#include "tests/support/statistics.h"

namespace caustics {
namespace {

using photonmap::GlobalMapParams;

// A method of the indirect layer, and how far its answers may be off, besides their scatter.
struct Way {
    std::string name;
    std::function<std::unique_ptr<const IndirectEstimator>(const Scene&, int diffuse_bounces)> make;
    double tolerance;
};

std::vector<Way> ways(bool paths = true) {
    std::vector<Way> all = {
        {"lighttrace",
         [](const Scene& scene, int diffuse_bounces) {
             IndirectLightTraceParams params;
             params.paths = 400'000;
             params.diffuse_bounces = diffuse_bounces;
             return build(scene, params, {});
         },
         0.03},
        {"globalphotonmap gather 0",
         [](const Scene& scene, int diffuse_bounces) {
             GlobalMapParams params{.photons = 400'000, .nearest = 400, .gather = 0};
             params.diffuse_bounces = diffuse_bounces;
             return build(scene, params, {});
         },
         0.05},
        {"globalphotonmap gather 400",
         [](const Scene& scene, int diffuse_bounces) {
             GlobalMapParams params{.photons = 200'000, .nearest = 100, .gather = 400};
             params.diffuse_bounces = diffuse_bounces;
             return build(scene, params, {});
         },
         0.03},
        {"globalphotonmap gather 400, nothing known beforehand",
         [](const Scene& scene, int diffuse_bounces) {
             GlobalMapParams params{
                 .photons = 200'000, .nearest = 100, .gather = 400, .precompute = 0};
             params.diffuse_bounces = diffuse_bounces;
             return build(scene, params, {});
         },
         0.03}};
    if (paths)
        all.push_back({"pathtrace",
                       [](const Scene& scene, int diffuse_bounces) {
                           IndirectPathTraceParams params{.spp = 20'000};
                           params.diffuse_bounces = diffuse_bounces;
                           return build(scene, params, {});
                       },
                       0.03});
    return all;
}

// Points all over the inside of a sphere about the origin.
std::vector<ReceiverPoint> inside(const Scene& scene, std::size_t shape, double radius) {
    std::vector<ReceiverPoint> points;
    constexpr int count = 16;
    for (int i = 0; i < count; ++i) {
        const double z = 1 - (2 * i + 1.0) / count;
        const double angle = i * pi_d * (3 - std::sqrt(5.0));
        const double across = std::sqrt(1 - z * z);
        const Vec3d out(across * std::cos(angle), across * std::sin(angle), z);
        points.push_back(
            support::probe(scene, shape, radius * out, -out, static_cast<std::uint64_t>(i), 0.1F));
    }
    return points;
}

// The mean over the points is `exact`, and so is each of them, more or less.
void expect_even(const Scene& scene, const std::vector<ReceiverPoint>& points, double exact,
                 int diffuse_bounces = 0, bool paths = true) {
    for (const Way& way : ways(paths)) {
        const auto found = support::irradiance(*way.make(scene, diffuse_bounces), points);
        support::Moments all;
        for (const Estimate& e : found) {
            all.add(static_cast<double>(e.value.mean()));
            EXPECT_NEAR(static_cast<double>(e.value.mean()) / exact, 1, 6 * way.tolerance)
                << way.name;
        }
        EXPECT_NEAR(all.mean() / exact, 1, way.tolerance) << way.name;
    }
}

Scene sphere_with_lamp(const Bsdf& wall, const Vec3d& lamp) {
    SceneDesc desc;
    desc.shapes = {support::enclosure(1, wall)};
    desc.lights = {support::point_light(lamp, 1)};
    return Scene(std::move(desc));
}

// The integrating sphere: wherever the lamp is, what has been reflected is the same everywhere.
TEST(IndirectLight, IsEvenInASphere) {
    constexpr double rho = 0.6;
    for (const Vec3d& lamp : {Vec3d(0, 0, 0), Vec3d(0.3, -0.5, 0.4)}) {
        const Scene scene = sphere_with_lamp(support::diffuse(static_cast<float>(rho)), lamp);
        const auto points = inside(scene, 0, 1);
        expect_even(scene, points, rho / (1 - rho));  // Phi / (4 pi r^2) = 1
        expect_even(scene, points, rho, 2);
    }
}

// Phong's law of 1975 is not the same from both sides: of light that arrives along the normal, cosine 1, it leaves
// L = k_d / pi + k_s cos^e a, whose irradiance is k_d + 2 pi k_s / (e + 2).
TEST(IndirectLight, FollowsALawThatIsNotReciprocal) {
    constexpr double diffuse = 0.3, specular = 0.3, exponent = 2;
    const Scene scene =
        sphere_with_lamp(support::phong(static_cast<float>(diffuse), static_cast<float>(specular),
                                        static_cast<float>(exponent), Phong::Model::classic),
                         Vec3d::Zero());
    expect_even(scene, inside(scene, 0, 1), diffuse + 2 * pi_d * specular / (exponent + 2), 2);
}

// One that is a mirror, too: direct light, caustics and indirect light are all of it.
TEST(IndirectLight, LeavesTheMirrorsLightToCaustics) {
    constexpr double rho = 0.5, weight = 0.4, reflectance = 0.9;
    Bsdf wall = support::diffuse(static_cast<float>(rho));
    wall.mirror = MirrorPart{static_cast<float>(weight),
                             Spectrum(Spectrum::Constant(static_cast<float>(reflectance)))};
    const Scene scene = sphere_with_lamp(wall, Vec3d::Zero());
    constexpr double q = weight * reflectance;
    const double total = 1 / (1 - (1 - weight) * rho - q);
    const double caustic = q * (1 - std::pow(q, 16)) / (1 - q);
    expect_even(scene, inside(scene, 0, 1), total - 1 - caustic, 0, false);
}

// Two concentric spheres; the inner one shines.
TEST(IndirectLight, IsTheRadiosityOfTwoSpheres) {
    constexpr double rho1 = 0.7, rho2 = 0.5, r1 = 0.4;
    SceneDesc desc;
    desc.shapes = {
        support::enclosure(1, support::diffuse(static_cast<float>(rho2))),
        support::sphere("lamp", Vec3d::Zero(), r1, support::diffuse(static_cast<float>(rho1)))};
    desc.shapes[1].radiance = Spectrum(Spectrum::Constant(1));
    const Scene scene(std::move(desc));
    // E1 = B2, B1 = M + rho1 E1, B2 = rho2 E2, E2 = F B1 + (1 - F) B2.
    constexpr double m = pi_d, f = r1 * r1;
    const double e2 = f * m / (1 - rho2 * (f * rho1 + 1 - f));
    expect_even(scene, inside(scene, 0, 1), e2 - f * m);
}

// A room whose walls shine and reflect: all of its light is Le / (1 - rho).
TEST(IndirectLight, FillsAFurnace) {
    constexpr double rho = 0.5;
    SceneDesc desc;
    desc.shapes = support::emitting_room(1, 1, support::diffuse(static_cast<float>(rho)));
    const Scene scene(std::move(desc));
    std::vector<ReceiverPoint> points;
    for (std::size_t i = 0; i < 6; ++i) {
        const Vec3d place = scene.shapes()[i].to_world.translation();
        points.push_back(support::probe(
            scene, i, place + Vec3d(0.1, 0.2, -0.1).cwiseProduct(Vec3d::Ones() - place.cwiseAbs()),
            -place.normalized(), i, 0.1F));
    }
    expect_even(scene, points, pi_d * (1 / (1 - rho) - 1));
}

// A lamp of some size over a ball of glass in a box of grey walls.
Scene box_with_ball() {
    SceneDesc desc;
    const Bsdf grey = support::diffuse(0.7F);
    desc.shapes = {support::horizontal("floor", 0, 1, true, grey),
                   support::horizontal("ceiling", 2, 1, false, grey),
                   support::rectangle("left", {-1, 0, 1}, {0, 1, 0}, {0, 0, 1}, grey),
                   support::rectangle("right", {1, 0, 1}, {0, 0, 1}, {0, 1, 0}, grey),
                   support::rectangle("back", {0, 1, 1}, {1, 0, 0}, {0, 0, 1}, grey),
                   support::rectangle("front", {0, -1, 1}, {0, 0, 1}, {1, 0, 0}, grey),
                   support::sphere("ball", {0.3, 0.2, 0.4}, 0.35, support::glass(1.5F)),
                   support::horizontal("lamp", 1.99, 0.25, false, support::diffuse(0))};
    desc.shapes.back().radiance = Spectrum(Spectrum::Constant(10));
    desc.camera = support::camera({-0.8, -0.9, 1.2}, {0.2, 0.2, 0.4}, Vec3d::UnitZ(), 70, 24, 16);
    return Scene(std::move(desc));
}

// Channel by channel.
void expect_same_by_all_methods(const Scene& scene, const std::vector<ReceiverPoint>& points) {
    const auto paths =
        support::irradiance(*build(scene, IndirectPathTraceParams{.spp = 100'000}, {}), points);
    const auto particles = support::irradiance(
        *build(scene, IndirectLightTraceParams{{.paths = 3'000'000}}, {}), points);
    const auto gathered = support::irradiance(
        *build(scene, GlobalMapParams{.photons = 400'000, .nearest = 60, .gather = 4000}, {}),
        points);
    for (std::size_t i = 0; i < points.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const auto path = static_cast<double>(paths[i].value[c]);
            const double error = std::hypot(static_cast<double>(paths[i].standard_error[c]),
                                            static_cast<double>(particles[i].standard_error[c]));
            EXPECT_NEAR(static_cast<double>(particles[i].value[c]), path, 4 * error + 0.01 * path)
                << i << ", channel " << c;
            EXPECT_NEAR(static_cast<double>(gathered[i].value[c]) / path, 1, 0.04)
                << i << ", channel " << c;
        }
}

TEST(IndirectLight, IsTheSameByAllMethodsBesideGlass) {
    const Scene scene = box_with_ball();
    std::vector<ReceiverPoint> points;
    for (const Vec3d& at : {Vec3d(-0.5, -0.5, 0), Vec3d(0.3, 0.2, 0), Vec3d(-0.5, 0.6, 0)})
        points.push_back(support::probe(scene, 0, at, Vec3d::UnitZ(), points.size(), 0.08F));
    expect_same_by_all_methods(scene, points);
}

// Light from wall to wall of a pool is dimmed by its water, whatever end it is followed from.
TEST(IndirectLight, IsTheSameByAllMethodsInAPool) {
    SceneDesc desc;
    const Bsdf grey = support::diffuse(0.8F);
    desc.shapes = {
        support::horizontal("floor", 0, 1, true, grey),
        support::rectangle("left", {-1, 0, 0.5}, {0, 1, 0}, {0, 0, 0.5}, grey),
        support::rectangle("right", {1, 0, 0.5}, {0, 0, 0.5}, {0, 1, 0}, grey),
        support::rectangle("back", {0, 1, 0.5}, {1, 0, 0}, {0, 0, 0.5}, grey),
        support::rectangle("front", {0, -1, 0.5}, {0, 0, 0.5}, {1, 0, 0}, grey),
        support::horizontal("water", 1, 1, true, support::glass(1.33F, 1, {0.05F, 0.4F, 1.2F})),
        support::horizontal("lamp", 2, 0.8, false, support::diffuse(0))};
    desc.shapes.back().radiance = Spectrum(Spectrum::Constant(10));
    const Scene scene(std::move(desc));
    std::vector<ReceiverPoint> points;
    for (const Vec3d& at : {Vec3d(-0.6, -0.5, 0), Vec3d(0.8, 0.2, 0)}) {
        points.push_back(support::probe(scene, 0, at, Vec3d::UnitZ(), points.size(), 0.08F));
        ReceiverPoint& point = points.back();
        point.medium = scene.medium_before({point.position, point.geometric_normal, point.offset});
    }
    expect_same_by_all_methods(scene, points);
}

// Normals that lean towards the lamp turn no flux: what a wall sends on is the light on its true area.
TEST(IndirectLight, IsTheSameByAllMethodsBesideSmoothMeshes) {
    TriangleMesh leaning;
    leaning.positions = {{1, -1, 0}, {1, 1, 0}, {1, 1, 2}, {1, -1, 2}};
    leaning.triangles = {{0, 2, 1}, {0, 3, 2}};
    leaning.normals.assign(4, Vec3(-1, 0, 1).normalized());
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", 0, 1, true, support::diffuse(0.5F)),
                   support::mesh("wall", leaning, Transform::Identity(), support::diffuse(0.8F)),
                   support::horizontal("lamp", 2, 0.3, false, support::diffuse(0))};
    desc.shapes.back().radiance = Spectrum(Spectrum::Constant(10));
    const Scene scene(std::move(desc));
    expect_same_by_all_methods(scene,
                               {support::probe(scene, 0, {0.7, 0.2, 0}, Vec3d::UnitZ(), 0, 0.08F)});
}

TEST(IndirectLight, PicturesAreTheSameByThreadsAndInstructionSets) {
    const Scene scene = box_with_ball();
    const auto caustic = build(scene, photonmap::PhotonMapParams{.photons = 2000}, {});
    for (const int gather : {0, 16}) {
        std::vector<std::vector<float>> reds;
        for (const Isa isa : supported_isas()) {
            RunOptions options;
            options.threads = isa == Isa::plain ? 1 : 3;
            options.isa = isa;
            options.samples_per_pixel = 4;
            const auto indirect =
                build(scene, GlobalMapParams{.photons = 5000, .gather = gather}, options);
            const Rendering rendering = render(scene, *caustic, options, indirect.get());
            const Film& film = rendering.film;
            reds.push_back(*film.find("indirect.R"));
            for (std::size_t i = 0; i < film.pixel_count(); ++i) {
                const Spectrum sum = film.rgb("direct", i) + film.rgb("caustic", i) +
                                     film.rgb("specular", i) + film.rgb("indirect", i);
                EXPECT_LE((film.rgb("", i) - sum).abs().maxCoeff(), 1e-5F * sum.maxCoeff());
            }
        }
        for (const std::vector<float>& red : reds) EXPECT_EQ(red, reds[0]);
    }
}

// Of the lookups alone: the same gather rays, and so many photons that the estimates hardly scatter.
TEST(IndirectLight, IsNotChangedByWhatIsKnownBeforehand) {
    const Scene scene = sphere_with_lamp(support::diffuse(0.6F), Vec3d(0.3, -0.5, 0.4));
    const auto points = inside(scene, 0, 1);
    const auto mean = [&](int precompute, int nearest) {
        GlobalMapParams params{.photons = 1'000'000, .nearest = nearest, .gather = 1000};
        params.precompute = precompute;
        support::Moments all;
        for (const Estimate& e : support::irradiance(*build(scene, params, {}), points))
            all.add(static_cast<double>(e.value.mean()));
        return all.mean();
    };
    const double estimated = mean(0, 50);
    EXPECT_NEAR(mean(1, 50) / estimated, 1, 0.005);
    EXPECT_NEAR(mean(4, 50) / estimated, 1, 0.005);
    EXPECT_NEAR(mean(16, 200) / mean(0, 200), 1, 0.005);
    // Places so far apart that a reader's nearest is as far as the photons of its estimate: 1/N too much at most.
    const double sparse = mean(50, 50) / estimated;
    EXPECT_GT(sparse, 1.005);
    EXPECT_LT(sparse, 1.02);
}

// The scatter of pictures with other seeds is what their standard error says.
TEST(IndirectLight, HasItsStandardError) {
    const Scene scene = box_with_ball();
    const auto caustic = build(scene, photonmap::PhotonMapParams{.photons = 500}, {});
    support::Moments squares;
    Film first(1, 1);
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        RunOptions options;
        options.seed = seed;
        options.samples_per_pixel = 64;
        const auto paths = build(scene, IndirectPathTraceParams{.spp = 64}, options);
        Film film = render(scene, *caustic, options, paths.get()).film;
        if (seed == 1) {
            first = std::move(film);
            continue;
        }
        for (std::size_t i = 0; i < film.pixel_count(); ++i) {
            const auto difference =
                static_cast<double>((film.rgb("indirect", i) - first.rgb("indirect", i))[1]);
            const auto a = static_cast<double>(film.rgb("indirect_stderr", i)[1]);
            const auto b = static_cast<double>(first.rgb("indirect_stderr", i)[1]);
            squares.add(difference * difference / (a * a + b * b));
        }
    }
    EXPECT_NEAR(squares.mean(), 1, 0.35);
}

// ARCHITECTURE.md, "Path sets": a path from the light, its events as letters, to the eye.
TEST(IndirectLight, PathsBelongToOneLayer) {
    const std::vector<std::regex> layers = {std::regex("LS*E"), std::regex("LDS*E"),
                                            std::regex("LS+DS*E"), std::regex("L(S*D)+S*DS*E")};
    for (int events = 0; events <= 4; ++events)
        for (int bits = 0; bits < 1 << events; ++bits) {
            std::string path = "L";
            for (int i = 0; i < events; ++i) path += (bits >> i & 1) != 0 ? 'D' : 'S';
            path += 'E';
            int held = 0;
            for (const std::regex& layer : layers) held += std::regex_match(path, layer) ? 1 : 0;
            EXPECT_EQ(held, 1) << path;
        }
}

TEST(IndirectLight, RefusesLightThatComesToNoEnd) {
    const Scene scene = sphere_with_lamp(support::diffuse(1), Vec3d::Zero());
    EXPECT_THROW(build(scene, GlobalMapParams{}, {}), InputError);
}

TEST(IndirectLight, PathsRefuseCausticsThatTheyCannotMeet) {
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", 0, 1, true, support::diffuse(0.5F)),
                   support::sphere("ball", {0, 0, 0.5}, 0.3, support::glass(1.5F))};
    desc.lights = {support::point_light({0, 0, 2}, 1)};
    const Scene scene(std::move(desc));
    EXPECT_THROW(build(scene, IndirectPathTraceParams{}, {}), UnsupportedScene);
}

}  // namespace
}  // namespace caustics
