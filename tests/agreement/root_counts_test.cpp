#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "beamtree/beam_tree.h"
#include "core/math/rng.h"
#include "tests/agreement/brute_force_roots.h"
#include "tests/support/build_scene.h"
#include "tests/support/fresnel.h"

namespace caustics {
namespace {

// Beams are asked for the rays that reach a point, and brute force is asked for the same: the number of rays and the
// irradiance have to agree at every point. The optics of this file are written apart from the program's.

/// A scene whose caustic is known as maps from surfaces to the floor.
struct KnownScene {
    std::string name;
    SceneDesc desc;
    std::vector<RayMap> maps;
    double half_floor;  ///< points lie in a square of this half side [m]
    int events;
    int resolution;
};

Vec3d refracted(const Vec3d& direction, const Vec3d& normal, double n) {
    const double cosine = -direction.dot(normal);
    return direction / n + (cosine / n - std::sqrt(1 - (1 - cosine * cosine) / (n * n))) * normal;
}

// No farther than the floor reaches.
std::optional<Vec2d> on_floor(const Vec3d& from, const Vec3d& direction) {
    constexpr double reach = 3;
    if (!(direction.z() < 0)) return {};
    const Vec2d lands = (from - from.z() / direction.z() * direction).head<2>();
    if (!(lands.cwiseAbs().maxCoeff() < reach)) return {};
    return lands;
}

/// Light of a point, or of the sun; in watts per steradian or per square metre.
struct KnownLight {
    std::optional<Vec3d> position;
    Vec3d sun = -Vec3d::UnitZ();
    double strength = 1;

    Vec3d direction(const Vec3d& to) const {
        return position ? Vec3d((to - *position).normalized()) : sun;
    }
    /// Power on a parallelogram of two sides.
    double power(const Vec3d& at, const Vec3d& u, const Vec3d& v) const {
        const double across = std::abs(direction(at).dot(u.cross(v)));
        return strength * (position ? across / (at - *position).squaredNorm() : across);
    }
    Light light() const {
        if (position) return support::point_light(*position, static_cast<float>(strength));
        return support::directional_light(sun, static_cast<float>(strength));
    }
};

/// Water of sines at a height.
struct Waves {
    std::vector<SineWave> waves;
    double level, half_size;

