#include "tests/cruel/floor_light.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/light_path/light_path.h"
#include "tests/support/build_scene.h"

namespace caustics::cruel {

namespace {

constexpr int side = 3;
// Discs stay inside their squares, whatever rounding does.
constexpr double disc_share = 0.999;

/// Sums of what falls into cells, path by path.
struct Tally {
    std::array<std::array<double, 3>, FloorLight::squares + 1> sum{}, squares{};

    void add(std::size_t cell, const Spectrum& value) {
        for (std::size_t c = 0; c < 3; ++c) {
            const auto v = static_cast<double>(value[static_cast<Eigen::Index>(c)]);
            sum[cell][c] += v;
            squares[cell][c] += v * v;
        }
    }
    /// Means over n draws, over these areas. What rare draws bring is unsure by `one` of them at least.
    FloorLight::Cells cells(double n, double area, double area_of_all, double one = 0) const {
        FloorLight::Cells all;
        for (std::size_t cell = 0; cell < all.size(); ++cell)
            for (std::size_t c = 0; c < 3; ++c) {
                const double over = cell == FloorLight::squares ? area_of_all : area;
                const double mean = sum[cell][c] / n;
                const double variance =
                    std::max(0.0, squares[cell][c] / n - mean * mean) / n + one * one / (n * n);
                all[cell][c] = {mean / over, variance / (over * over)};
            }
        return all;
    }
};

constexpr auto in_all = static_cast<std::size_t>(FloorLight::squares);

struct FloorPlace {
    std::size_t square;
    bool in_disc;  ///< that the square holds
};

/// Of a point on the rectangle from -1 to 1.
FloorPlace floor_place(const Vec3d& local) {
    const auto index = [](double x) {
        return std::clamp(static_cast<int>((x + 1) / 2 * side), 0, side - 1);
    };
    const int i = index(local.x()), j = index(local.y());
    const Vec2d middle((2 * i + 1.0) / side - 1, (2 * j + 1.0) / side - 1);
    return {static_cast<std::size_t>(side * j + i),
            (local.head<2>() - middle).norm() * side <= disc_share};
}

}  // namespace

FloorAsked::FloorAsked(const Scene& scene, std::uint64_t seed) : scene_(scene), seed_(seed) {
    const auto& shapes = scene.shapes();
    const auto found = std::ranges::find_if(
        shapes, [](const Shape& shape) { return shape.name.starts_with("floor"); });
    if (found == shapes.end()) throw std::logic_error("the scene has no floor");
    floor_ = static_cast<std::uint32_t>(found - shapes.begin());
    radius_ = disc_share * found->to_world.linear().col(0).norm() / side;
}

FloorLight FloorAsked::by_particles(const support::Emit& emit, std::uint64_t paths,
                                    int max_bounces) const {
    const Shape& floor = scene_.shapes()[floor_];
    const Transform to_local = floor.to_world.inverse();
    Tally squares, discs;
    LightPathCounts counts;
    double sent = 0;
    Eigen::Array3d on_casters = Eigen::Array3d::Zero();
    std::vector<Deposit> deposits;
    for (std::uint64_t path = 0; path < paths; ++path) {
        Rng rng(seed_, Stage::test, path);
        const auto particle = emit(rng);
        if (!particle) continue;
        ++counts.aimed;
        sent += static_cast<double>(particle->flux.maxCoeff());
        deposits.clear();
        const std::uint64_t missed = counts.missed;
        trace_light_path(scene_, *particle, {max_bounces}, rng, counts, deposits);
        if (counts.missed == missed) on_casters += particle->flux.cast<double>();
        for (const Deposit& d : deposits) {
            if (d.shape != floor_ || !d.front) continue;
            const auto place = floor_place(to_local * d.position.cast<double>());
            for (const std::size_t cell : {place.square, in_all}) squares.add(cell, d.flux);
            if (!place.in_disc) continue;
            for (const std::size_t cell : {place.square, in_all}) discs.add(cell, d.flux);
        }
    }
    const double area = std::pow(2 * radius_ / disc_share, 2), disc = pi_d * radius_ * radius_;
    const auto n = static_cast<double>(paths);
    FloorLight light;
    for (std::size_t c = 0; c < 3; ++c)
        light.on_casters[c] =
            on_casters[static_cast<Eigen::Index>(c)] / (n * FloorLight::squares * area);
    const double one = counts.aimed > 0 ? sent / static_cast<double>(counts.aimed) : 0;
    light.in_squares = squares.cells(n, area, FloorLight::squares * area, one);
    light.in_discs = discs.cells(n, disc, FloorLight::squares * disc, one);
    return light;
}

ReceiverPoint FloorAsked::point(double x, double y, std::uint64_t id) const {
    const Shape& floor = scene_.shapes()[floor_];
    const Vec3d normal = floor.to_world.linear().col(2).normalized();
    ReceiverPoint p = support::probe(scene_, floor_, floor.to_world * Vec3d(x, y, 0), normal, id,
                                     static_cast<float>(radius_));
    p.shape = floor_;
    p.uv = {static_cast<float>((x + 1) / 2), static_cast<float>((y + 1) / 2)};
    return p;
}

FloorLight FloorAsked::at_points(const experiments::Method& method, int n, bool jittered) const {
    RunOptions options;
    options.seed = seed_ + 1;
    const auto built = method.configured->build(scene_, options, 0);
    Rng rng(seed_ + 2, Stage::test, 0);
    std::vector<ReceiverPoint> points;
    std::vector<std::size_t> cells;
    const int across = side * n;
    for (int j = 0; j < across; ++j)
        for (int i = 0; i < across; ++i) {
            const double u = jittered ? rng.next_fine() : 0.5, v = jittered ? rng.next_fine() : 0.5;
            const double x = 2 * (i + u) / across - 1, y = 2 * (j + v) / across - 1;
            points.push_back(point(x, y, points.size()));
            cells.push_back(static_cast<std::size_t>(side * (j / n) + i / n));
        }
    const auto answers = support::irradiance(*built, points);
    FloorLight light;
    const double asked = n * n, in_whole = asked * FloorLight::squares;
    // Two neighbours tell how unsure each of them is.
    for (std::size_t i = 0; i + 1 < answers.size(); i += 2)
        for (std::size_t c = 0; c < 3; ++c) {
            const auto channel = static_cast<Eigen::Index>(c);
            const auto a = static_cast<double>(answers[i].value[channel]);
            const auto b = static_cast<double>(answers[i + 1].value[channel]);
            const double squared = (a - b) * (a - b);
            Measured &one = light.in_squares[cells[i]][c], &all = light.in_squares[in_all][c];
            one.value += (a + b) / asked;
            one.variance += squared / (asked * asked);
            all.value += (a + b) / in_whole;
            all.variance += squared / (in_whole * in_whole);
        }
    const auto report = built->build_report();
    const auto captured = report.resolved.find("flux_share_captured");
    if (captured != report.resolved.end()) light.share_lost = 1 - captured->second;
    return light;
}

FloorLight FloorAsked::over_discs(const experiments::Method& method, int seeds) const {
    Tally tally;
    for (int seed = 0; seed < seeds; ++seed) {
        RunOptions options;
        options.seed = seed_ + 3 + static_cast<std::uint64_t>(seed);
        const auto built = method.configured->build(scene_, options, 0);
        std::vector<ReceiverPoint> points;
        for (int j = 0; j < side; ++j)
            for (int i = 0; i < side; ++i)
                points.push_back(
                    point((2 * i + 1.0) / side - 1, (2 * j + 1.0) / side - 1, points.size()));
        const auto answers = support::irradiance(*built, points);
        Spectrum all = black();
        for (std::size_t i = 0; i < answers.size(); ++i) {
            tally.add(i, answers[i].value);
            all += answers[i].value / FloorLight::squares;
        }
        tally.add(in_all, all);
    }
    FloorLight light;
    light.in_discs = tally.cells(seeds, 1, 1);
    for (auto& cell : light.in_discs)
        for (Measured& m : cell) m.variance *= seeds / (seeds - 1.0);
    return light;
}

}  // namespace caustics::cruel
