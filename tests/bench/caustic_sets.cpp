#include "tests/bench/caustic_sets.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "core/geometry/tessellate.h"
#include "core/light_path/light_path.h"
#include "core/math/rng.h"
#include "tests/support/build_scene.h"

namespace caustics::bench {

namespace {

constexpr double water_level = 1;
constexpr double water_half = 1.05;
const Vec3d water_light{0.2, -0.1, 4};
const Vec3d ball_centre{0, 0, 0.35};
constexpr double ball_radius = 0.3;
const Vec3d ball_light{-1.2, 0.4, 1.6};
constexpr std::uint64_t seed = 1996;

SineHeightfield six_sines() {
    SineHeightfield field;
    field.waves = {{0.012, {7.1, 2.3}, 0.4},    {0.010, {-4.2, 8.6}, 1.9},
                   {0.006, {12.7, -6.1}, 3.1},  {0.004, {5.3, 17.9}, 5.2},
                   {0.003, {-21.4, 11.2}, 0.9}, {0.002, {18.6, 24.3}, 2.6}};
    field.half_size = {water_half, water_half};
    return field;
}

/// Aim points of path 0, 1, 2, ... in the unit square.
class AimPoints {
public:
    AimPoints(Arrival arrival, std::size_t expected_paths)
        : arrival_(arrival),
          side_(static_cast<std::size_t>(std::sqrt(static_cast<double>(expected_paths)))) {
        if (arrival != Arrival::shuffled_strata) return;
        cells_.resize(side_ * side_);
        std::iota(cells_.begin(), cells_.end(), 0U);
        Rng rng(seed, Stage::test, 1U << 31U);
        for (std::size_t i = cells_.size() - 1; i > 0; --i)
            std::swap(cells_[i], cells_[rng.next_word() % (i + 1)]);
    }
    std::size_t most_paths() const {
        const bool strata =
            arrival_ == Arrival::shuffled_strata || arrival_ == Arrival::scanline_strata;
        return strata ? side_ * side_ : static_cast<std::size_t>(-1);
    }
    Vec2d operator()(std::size_t path, Rng& rng) const {
        const auto u = static_cast<double>(rng.next()), v = static_cast<double>(rng.next());
        if (arrival_ == Arrival::random) return {u, v};
        const auto number = static_cast<double>(path);
        if (arrival_ == Arrival::r2)
            return {std::fmod(0.7548776662466927 * number, 1.0),
                    std::fmod(0.5698402909980532 * number, 1.0)};
        const std::size_t cell = arrival_ == Arrival::shuffled_strata ? cells_[path] : path;
        const auto side = static_cast<double>(side_);
        return {(static_cast<double>(cell % side_) + u) / side,
                (static_cast<double>(cell / side_) + v) / side};
    }

private:
    Arrival arrival_;
    std::size_t side_;
    std::vector<std::uint32_t> cells_;
};

/// The ray from the light to an aim point: on the water's rectangle, or uniform in the cone that
/// holds the ball.
Ray aimed_ray(Caustic caustic, const Vec2d& aim) {
    if (caustic == Caustic::water) {
        const Vec3d target((2 * aim.x() - 1) * water_half, (2 * aim.y() - 1) * water_half,
                           water_level);
        return {water_light.cast<float>(), (target - water_light).normalized().cast<float>()};
    }
    const Vec3d axis = ball_centre - ball_light;
    const double sine = ball_radius / axis.norm();
    const double cosine = 1 - aim.y() * (1 - std::sqrt(1 - sine * sine));
    const Vec3d w = axis.normalized(), u = w.unitOrthogonal(), v = w.cross(u);
    const double angle = 2 * pi_d * aim.x(), across = std::sqrt(1 - cosine * cosine);
    const Vec3d direction = w * cosine + across * (u * std::cos(angle) + v * std::sin(angle));
    return {ball_light.cast<float>(), direction.normalized().cast<float>()};
}

/// About how many paths store a photon.
double stored_share(const Scene& scene, Caustic caustic) {
    constexpr std::size_t paths = 20'000;
    LightPathCounts counts;
    std::vector<Deposit> stored;
    for (std::size_t path = 0; path < paths; ++path) {
        Rng rng(seed + 1, Stage::test, path);
        const double u = static_cast<double>(rng.next()), v = static_cast<double>(rng.next());
        const LightParticle particle{aimed_ray(caustic, {u, v}), Spectrum::Ones()};
        trace_light_path(scene, particle, {16}, rng, counts, stored);
    }
    return static_cast<double>(stored.size()) / paths;
}

photonmap::Photon photon_of(const Deposit& deposit) {
    const photonmap::DirectionCode wi = photonmap::encode_direction(deposit.wi);
    const Vec3& x = deposit.position;
    return {{x.x(), x.y(), x.z()}, photonmap::encode_rgbe(deposit.flux), wi.theta, wi.phi, 0};
}

}  // namespace

const char* name(Caustic caustic) { return caustic == Caustic::water ? "a" : "b"; }

const char* name(Arrival arrival) {
    switch (arrival) {
        case Arrival::shuffled_strata: return "shuffled_strata";
        case Arrival::r2: return "r2";
        case Arrival::scanline_strata: return "scanline_strata";
        case Arrival::random: break;
    }
    return "random";
}

double floor_half(Caustic caustic) { return caustic == Caustic::water ? 1.0 : 0.75; }

SceneDesc caustic_scene(Caustic caustic) {
    SceneDesc desc;
    const bool water = caustic == Caustic::water;
    const Bsdf medium = support::glass(water ? 1.333F : 1.5F);
    Shape caster = water ? support::mesh("water", tessellate_heightfield(six_sines(), 128),
                                         Transform(Eigen::Translation3d(0, 0, water_level)), medium)
                         : support::mesh("ball", tessellate_sphere(128),
                                         Transform(Eigen::Translation3d(ball_centre) *
                                                   Eigen::Scaling(ball_radius)),
                                         medium);
    desc.shapes = {std::move(caster), support::horizontal("floor", 0, floor_half(caustic), true,
                                                          support::schlick(0.8F, 0.1F))};
    desc.lights = {support::point_light(water ? water_light : ball_light, 10)};
    return desc;
}

std::vector<photonmap::Photon> caustic_photons(Caustic caustic, Arrival arrival,
                                               std::size_t count) {
    const Scene scene(caustic_scene(caustic));
    // Some more than are needed on average.
    const double paths = static_cast<double>(count) / stored_share(scene, caustic);
    const AimPoints aim(arrival, static_cast<std::size_t>(1.02 * paths + 50 * std::sqrt(paths)));
    std::vector<photonmap::Photon> photons;
    photons.reserve(count);
    std::vector<Deposit> deposits;
    LightPathCounts counts;
    for (std::size_t path = 0; photons.size() < count; ++path) {
        if (path == aim.most_paths()) throw std::runtime_error("too few strata for the photons");
        Rng rng(seed, Stage::photons, path);
        const LightParticle particle{aimed_ray(caustic, aim(path, rng)), Spectrum::Ones()};
        deposits.clear();
        trace_light_path(scene, particle, {16}, rng, counts, deposits);
        for (const Deposit& deposit : deposits) photons.push_back(photon_of(deposit));
    }
    return photons;
}

Queries scanlines(Caustic caustic, int width, int height, int bands, int band_rows) {
    Queries queries;
    queries.width = width;
    const double half = floor_half(caustic);
    for (int band = 0; band < bands; ++band) {
        const int first = (2 * band + 1) * height / (2 * bands) - band_rows / 2;
        for (int row = first; row < first + band_rows; ++row)
            for (int column = 0; column < width; ++column) {
                queries.points.push_back(
                    static_cast<float>(half * (2 * (column + 0.5) / width - 1)));
                queries.points.push_back(static_cast<float>(half * (1 - 2 * (row + 0.5) / height)));
                queries.points.push_back(0);
            }
    }
    return queries;
}

float max_radius(Caustic caustic, std::size_t k, std::size_t n) {
    const double area = 4 * floor_half(caustic) * floor_half(caustic);
    return static_cast<float>(
        3 * std::sqrt(static_cast<double>(k) * area / (pi_d * static_cast<double>(n))));
}

}  // namespace caustics::bench