    Vec3d at(const Vec2d& xy) const {
        double z = level;
        for (const SineWave& w : waves)
            z += w.amplitude * std::sin(w.wave_vector.dot(xy) + w.phase);
        return {xy.x(), xy.y(), z};
    }
    Vec2d slope(const Vec2d& xy) const {
        Vec2d sum = Vec2d::Zero();
        for (const SineWave& w : waves)
            sum += w.amplitude * std::cos(w.wave_vector.dot(xy) + w.phase) * w.wave_vector;
        return sum;
    }
    Vec3d normal(const Vec2d& xy) const {
        const Vec2d s = slope(xy);
        return Vec3d(-s.x(), -s.y(), 1).normalized();
    }
    /// Where a ray that goes down comes through.
    Vec2d below(const Vec3d& from, const Vec3d& direction) const {
        double t = (level - from.z()) / direction.z();
        for (int i = 0; i < 20; ++i) {
            const Vec3d p = from + t * direction;
            const Vec2d xy = p.head<2>();
            t -= (p.z() - at(xy).z()) / (direction.z() - slope(xy).dot(direction.head<2>()));
        }
        return (from + t * direction).head<2>();
    }
    Shape shape(const std::string& name, double n) const {
        Shape shape;
        shape.name = name;
        shape.primitive = Primitive::heightfield;
        shape.field.waves = waves;
        shape.field.half_size = {half_size, half_size};
        shape.to_world = Eigen::Translation3d(0, 0, level);
        shape.bsdf = support::glass(static_cast<float>(n));
        return shape;
    }
};

Waves random_waves(Rng& rng, int count, double level, double half_size, double steepness,
                   double longest) {
    Waves all{{}, level, half_size};
    for (int i = 0; i < count; ++i) {
        const double turn = 2 * std::numbers::pi * static_cast<double>(rng.next());
        const double k = longest * (0.4 + 0.6 * static_cast<double>(rng.next()));
        all.waves.push_back({steepness / k / count, k * Vec2d(std::cos(turn), std::sin(turn)),
                             2 * std::numbers::pi * static_cast<double>(rng.next())});
    }
    return all;
}

Shape floor_of(double half) {
    return support::horizontal("floor", 0, half, true, support::diffuse(0.5F));
}

/// Water over a floor, with long folds.
KnownScene pool(std::uint64_t seed) {
    Rng rng(seed, Stage::test, 1);
    constexpr double n = 1.33, half = 2;
    const Waves water = random_waves(rng, 1 + static_cast<int>(seed % 3), 0.8, half,
                                     0.3 + 0.2 * static_cast<double>(rng.next()), 30);
    KnownLight light;
    if (seed % 2 == 0) light.position = Vec3d(0.3, -0.2, 3);
    light.sun = Vec3d(0.1, 0.15, -1).normalized();
    const RayMap map = [=](const Vec2d& uv) -> std::optional<LandedRay> {
        const Vec2d xy = half * (2 * uv - Vec2d::Ones());
        const Vec3d p = water.at(xy);
        const Vec2d s = water.slope(xy);
        const Vec3d normal = water.normal(xy);
        const Vec3d in = light.direction(p);
        const auto lands = on_floor(p, refracted(in, normal, n));
        if (!lands) return {};
        const double passed = 1 - support::fresnel(-in.dot(normal), n);
        return LandedRay{*lands, passed * light.power(p, 2 * half * Vec3d(1, 0, s.x()),
                                                      2 * half * Vec3d(0, 1, s.y()))};
    };
    KnownScene known{"pool " + std::to_string(seed), {}, {map}, 0.9, 1, 128};
    known.desc.shapes = {water.shape("water", n), floor_of(1)};
    known.desc.lights = {light.light()};
    return known;
}

/// A mirror ring that stands round the point light.
KnownScene ring() {
    constexpr double radius = 0.3, foot = 0.01;
    const KnownLight light{.position = Vec3d(0.12, 0.05, 0.5)};
    const RayMap map = [=](const Vec2d& uv) -> std::optional<LandedRay> {
        const double turn = 2 * std::numbers::pi * uv.x();
        const Vec3d outwards(std::cos(turn), std::sin(turn), 0);
        const Vec3d p = radius * outwards + Vec3d(0, 0, foot + radius * uv.y());
        const Vec3d in = light.direction(p);
        const auto lands = on_floor(p, in - 2 * in.dot(outwards) * outwards);
        if (!lands || lands->norm() > radius) return {};
        const Vec3d along = 2 * std::numbers::pi * radius * Vec3d(-outwards.y(), outwards.x(), 0);
        return LandedRay{*lands, light.power(p, along, radius * Vec3d::UnitZ())};
    };
    Shape ring;
    ring.name = "ring";
    ring.primitive = Primitive::cylinder;
    ring.to_world = Eigen::Translation3d(0, 0, foot) * Eigen::Scaling(radius);
    ring.bsdf = support::mirror();
    KnownScene known{"ring", {}, {map}, 0.2, 1, 64};
    known.desc.shapes = {ring, floor_of(1)};
    known.desc.lights = {light.light()};
    return known;
}

/// A glass ball beside the light: its lens, and what it mirrors.
KnownScene ball() {
    constexpr double radius = 0.3, n = 1.5;
    const Vec3d centre(0, 0, 0.5);
    const KnownLight light{.position = Vec3d(1, 0.4, 2.5), .strength = 5};
    // Round the way to the light; the light sees no more than half of the ball.
    const Vec3d pole = (*light.position - centre).normalized();
    const Vec3d side = pole.unitOrthogonal();
    const double widest = std::acos(radius / (*light.position - centre).norm());
    const auto place = [=](const Vec2d& uv, Vec3d& u, Vec3d& v) -> Vec3d {
        const double away = widest * uv.x(), turn = 2 * std::numbers::pi * uv.y();
        const Vec3d round = std::cos(turn) * side + std::sin(turn) * pole.cross(side);
        const Vec3d across = -std::sin(turn) * side + std::cos(turn) * pole.cross(side);
        u = widest * radius * (std::cos(away) * round - std::sin(away) * pole);
        v = 2 * std::numbers::pi * radius * std::sin(away) * across;
        return std::cos(away) * pole + std::sin(away) * round;
    };
    const RayMap lens = [=](const Vec2d& uv) -> std::optional<LandedRay> {
        Vec3d u, v;
        const Vec3d normal = place(uv, u, v);
        const Vec3d p = centre + radius * normal;
        const Vec3d in = light.direction(p);
        if (!(-in.dot(normal) > 0)) return {};
        const Vec3d inside = refracted(in, normal, n);
        const Vec3d q = p - 2 * radius * normal.dot(inside) * inside;
        const Vec3d back = (centre - q) / radius;
        const Vec3d out = refracted(inside, back, 1 / n);
        const auto lands = on_floor(q, out);
        if (!lands) return {};
        const double passed = 1 - support::fresnel(-in.dot(normal), n);
        return LandedRay{*lands, passed * passed * light.power(p, u, v)};
    };
    const RayMap mirror = [=](const Vec2d& uv) -> std::optional<LandedRay> {
        Vec3d u, v;
        const Vec3d normal = place(uv, u, v);
        const Vec3d p = centre + radius * normal;
        const Vec3d in = light.direction(p);
        const double cosine = -in.dot(normal);
        if (!(cosine > 0)) return {};
        const auto lands = on_floor(p, in + 2 * cosine * normal);
        if (!lands) return {};
        return LandedRay{*lands, support::fresnel(cosine, n) * light.power(p, u, v)};
    };
    KnownScene known{"ball", {}, {lens, mirror}, 1.2, 2, 64};
    known.desc.shapes = {
        support::sphere("ball", centre, radius, support::glass(static_cast<float>(n))),
        floor_of(3)};
    known.desc.lights = {light.light()};
    return known;
}

/// Glass with waves on both of its sides.
KnownScene slab() {
    constexpr double n = 1.5, half = 1.5;
    Rng rng(5, Stage::test, 2);
    const Waves top = random_waves(rng, 2, 1, half, 0.25, 9);
    const Waves bottom = random_waves(rng, 2, 0.7, half + 0.5, 0.25, 9);
    const KnownLight light{.position = {}, .sun = Vec3d(0.1, -0.05, -1).normalized()};
    const RayMap map = [=](const Vec2d& uv) -> std::optional<LandedRay> {
        const Vec2d xy = half * (2 * uv - Vec2d::Ones());
        const Vec3d p = top.at(xy);
        const Vec2d s = top.slope(xy);
        const Vec3d normal = top.normal(xy);
        const Vec3d inside = refracted(light.sun, normal, n);
        const Vec2d through = bottom.below(p, inside);
        const Vec3d back = bottom.normal(through);
        const double cosine = -inside.dot(back);
        if (!((1 - cosine * cosine) * n * n < 1)) return {};
        const auto lands = on_floor(bottom.at(through), refracted(inside, back, 1 / n));
        if (!lands) return {};
        const double passed = (1 - support::fresnel(-light.sun.dot(normal), n)) *
                              (1 - support::fresnel(cosine, 1 / n));
        return LandedRay{*lands, passed * light.power(p, 2 * half * Vec3d(1, 0, s.x()),
                                                      2 * half * Vec3d(0, 1, s.y()))};
    };
    KnownScene known{"slab", {}, {map}, 0.8, 2, 64};
    Shape lower = bottom.shape("lower", n);
    lower.flip_normals = true;
    known.desc.shapes = {top.shape("upper", n), lower, floor_of(1)};
    known.desc.lights = {light.light()};
    return known;
}

/// How the beams' light at points differs from brute force.
struct RootScore {
    std::size_t points = 0, rays = 0, folds = 0;
    std::size_t wrong_counts = 0;  ///< points where the numbers of rays differ
    std::size_t rays_found = 0;
    std::size_t wrong_light = 0;  ///< points whose irradiance is off by more than 0.5 %
    double mean_ratio = 0;
};

// Beside a fold, within this of its own size, positions of a float tell neither the number of rays nor their light.
constexpr double too_near_a_fold = 1e-3;

std::vector<Vec2d> random_places(const KnownScene& known, std::size_t count) {
    Rng rng(11, Stage::test, 3);
    const auto along = [&] { return known.half_floor * (2 * static_cast<double>(rng.next()) - 1); };
    std::vector<Vec2d> places;
    for (std::size_t i = 0; i < count; ++i) {
        const double x = along();
        places.emplace_back(x, along());
    }
    return places;
}

RootScore score(KnownScene known, std::vector<Vec2d> places, int side) {
    const std::size_t count = places.size();
    const std::size_t floor = known.desc.shapes.size() - 1;
    const Scene scene(std::move(known.desc));
    beamtree::BeamTreeParams params;
    params.mesh_resolution = known.resolution;
    params.max_bounces = known.events;
    params.prune = 0;  // which leaves out the faint light near a ball's rim
    const auto beams = build(scene, params, {});
    std::vector<ReceiverPoint> points;
    for (Vec2d& place : places) {
        points.push_back(support::probe(scene, static_cast<std::uint32_t>(floor),
                                        {place.x(), place.y(), 0}, Vec3d::UnitZ(), 0));
        place = points.back().position.head<2>().cast<double>();
    }
    const std::vector<LightAtPoint> truth = brute_force_light(known.maps, side, places);
    RootScore score{.points = count};
    double found_sum = 0, true_sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
        Estimate found;
        Counters counters;
        const auto context = beams->make_context();
        beams->irradiance(std::span(&points[i], 1), std::span(&found, 1), *context);
        context->add_to(counters);
        const double value = static_cast<double>(found.value.mean());
        score.rays += truth[i].rays;
        score.rays_found += std::min<std::size_t>(counters["beam_point_hits"], truth[i].rays);
        found_sum += value;
        true_sum += truth[i].irradiance;
        if (truth[i].distinctness < too_near_a_fold) {
            ++score.folds;
            continue;
        }
        if (counters["beam_point_hits"] != truth[i].rays) ++score.wrong_counts;
        if (std::abs(value - truth[i].irradiance) > 5e-3 * truth[i].irradiance + 1e-6)
            ++score.wrong_light;
    }
    score.mean_ratio = found_sum / true_sum;
    return score;
}

std::vector<KnownScene> known_scenes() {
    std::vector<KnownScene> scenes;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) scenes.push_back(pool(seed));
    scenes.push_back(ring());
    scenes.push_back(ball());
    scenes.push_back(slab());
    return scenes;
}

