#include "core/light_path/light_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/geometry/tessellate.h"
#include "core/light_path/aimed_emission.h"
#include "core/math/sampling.h"
#include "core/mesh/vertex_normals.h"
#include "tests/support/build_scene.h"
#include "tests/support/statistics.h"

namespace caustics {
namespace {

// The only deposit of a path where nothing is a receiver and a caster.
std::optional<Deposit> trace_one(const Scene& scene, const LightParticle& particle,
                                 const LightPathSettings& settings, Rng& rng,
                                 LightPathCounts& counts) {
    std::vector<Deposit> deposits;
    trace_light_path(scene, particle, settings, rng, counts, deposits);
    EXPECT_LE(deposits.size(), 1U);
    return deposits.empty() ? std::nullopt : std::optional<Deposit>(deposits[0]);
}

constexpr std::uint64_t paths = 40'000;

// Sends every path and calls sent(particle) for those that leave; the mean flux they carry.
template <typename Sent>
support::Moments send(const AimedEmission& emission, const Sent& sent, std::uint64_t seed = 1) {
    support::Moments flux;
    for (std::uint64_t path = 0; path < paths; ++path) {
        Rng rng(seed, Stage::test, path);
        const auto particle = emission.emit(rng);
        flux.add(particle ? static_cast<double>(particle->flux[0]) : 0.0);
        if (particle) sent(*particle, rng);
    }
    return flux;
}

SceneDesc ball_lit_from_a_point(double radius, double distance) {
    SceneDesc desc;
    desc.shapes.push_back(support::sphere("ball", {0, 0, 0}, radius, support::glass(1.5F)));
    desc.lights.push_back(support::point_light(Vec3d(1, 2, 2) / 3 * distance, 1));
    return desc;
}

// The cone round a sphere holds the whole sphere and hardly anything else, however small.
TEST(AimedEmission, AimsAtSmallDistantSpheres) {
    for (const double angle : {0.5, 1e-2, 1e-3, 1e-4, 1e-5}) {
        const Scene scene(ball_lit_from_a_point(1, 1 / std::sin(angle)));
        const AimedEmission emission(scene);
        const double solid_angle = 4 * pi_d * std::pow(std::sin(angle / 2), 2);
        ASSERT_FALSE(emission.empty()) << angle;
        EXPECT_NEAR(static_cast<double>(emission.total_power()[0]) / solid_angle, 1, 1e-4) << angle;
        if (angle < 1e-3) continue;  // below, the directions themselves are rounded
        int hits = 0, sent = 0;
        send(emission, [&](const LightParticle& particle, Rng&) {
            ++sent;
            hits += scene.intersect(particle.ray) ? 1 : 0;
        });
        EXPECT_EQ(sent, static_cast<int>(paths));
        EXPECT_GT(hits, sent * 0.997) << angle;
    }
}

TEST(AimedEmission, RefusesPowerThatFloatsDoNotServe) {
    const auto emission = [](float intensity, double radius) {
        SceneDesc desc = ball_lit_from_a_point(radius, 4 * radius);
        desc.lights = {support::point_light(Vec3d(0, 0, 4 * radius), intensity)};
        const Scene scene(std::move(desc));
        return AimedEmission(scene).total_power().maxCoeff();
    };
    EXPECT_GT(emission(1e-30F, 1), 1e-31F);
    EXPECT_GT(emission(1e30F, 1), 1e29F);
    for (const float strength : {1e-44F, 1e-34F, 1e36F, 3e38F})
        EXPECT_THROW(emission(strength, 1), UnsupportedScene) << strength;
    // The message says where the light was to go.
    SceneDesc desc = ball_lit_from_a_point(1, 4);
    std::get<PointLight>(desc.lights[0]).intensity.setConstant(1e-36F);
    const Scene faint(std::move(desc));
    const std::pair<Aim, std::string> aims[] = {{Aim::casters, "towards the casters, "},
                                                {Aim::everywhere, "towards the scene, "}};
    for (const auto& [where, expected] : aims) {
        try {
            const AimedEmission none(faint, Isa::plain, where);
            ADD_FAILURE() << expected;
        } catch (const UnsupportedScene& error) {
            EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
        }
    }
}

// Overlapping cones: every direction of the union equally often, none twice.
TEST(AimedEmission, IsUniformOverTheUnionOfTheCasters) {
    SceneDesc desc;
    desc.lights.push_back(support::point_light({0, 0, 0}, 3));
    const std::vector<Vec3> centres = {{0, 0, 4}, {1, 0, 5}, {-4, 1, 1}};
    const std::vector<float> radii = {1.2F, 1.5F, 0.5F};
    for (std::size_t i = 0; i < centres.size(); ++i)
        desc.shapes.push_back(support::sphere("ball", centres[i].cast<double>(),
                                              static_cast<double>(radii[i]), support::glass(1.5F)));
    const Scene scene(std::move(desc));
    const auto cell = [&](const Vec3& d) {
        std::size_t which = 0;
        for (std::size_t i = 0; i < centres.size(); ++i) {
            const float along = d.dot(centres[i]);
            const bool held = along > 0 && (centres[i] - along * d).norm() <= radii[i];
            which |= held ? std::size_t{1} << i : 0U;
        }
        return which;
    };
    std::vector<double> solid_angle(8);
    constexpr int steps = 1500;
    for (int i = 0; i < steps; ++i)
        for (int j = 0; j < steps; ++j) {
            const double z = 2 * (i + 0.5) / steps - 1;
            const double a = 2 * pi_d * (j + 0.5) / steps;
            const double r = std::sqrt(1 - z * z);
            solid_angle[cell(Vec3d(r * std::cos(a), r * std::sin(a), z).cast<float>())] +=
                4 * pi_d / (double{steps} * steps);
        }
    std::vector<double> counts(8);
    double sent = 0;
    const support::Moments flux =
        send(AimedEmission(scene), [&](const LightParticle& particle, Rng&) {
            counts[cell(particle.ray.direction)] += 1;
            ++sent;
        });
    EXPECT_LT(counts[0], 1e-3 * sent);
    solid_angle[0] = counts[0] = 0;
    double in_union = 0;
    for (const double share : solid_angle) in_union += share;
    EXPECT_NEAR(flux.mean(), 3 * in_union, 4 * flux.standard_error() + 1e-3 * in_union);
    for (std::size_t i = 1; i < 8; ++i) {
        const double expected = sent * solid_angle[i] / in_union;
        EXPECT_NEAR(counts[i], expected, 4 * std::sqrt(expected) + 1e-3 * sent) << i;
    }
}

// A ball before a mesh and a quadric, overlapping as seen from the light: the light that reaches
// each first is what rays in all directions find.
TEST(AimedEmission, LightsOverlappingCastersOfEveryKindAsRaysInAllDirectionsDo) {
    SceneDesc desc;
    desc.lights.push_back(support::point_light({0.1, -0.2, 0.3}, 2));
    desc.shapes.push_back(support::sphere("ball", {0.4, 0, 2.2}, 0.6, support::glass(1.5F)));
    Transform behind = Transform::Identity();
    behind.translate(Vec3d(1.2, 0.6, 4));
    desc.shapes.push_back(support::mesh("mesh", tessellate_sphere(6), behind, support::mirror()));
    desc.shapes.push_back(
        support::rectangle("mirror", {-1, 0, 2}, {0.9, 0, 0.3}, {0, 0.7, 0}, support::mirror()));
    const Scene scene(std::move(desc));
    const AimedEmission emission(scene);
    constexpr double intensity = 2;
    std::array<support::Moments, 3> aimed, uniform;
    for (std::uint64_t path = 0; path < 4 * paths; ++path) {
        Rng rng(5, Stage::test, path);
        const auto add = [&](const std::optional<SurfacePoint>& hit, double flux,
                             std::array<support::Moments, 3>& sums) {
            for (std::uint32_t i = 0; i < 3; ++i) sums[i].add(hit && hit->shape == i ? flux : 0);
        };
        const auto particle = emission.emit(rng);
        add(particle ? scene.intersect(particle->ray) : std::nullopt,
            particle ? static_cast<double>(particle->flux[0]) : 0, aimed);
        const Vec3 anywhere = uniform_cap(2, rng.next(), rng.next()).normalized();
        add(scene.intersect({Vec3(0.1F, -0.2F, 0.3F), anywhere}), 4 * pi_d * intensity, uniform);
    }
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_GT(uniform[i].mean(), 0.05);
        EXPECT_NEAR(aimed[i].mean(), uniform[i].mean(),
                    4 * std::hypot(aimed[i].standard_error(), uniform[i].standard_error()))
            << i;
        EXPECT_LT(aimed[i].standard_error(), 0.6 * uniform[i].standard_error()) << i;
    }
}

TEST(AimedEmission, SendsNothingWithoutACasterOrALightThatSeesOne) {
    SceneDesc plain;
    plain.lights.push_back(support::point_light({0, 0, 1}, 1));
    plain.lights.push_back(support::directional_light({0, 0, -1}, 1));
    plain.shapes.push_back(support::horizontal("floor", 0, 1, true, support::diffuse(0.5F)));
    const Scene without_caster(std::move(plain));
    EXPECT_TRUE(AimedEmission(without_caster).empty());
    Rng rng(1, Stage::test, 0);
    EXPECT_FALSE(AimedEmission(without_caster).emit(rng));

    SceneDesc behind;
    behind.shapes.push_back(support::horizontal("lamp", 0, 1, true, support::diffuse(0.5F)));
    behind.shapes.back().radiance = Spectrum(Spectrum::Ones());
    behind.shapes.push_back(support::sphere("ball", {0, 0, -5}, 0.5, support::glass(1.5F)));
    const Scene caster_behind(std::move(behind));
    EXPECT_TRUE(AimedEmission(caster_behind).empty());

    const Scene dark{SceneDesc{}};
    EXPECT_TRUE(AimedEmission(dark).empty());
}

TEST(AimedEmission, ALampInsideACasterSendsAllItsPower) {
    SceneDesc desc;
    desc.shapes.push_back(support::sphere("shell", {0, 0, 0}, 5, support::glass(1.5F)));
    desc.shapes.push_back(support::horizontal("lamp", 0.5, 0.5, true, support::diffuse(0.5F)));
    desc.shapes.back().radiance = Spectrum(Spectrum::Constant(2));
    const Scene area(std::move(desc));
    const support::Moments by_area =
        send(AimedEmission(area),
             [](const LightParticle& particle, Rng&) { EXPECT_GE(particle.ray.direction.z(), 0); });
    EXPECT_NEAR(by_area.mean(), 2 * pi_d * 1, 4 * by_area.standard_error());

    SceneDesc inside = ball_lit_from_a_point(1, 0.2);
    const Scene point(std::move(inside));
    const support::Moments by_point = send(AimedEmission(point), [](const LightParticle&, Rng&) {});
    EXPECT_NEAR(by_point.mean(), 4 * pi_d, 1e-4);
}

TEST(AimedEmission, DirectionalLightFillsTheUnionOfTheShadows) {
    SceneDesc desc;
    desc.lights.push_back(support::directional_light({1, 0, -1}, 2));
    desc.shapes.push_back(support::sphere("near", {0, 0, 0}, 1, support::glass(1.5F)));
    // In the first one's shadow: their union is the larger disc.
    desc.shapes.push_back(support::sphere("far", {3, 0, -3}, 0.5, support::glass(1.5F)));
    const Scene scene(std::move(desc));
    int misses = 0;
    const support::Moments flux =
        send(AimedEmission(scene), [&](const LightParticle& particle, Rng&) {
            const auto hit = scene.intersect(particle.ray);
            misses += hit && hit->shape == 0 ? 0 : 1;
        });
    EXPECT_LT(misses, 20);
    EXPECT_NEAR(flux.mean(), 2 * pi_d, 4 * flux.standard_error());
}

TEST(AimedEmission, SharesParticlesByPower) {
    SceneDesc desc = ball_lit_from_a_point(1, 5);
    desc.lights.push_back(support::point_light(Vec3d(-5, 0, 0), 3));
    const Scene scene(std::move(desc));
    support::Moments from_first;
    const support::Moments flux =
        send(AimedEmission(scene), [&](const LightParticle& particle, Rng&) {
            from_first.add(particle.ray.origin.x() > 0 ? 1 : 0);
        });
    EXPECT_NEAR(from_first.mean(), 0.25, 4 * from_first.standard_error());
    EXPECT_LT(flux.deviation(), 1e-4 * flux.mean());  // every particle carries the same
}

TEST(LightPath, EveryPathHasOneEnd) {
    SceneDesc desc = ball_lit_from_a_point(1, 4);
    desc.lights.push_back(support::point_light({-3, 1, 2}, 1));
    desc.shapes.push_back(support::sphere("inner", {0.2, 0, 0}, 0.5, support::glass(1.2F, 1.5F)));
    desc.shapes.push_back(support::horizontal("floor", -1.5, 2, true, support::diffuse(0.5F)));
    desc.shapes.push_back(
        support::rectangle("mirror", {2, 0, 0}, {0, 1, 0}, {0, 0, 1}, support::mirror(0.5F)));
    desc.shapes.back().bsdf.twosided = false;
    desc.shapes.push_back(support::horizontal("screen", 1.4, 0.3, true, support::diffuse(0.5F)));
    const Scene scene(std::move(desc));
    const AimedEmission emission(scene);
    for (const int max_bounces : {1, 2, 16}) {
        LightPathCounts counts;
        counts.emitted = paths;
        std::uint64_t deposits = 0;
        send(emission, [&](const LightParticle& particle, Rng& rng) {
            ++counts.aimed;
            const auto deposit = trace_one(scene, particle, {max_bounces}, rng, counts);
            if (!deposit) return;
            ++deposits;
            ASSERT_TRUE(is_finite(deposit->flux));
            ASSERT_GT(deposit->flux.maxCoeff(), 0);
            ASSERT_GE(deposit->bounces, 1);
            ASSERT_LE(deposit->bounces, max_bounces);
            ASSERT_GT(deposit->geometric_normal.dot(deposit->wi), 0);
            ASSERT_TRUE(is_receiver(scene.shapes()[deposit->shape].bsdf));
        });
        EXPECT_EQ(counts.missed + counts.escaped + counts.absorbed + counts.on_black_side +
                      counts.depth_limited + counts.stored,
                  counts.aimed);
        EXPECT_EQ(counts.stored, deposits);
        EXPECT_GT(counts.stored, 0U);
        EXPECT_GT(counts.depth_limited, 0U);
    }
}

// All light that comes to casters ends somewhere, by roulette and by splitting, on blends too.
TEST(LightPath, TheLedgerBalances) {
    SceneDesc desc = ball_lit_from_a_point(1, 4);
    desc.shapes.push_back(support::sphere("inner", {0.2, 0, 0}, 0.5,
                                          support::glass(1.2F, 1.5F, Spectrum(0.1F, 0.5F, 1))));
    Bsdf blend = support::diffuse(0.5F);
    blend.mirror = MirrorPart{0.6F, Spectrum(Spectrum::Constant(0.9F))};
    desc.shapes.push_back(support::horizontal("floor", -1.5, 2, true, blend));
    desc.shapes.push_back(
        support::rectangle("mirror", {2, 0, 0}, {0, 1, 0}, {0, 0, 1}, support::mirror(0.5F)));
    const Scene scene(std::move(desc));
    const AimedEmission emission(scene);
    for (const int max_bounces : {1, 3, 1000})
        for (const auto trace : {trace_light_path, trace_split_path}) {
            LightPathCounts counts;
            double arrived = 0;
            send(emission, [&](const LightParticle& particle, Rng& rng) {
                std::vector<Deposit> deposits;
                trace(scene, particle, {max_bounces}, rng, counts, deposits);
                for (const Deposit& deposit : deposits)
                    arrived += static_cast<double>(deposit.flux.mean());
            });
            const LightLedger& light = counts.light;
            EXPECT_NEAR(light.ended(), light.sent, 1e-5 * light.sent) << max_bounces;
            EXPECT_NEAR(light.arrived, arrived, 1e-9 * arrived) << max_bounces;
            EXPECT_GT(light.arrived, 0.01 * light.sent);
            EXPECT_GT(light.escaped, 0);
            EXPECT_EQ(light.cut > 0, max_bounces < 1000);
        }
}

// A point light before a mirror: the mirror's solid angle times the intensity, of which it keeps a quarter.
TEST(LightPath, TheLedgerHasTheLightOnAMirrorAndWhatItAbsorbs) {
    SceneDesc desc;
    desc.shapes = {
        support::rectangle("mirror", {0, 0, 1}, {0, 1, 0}, {1, 0, 0}, support::mirror(0.75F)),
        support::horizontal("floor", -1, 50, true, support::diffuse(0.5F))};
    desc.lights = {support::point_light({0, 0, 0}, 2)};
    const Scene scene(std::move(desc));
    const AimedEmission emission(scene);
    LightPathCounts counts;
    support::Moments sent;
    std::uint64_t emitted = 0;
    for (std::uint64_t path = 0; path < 200'000; ++path) {
        Rng rng(5, Stage::test, path);
        ++emitted;
        const auto particle = emission.emit(rng);
        const double before = counts.light.sent;
        std::vector<Deposit> deposits;
        if (particle) trace_light_path(scene, *particle, {}, rng, counts, deposits);
        sent.add(counts.light.sent - before);
    }
    counts.emitted = emitted;
    // A square of side 2 at the distance 1 from its middle has a sixth of the sphere.
    EXPECT_NEAR(counts.watts().sent, 2 * 4 * pi_d / 6, 4 * sent.standard_error());
    EXPECT_NEAR(counts.light.absorbed, 0.25 * counts.light.sent, 0.005 * counts.light.sent);
    EXPECT_EQ(counts.light.misdirected, 0);
    EXPECT_NEAR(counts.light.arrived + counts.light.escaped, 0.75 * counts.light.sent,
                0.005 * counts.light.sent);
}

// Absorbing glass round a ball, mirrors, water as a mesh: paths side by side against one by one.
TEST(LightPath, PathsThatGoTogetherArriveWhereTheyArriveAlone) {
    SceneDesc desc = ball_lit_from_a_point(1, 4);
    desc.shapes.push_back(support::sphere("inner", {0.2, 0, 0}, 0.5,
                                          support::glass(1.2F, 1.5F, Spectrum(0.1F, 0.5F, 1))));
    desc.shapes.push_back(support::horizontal("floor", -1.5, 2, true, support::diffuse(0.5F)));
    desc.shapes.push_back(
        support::rectangle("mirror", {2, 0, 0}, {0, 1, 0}, {0, 0, 1}, support::mirror(0.5F)));
    const Scene scene(std::move(desc));
    const AimedEmission emission(scene);
    for (const int max_bounces : {1, 3, 16}) {
        const LightPathSettings settings{max_bounces};
        std::vector<LightPathStart> starts;
        for (std::uint64_t path = 0; starts.size() < 5000; ++path) {
            Rng rng(3, Stage::test, path);
            if (const auto particle = emission.emit(rng)) starts.push_back({*particle, rng});
        }
        std::vector<LightPathStart> side_by_side = starts;
        std::vector<DepositOfMany> many(1);
        many[0].start = starts.size();  // of others, before
        LightPathCounts together, alone;
        trace_light_paths(scene, side_by_side, settings, together, many);
        ASSERT_EQ(many[0].start, starts.size());
        many.erase(many.begin());
        EXPECT_TRUE(std::ranges::is_sorted(many, {}, &DepositOfMany::start));
        std::vector<std::optional<Deposit>> deposits(starts.size());
        for (const DepositOfMany& one : many) deposits[one.start] = one.deposit;
        for (std::size_t i = 0; i < starts.size(); ++i) {
            const auto expected =
                trace_one(scene, starts[i].particle, settings, starts[i].rng, alone);
            ASSERT_EQ(deposits[i].has_value(), expected.has_value()) << i;
            if (!expected) continue;
            EXPECT_EQ(deposits[i]->shape, expected->shape);
            EXPECT_EQ(deposits[i]->bounces, expected->bounces);
            EXPECT_LT((deposits[i]->position - expected->position).norm(), 1e-4F);
            EXPECT_LT((deposits[i]->wi - expected->wi).norm(), 1e-4F);
            EXPECT_LT((deposits[i]->flux - expected->flux).matrix().norm(),
                      1e-4F * expected->flux.matrix().norm());
        }
        EXPECT_EQ(together.stored, alone.stored);
        EXPECT_EQ(together.reflected, alone.reflected);
        EXPECT_EQ(together.refracted, alone.refracted);
        EXPECT_EQ(together.depth_limited, alone.depth_limited);
        EXPECT_GT(together.stored, 100U);
    }
}

// Light through glass that hardly bends it: what arrives is white but for the chance in its wavelengths.
TEST(LightPath, PathsThatGoTogetherShareOutTheWavelengths) {
    SceneDesc desc;
    desc.shapes = {support::horizontal("floor", 0, 3, true, support::diffuse(0.5F)),
                   support::sphere("ball", {0, 0, 1}, 0.5, support::glass(1))};
    std::get<Dielectric>(desc.shapes[1].bsdf.model).int_ior = Ior::cauchy(1, 1e-5);
    const Scene scene(std::move(desc));
    constexpr std::size_t count = 729;  // whole periods of the base 3
    const auto error = [&](std::optional<double> shift) {
        std::vector<LightPathStart> starts;
        for (std::size_t i = 0; i < count; ++i)
            starts.push_back({{{Vec3(0.1F, 0.1F, 3), -Vec3::UnitZ()}, Spectrum::Ones()},
                              Rng(5, Stage::test, i),
                              i});
        LightPathCounts counts;
        std::vector<DepositOfMany> deposits;
        trace_light_paths(scene, starts, {.wavelength_shift = shift}, counts, deposits);
        EXPECT_EQ(deposits.size(), count);
        Spectrum mean = black();
        for (const DepositOfMany& each : deposits) mean += each.deposit.flux / count;
        return (mean - 1).abs().maxCoeff();
    };
    EXPECT_LT(error(0.3), 0.01F);
    EXPECT_GT(error({}), 0.01F);
}

TEST(LightPath, RouletteKeepsTheMeanOfEveryChannel) {
    SceneDesc desc;
    desc.shapes.push_back(support::horizontal("mirror", 0, 1, true, support::mirror()));
    std::get<Conductor>(desc.shapes.back().bsdf.model).specular_reflectance =
        Spectrum(0.9F, 0.4F, 0);
    desc.shapes.push_back(support::horizontal("roof", 2, 1, false, support::diffuse(0.5F)));
    const Scene scene(std::move(desc));
    const LightParticle particle{{Vec3(0, 0, 1), -Vec3::UnitZ()}, Spectrum(1, 2, 3)};
    std::array<support::Moments, 3> flux;
    LightPathCounts counts;
    for (std::uint64_t path = 0; path < paths; ++path) {
        Rng rng(1, Stage::test, path);
        const auto deposit = trace_one(scene, particle, {16}, rng, counts);
        for (int channel = 0; channel < 3; ++channel)
            flux[static_cast<std::size_t>(channel)].add(
                deposit ? static_cast<double>(deposit->flux[channel]) : 0.0);
    }
    EXPECT_NEAR(flux[0].mean(), 0.9, 4 * flux[0].standard_error());
    EXPECT_NEAR(flux[1].mean(), 0.8, 4 * flux[1].standard_error());
    EXPECT_EQ(flux[2].mean(), 0);
    EXPECT_EQ(counts.absorbed + counts.stored, paths);
}

// A cube of glass whose smooth normals run over its edges, and the same shaded flat.
TEST(LightPath, CountsWhatSmoothNormalsMisdirect) {
    for (const bool smooth : {true, false}) {
        TriangleMesh cube = tessellate_cube(2);
        cube.normals.clear();
        if (smooth) complete_normals(cube);
        SceneDesc desc;
        desc.shapes = {support::mesh("cube", cube, Transform::Identity(), support::glass(1.5F)),
                       support::enclosure(10, support::diffuse(0.5F))};
        desc.lights = {support::point_light({0, 0.3, 4}, 1)};
        const Scene scene(std::move(desc));
        LightPathCounts by_chance, branches;
        std::vector<Deposit> deposits;
        send(AimedEmission(scene), [&](const LightParticle& particle, Rng& rng) {
            trace_one(scene, particle, {100}, rng, by_chance);
            trace_split_path(scene, particle, {100, Interaction::split}, rng, branches, deposits);
        });
        EXPECT_GT(by_chance.refracted, 1'000U);
        for (const LightPathCounts& counts : {by_chance, branches}) {
            Counters named;
            counts.add_to(named);
            EXPECT_EQ(named.at("photons_misdirected"), counts.misdirected);
            EXPECT_EQ(counts.misdirected > by_chance.stored / 50, smooth);
            EXPECT_EQ(counts.misdirected == 0, !smooth);
        }
        EXPECT_EQ(by_chance.absorbed, 0U) << "nothing here absorbs";
    }
}

TEST(LightPath, BlackParticlesAndDeepChainsEnd) {
    SceneDesc desc;
    desc.shapes.push_back(support::horizontal("low", 0, 1, true, support::mirror()));
    desc.shapes.push_back(support::horizontal("high", 1, 1, false, support::mirror()));
    const Scene scene(std::move(desc));
    Rng rng(1, Stage::test, 0);
    LightPathCounts counts;
    const Ray ray{Vec3(0, 0, 0.5F), Vec3::UnitZ()};
    EXPECT_FALSE(trace_one(scene, {ray, Spectrum(Spectrum::Ones())}, {60}, rng, counts));
    EXPECT_EQ(counts.depth_limited, 1U);
    EXPECT_EQ(counts.reflected, 60U);
    EXPECT_FALSE(trace_one(scene, {ray, black()}, {60}, rng, counts));
    EXPECT_EQ(counts.absorbed, 1U);
    LightPathCounts branches;
    std::vector<Ray> traced;
    std::vector<Deposit> deposits;
    trace_split_path(scene, {ray, Spectrum(Spectrum::Ones())}, {60, Interaction::split, &traced},
                     rng, branches, deposits);
    EXPECT_TRUE(deposits.empty());
    EXPECT_EQ(branches.depth_limited, 1U);
    EXPECT_EQ(branches.reflected, 60U);
    ASSERT_EQ(traced.size(), 61U);
    for (std::size_t i = 1; i < traced.size(); ++i)
        EXPECT_EQ(traced[i].direction, -traced[i - 1].direction);
}

TEST(LightPath, CountsAddUpOneByOne) {
    Counters named;
    LightPathCounts().add_to(named);
    EXPECT_EQ(named.size(), 13U);
    for (std::uint64_t next = 1; auto& [name, count] : named) count = next++;
    LightPathCounts sum = light_path_counts(named);
    sum.add(light_path_counts(named));
    Counters twice;
    sum.add_to(twice);
    for (const auto& [name, count] : named) EXPECT_EQ(twice.at(name), 2 * count) << name;
}

// The counters of a method that traces no light, or of an older record, have none or some of them.
TEST(LightPath, CountsThatAreNotThereAreZero) {
    const LightPathCounts counts =
        light_path_counts({{"gathers", 7}, {"photons_emitted", 5}, {"photons_stored", 3}});
    EXPECT_EQ(counts.emitted, 5U);
    EXPECT_EQ(counts.stored, 3U);
    EXPECT_EQ(counts.aimed + counts.missed + counts.escaped + counts.misdirected + counts.dropped,
              0U);
}

// Between a mirror and a ceiling that scatters three parts and mirrors one, each of 0.8, light is left at the ceiling again and
// again: 1 + 0.2 + 0.2^2 + ... of what comes first, in one branch after another, each of which has its end.
TEST(LightPath, SplitLightIsLeftAtEveryReceiverThatMirrors) {
    Bsdf blend = support::diffuse(0.8F);
    blend.mirror = MirrorPart{0.25F, Spectrum(Spectrum::Constant(0.8F))};
    SceneDesc desc;
    desc.shapes = {support::horizontal("mirror", 0, 1, true, support::mirror()),
                   support::horizontal("ceiling", 2, 1, false, blend)};
    const Scene scene(std::move(desc));
    const LightParticle particle{{Vec3(0.1F, 0.2F, 1), -Vec3::UnitZ()}, Spectrum(1, 2, 3)};
    support::Moments flux;
    LightPathCounts counts;
    std::vector<Deposit> deposits;
    for (std::uint64_t path = 0; path < paths; ++path) {
        Rng rng(1, Stage::test, path);
        deposits.clear();
        trace_split_path(scene, particle, {100, Interaction::split}, rng, counts, deposits);
        double sum = 0;
        for (const Deposit& deposit : deposits) sum += static_cast<double>(deposit.flux[2]) / 3;
        flux.add(sum);
    }
    EXPECT_NEAR(flux.mean(), 1.25, 4 * flux.standard_error());
    EXPECT_EQ(counts.stored, paths + counts.branched);
    EXPECT_GT(counts.branched, paths);
    EXPECT_EQ(counts.absorbed + counts.misdirected + counts.depth_limited, 0U)
        << "light branches end where they have left a deposit";
}

TEST(LightPath, TellsBlackSidesFromBlackWater) {
    // Light falls through a sheet of water onto a floor that faces down, up, and under ink.
    const auto counts_of = [](bool up, float absorption) {
        SceneDesc desc;
        desc.shapes.push_back(support::horizontal(
            "water", 1, 1, true, support::glass(1.33F, 1, Spectrum::Constant(absorption))));
        desc.shapes.push_back(support::horizontal("floor", 0, 2, up, support::diffuse(0.5F)));
        desc.lights.push_back(support::point_light({0, 0, 3}, 1));
        const Scene scene(std::move(desc));
        LightPathCounts counts;
        send(AimedEmission(scene), [&](const LightParticle& particle, Rng& rng) {
            const auto deposit = trace_one(scene, particle, {16}, rng, counts);
            EXPECT_TRUE(!deposit || deposit->front);
        });
        return counts;
    };
    const LightPathCounts lit = counts_of(true, 0), turned = counts_of(false, 0),
                          inky = counts_of(true, 1000);
    EXPECT_GT(lit.refracted, 20 * lit.reflected);
    EXPECT_EQ(lit.stored, lit.refracted);
    EXPECT_EQ(turned.on_black_side, turned.refracted);
    EXPECT_EQ(inky.absorbed, inky.refracted);
    for (const LightPathCounts& counts : {lit, turned, inky}) {
        Counters named;
        counts.add_to(named);
        EXPECT_EQ(named.at("photons_refracted"), counts.refracted);
        EXPECT_EQ(light_path_counts(named).on_black_side, counts.on_black_side);
        EXPECT_EQ(counts.escaped, counts.reflected);
    }
}

// A floor that scatters and mirrors on its front is black below: a path that comes there ends, once.
TEST(LightPath, EndsOnceOnTheBlackSideOfAFloorThatMirrors) {
    Bsdf blend = support::diffuse(0.8F);
    blend.mirror = MirrorPart{0.5F, Spectrum(Spectrum::Constant(0.9F))};
    SceneDesc desc;
    desc.shapes = {support::horizontal("water", 1, 1, true, support::glass(1.33F)),
                   support::horizontal("floor", 0, 1, false, blend)};  // in the water's shadow
    desc.lights = {support::point_light({0, 0, 3}, 1)};
    const Scene scene(std::move(desc));
    LightPathCounts counts;
    std::uint64_t sent = 0;
    send(AimedEmission(scene), [&](const LightParticle& particle, Rng& rng) {
        ++sent;
        EXPECT_FALSE(trace_one(scene, particle, {16}, rng, counts));
    });
    EXPECT_GT(counts.on_black_side, sent / 4);
    EXPECT_EQ(counts.absorbed, 0U);
    EXPECT_EQ(counts.missed + counts.escaped + counts.on_black_side, sent);
}

}  // namespace
}  // namespace caustics