TEST(RootCounts, AreThoseOfBruteForce) {
    for (KnownScene& known : known_scenes()) {
        const std::string name = known.name;
        const std::vector<Vec2d> places = random_places(known, 500);
        const RootScore found = score(std::move(known), places, 500);
        EXPECT_EQ(found.wrong_counts, 0U) << name;
        EXPECT_EQ(found.wrong_light, 0U) << name;
        EXPECT_LT(found.folds, found.points / 50) << name;
    }
}

// Where the model of a polygon's image leads to none of its rays, or to one of two.
TEST(RootCounts, AreRightBesideCusps) {
    const std::vector<Vec2d> of_seventh = {
        {0.717419863, 0.845245719}, {0.309503645, -0.590538502}, {-0.284892023, 0.192864671}};
    const std::vector<Vec2d> of_another = {{-0.491430789, 0.820110381}};
    for (const auto& [seed, places] : {std::pair{7, of_seventh}, {49, of_another}}) {
        const RootScore found = score(pool(static_cast<std::uint64_t>(seed)), places, 1000);
        EXPECT_EQ(found.rays, 3 * places.size()) << seed;
        EXPECT_EQ(found.rays_found, found.rays) << seed;
        EXPECT_EQ(found.wrong_light, 0U) << seed;
    }
}

// The same at many points, from 2000 x 2000 places, as a table.
TEST(RootCounts, DISABLED_TableOfManyPoints) {
    std::printf(
        "| scene | points | rays | found | wrong numbers | wrong light | beside folds | mean |\n");
    std::printf("|---|--:|--:|--:|--:|--:|--:|--:|\n");
    for (KnownScene& known : known_scenes()) {
        const std::string name = known.name;
        const std::vector<Vec2d> places = random_places(known, 10'000);
        const RootScore s = score(std::move(known), places, 2000);
        std::printf("| %s | %zu | %zu | %zu | %zu | %zu | %zu | %.5f |\n", name.c_str(), s.points,
                    s.rays, s.rays_found, s.wrong_counts, s.wrong_light, s.folds, s.mean_ratio);
        std::fflush(stdout);
    }
}

}  // namespace
}  // namespace caustics
