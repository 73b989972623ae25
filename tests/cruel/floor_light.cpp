#include "tests/cruel/floor_light.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/light_path/emission_samples.h"
#include "core/light_path/light_path.h"
#include "core/light_path/stratified_square.h"
#include "core/reference/ordered_paths.h"
#include "tests/support/build_scene.h"

namespace caustics::cruel {

namespace {

constexpr int side = FloorCells::side;
// Discs stay inside their squares, whatever rounding does.
constexpr double disc_share = 0.999;
// Share of the light on casters that a few particles in a million bring.
constexpr double faintest = 1e-5;

/// The number of a position from -1 to 1 in a row of `count`.
int index_of(double x, int count) {
    return std::clamp(static_cast<int>((x + 1) / 2 * count), 0, count - 1);
}

std::size_t square_of(const Vec3d& local) {
    return static_cast<std::size_t>(side * index_of(local.y(), side) + index_of(local.x(), side));
}

std::size_t part_of(const Vec3d& local) {
    constexpr int parts = ParticleLight::parts;
    return static_cast<std::size_t>(parts * index_of(local.y(), parts) +
                                    index_of(local.x(), parts));
}

/// The disc inside the square.
bool is_in_disc(const Vec3d& local, std::size_t square) {
    const auto i = static_cast<int>(square) % side, j = static_cast<int>(square) / side;
    const Vec2d middle((2 * i + 1.0) / side - 1, (2 * j + 1.0) / side - 1);
    return (local.head<2>() - middle).norm() * side <= disc_share;
}

using Sums = std::array<std::array<double, 3>, FloorCells::squares + 1>;

void add(Sums& sums, std::size_t square, const Spectrum& value) {
    for (std::size_t c = 0; c < 3; ++c) {
        const auto v = static_cast<double>(value[static_cast<Eigen::Index>(c)]);
        sums[square][c] += v;
        sums[FloorCells::all][c] += v;
    }
}

/// The mean of independent batches, with the variance of their scatter.
FloorCells mean_of(const std::vector<FloorCells>& batches) {
    FloorCells mean;
    const auto n = static_cast<double>(batches.size());
    for (std::size_t cell = 0; cell < mean.cells.size(); ++cell)
        for (std::size_t c = 0; c < 3; ++c) {
            Measured& m = mean.at(cell, c);
            for (const FloorCells& one : batches) m.value += one.at(cell, c).value / n;
            for (const FloorCells& one : batches)
                m.variance += std::pow(one.at(cell, c).value - m.value, 2) / (n * (n - 1));
        }
    return mean;
}

FloorCells minus(const FloorCells& a, const FloorCells& b) {
    FloorCells difference;
    for (std::size_t cell = 0; cell < a.cells.size(); ++cell)
        for (std::size_t c = 0; c < 3; ++c)
            difference.at(cell, c) = {a.at(cell, c).value - b.at(cell, c).value,
                                      a.at(cell, c).variance + b.at(cell, c).variance};
    return difference;
}

/// Values of sums over one square's area; the whole floor has that of all.
FloorCells over_area(const Sums& sums, double area) {
    FloorCells cells;
    for (std::size_t cell = 0; cell < sums.size(); ++cell)
        for (std::size_t c = 0; c < 3; ++c)
            cells.at(cell, c).value =
                sums[cell][c] / (cell == FloorCells::all ? FloorCells::squares * area : area);
    return cells;
}

double share_lost(const PointEstimator& built) {
    const auto report = built.build_report();
    const auto captured = report.resolved.find("flux_share_captured");
    return captured == report.resolved.end() ? 0 : 1 - captured->second;
}

}  // namespace

std::size_t FloorCells::brightest() const {
    const auto& last = cells.back();
    return static_cast<std::size_t>(std::ranges::max_element(last, {}, &Measured::value) -
                                    last.begin());
}

double FloorCells::relative_error() const {
    const Measured& m = at(all, brightest());
    return m.value > 0 ? std::sqrt(m.variance) / m.value : 1;
}

/// Points of a grid's parts, two in each of the squares that a part is divided into.
struct FloorAsked::PointSet {
    std::vector<ReceiverPoint> points;
    std::vector<std::size_t> square;  ///< of each pair
    std::vector<double> share;        ///< of the floor's area that a pair stands for
};

FloorAsked::FloorAsked(const Scene& scene, std::uint64_t seed, int max_bounces)
    : scene_(scene), emission_(scene), seed_(1000 * seed), max_bounces_(max_bounces) {
    const auto& shapes = scene.shapes();
    const auto found = std::ranges::find_if(
        shapes, [](const Shape& shape) { return shape.name.starts_with("floor"); });
    if (found == shapes.end()) throw std::logic_error("the scene has no floor");
    floor_ = static_cast<std::uint32_t>(found - shapes.begin());
    to_local_ = found->to_world.inverse();
    half_ = found->to_world.linear().col(0).norm();
}

double FloorAsked::disc_radius() const { return disc_share * half_ / side; }

ParticleLight FloorAsked::stratified(std::uint64_t strata) const {
    constexpr int batches = 16;
    const StratifiedSquare grid = StratifiedSquare::at_least(strata);
    const LightPathSettings settings{.max_bounces = max_bounces_,
                                     .interaction = Interaction::split};
    const double area = std::pow(2 * half_ / side, 2);
    ParticleLight found;
    std::vector<FloorCells> all;
    LightPathCounts counts;
    EmissionSamples samples;
    std::vector<LightPathStart> starts;
    std::vector<Deposit> deposits;
    for (std::uint64_t batch = 0; batch < batches; ++batch) {
        Sums sums{};
        for (std::uint64_t first = 0; first < grid.size(); first += samples.size()) {
            const std::size_t count =
                std::min<std::uint64_t>(grid.size() - first, EmissionSamples::most);
            samples.draw({seed_, static_cast<std::uint32_t>(Stage::test),
                          batch * grid.size() + first, count},
                         emission_.kernels());
            grid.place(first, samples.x(), samples.y());
            starts.clear();
            emission_.emit(samples, starts);
            for (LightPathStart& start : starts) {
                deposits.clear();
                const std::uint64_t missed = counts.missed;
                trace_split_path(scene_, start.particle, settings, start.rng, counts, deposits);
                if (counts.missed == missed)
                    found.on_casters += static_cast<double>(start.particle.flux.maxCoeff());
                for (const Deposit& d : deposits) {
                    if (d.shape != floor_ || !d.front) continue;
                    const Vec3d local = to_local_ * d.position.cast<double>();
                    add(sums, square_of(local), d.flux);
                    found.share[part_of(local)] += static_cast<double>(d.flux.mean());
                }
            }
        }
        all.push_back(over_area(sums, area * static_cast<double>(grid.size())));
    }
    found.light = mean_of(all);
    found.on_casters /= static_cast<double>(batches * grid.size()) * FloorCells::squares * area;
    double total = 0;
    for (const double part : found.share) total += part;
    for (double& part : found.share) part /= total > 0 ? total : 1;
    return found;
}

ParticleLight FloorAsked::by_particles(double wanted, std::uint64_t most) const {
    for (std::uint64_t strata = 1024;; strata *= 4) {
        ParticleLight found = stratified(strata);
        const std::uint64_t next = 4 * 16 * strata;
        const bool is_dark =
            found.on_casters <= 0 || (found.light.relative_error() >= 1 && 4 * next > most);
        if (found.light.relative_error() <= wanted || next > most || is_dark) return found;
    }
}

ReceiverPoint FloorAsked::point(double x, double y, std::uint64_t id) const {
    const Shape& floor = scene_.shapes()[floor_];
    const Vec3d normal = floor.to_world.linear().col(2).normalized();
    ReceiverPoint p = support::probe(scene_, floor_, floor.to_world * Vec3d(x, y, 0), normal, id,
                                     static_cast<float>(disc_radius()));
    p.shape = floor_;
    p.uv = {static_cast<float>((x + 1) / 2), static_cast<float>((y + 1) / 2)};
    return p;
}

FloorAsked::PointSet FloorAsked::points_for(const ParticleLight& particles, double count,
                                            std::uint64_t seed) const {
    constexpr int parts = ParticleLight::parts;
    Rng rng(seed, Stage::test, 1);
    PointSet set;
    for (int j = 0; j < parts; ++j)
        for (int i = 0; i < parts; ++i) {
            const double here = count * particles.share[static_cast<std::size_t>(parts * j + i)];
            const int n = std::max(1, static_cast<int>(std::lround(std::sqrt(here / 2))));
            for (int k = 0; k < n * n; ++k) {
                for (int one = 0; one < 2; ++one) {
                    const double x = i + (k % n + rng.next_fine()) / n;
                    const double y = j + (k / n + rng.next_fine()) / n;
                    set.points.push_back(
                        point(2 * x / parts - 1, 2 * y / parts - 1, set.points.size()));
                }
                set.square.push_back(
                    static_cast<std::size_t>(side * (j * side / parts) + i * side / parts));
                set.share.push_back(1.0 / (static_cast<double>(parts * parts) * n * n));
            }
        }
    return set;
}

FloorCells FloorAsked::asked(const PointEstimator& built, const PointSet& set) const {
    const auto answers = support::irradiance(built, set.points);
    FloorCells found;
    for (std::size_t pair = 0; pair < set.square.size(); ++pair)
        for (std::size_t c = 0; c < 3; ++c) {
            const auto channel = static_cast<Eigen::Index>(c);
            const auto a = static_cast<double>(answers[2 * pair].value[channel]);
            const auto b = static_cast<double>(answers[2 * pair + 1].value[channel]);
            for (const std::size_t cell : {set.square[pair], FloorCells::all}) {
                const double share =
                    set.share[pair] * (cell == FloorCells::all ? 1.0 : FloorCells::squares);
                found.at(cell, c).value += share * (a + b) / 2;
                found.at(cell, c).variance += std::pow(share * (a - b) / 2, 2);
            }
        }
    return found;
}

Comparison FloorAsked::at_points(const experiments::Method& method, const ParticleLight& particles,
                                 double wanted, std::size_t most) const {
    RunOptions options;
    options.seed = seed_ + 1;
    const auto built = method.configured->build(scene_, options, 0);
    Comparison found;
    found.truth = particles.light;
    found.faint = faintest * particles.on_casters;
    std::size_t asked_for = 0;
    for (double count = 8000;; count *= 4) {
        const PointSet set = points_for(particles, count, seed_ + 2 + asked_for);
        found.light = asked(*built, set);
        asked_for = set.points.size();
        const double error = found.light.relative_error();
        const bool is_dark = error >= 1 && particles.light.relative_error() >= 1;
        if (error <= wanted || 4 * asked_for > most || is_dark) break;
    }
    found.difference = minus(found.light, found.truth);
    found.share_lost = share_lost(*built);
    return found;
}

std::vector<Spectrum> FloorAsked::answers_at_grid(const experiments::Method& method, int across,
                                                  const RunOptions& options) const {
    const auto built = method.configured->build(scene_, options, 0);
    std::vector<ReceiverPoint> points;
    for (int j = 0; j < across; ++j)
        for (int i = 0; i < across; ++i)
            points.push_back(
                point((2 * i + 1.0) / across - 1, (2 * j + 1.0) / across - 1, points.size()));
    std::vector<Spectrum> values;
    for (const Estimate& e : support::irradiance(*built, points)) values.push_back(e.value);
    return values;
}

namespace {

/// Means over squares of what was answered on a grid over all the floor.
FloorCells means_of_grid(const std::vector<Spectrum>& answers, int across) {
    Sums sums{};
    const int in_square = across / side;
    for (int j = 0; j < across; ++j)
        for (int i = 0; i < across; ++i)
            add(sums, static_cast<std::size_t>(side * (j / in_square) + i / in_square),
                answers[static_cast<std::size_t>(across * j + i)]);
    return over_area(sums, static_cast<double>(in_square * in_square));
}

}  // namespace

Comparison FloorAsked::over_squares(const experiments::Method& method,
                                    const ParticleLight& particles) const {
    RunOptions options;
    options.seed = seed_ + 1;
    constexpr int across = ParticleLight::parts;
    Comparison found;
    found.light = means_of_grid(answers_at_grid(method, across, options), across);
    found.truth = particles.light;
    found.faint = faintest * particles.on_casters;
    found.difference = minus(found.light, found.truth);
    return found;
}

FloorCells FloorAsked::same_particles(std::uint64_t seed, Stage stage, std::uint64_t paths,
                                      double area, const InCell& counts) const {
    const OrderedPaths work{scene_, emission_, paths, max_bounces_, seed, stage};
    Sums sums{};
    LightPathCounts ends;
    for (std::uint64_t chunk = 0; chunk * OrderedPaths::chunk < paths; ++chunk)
        work.trace_chunk(chunk, ends, [&](const Deposit& d, std::uint64_t) {
            if (d.shape != floor_ || !d.front) return;
            const Vec3d local = to_local_ * d.position.cast<double>();
            const std::size_t square = square_of(local);
            if (counts(local, square)) add(sums, square, d.flux);
        });
    return over_area(sums, area * static_cast<double>(paths));
}

Comparison FloorAsked::over_discs(const experiments::Method& method, Stage stage,
                                  std::uint64_t paths) const {
    const double area = pi_d * disc_radius() * disc_radius();
    std::vector<FloorCells> light, truth, difference;
    for (int k = 0; k < seeds; ++k) {
        RunOptions options;
        options.seed = seed_ + 3 + static_cast<std::uint64_t>(k);
        light.push_back(means_of_grid(answers_at_grid(method, side, options), side));
        truth.push_back(same_particles(options.seed, stage, paths, area, is_in_disc));
        difference.push_back(minus(light.back(), truth.back()));
    }
    return {.light = mean_of(light), .truth = mean_of(truth), .difference = mean_of(difference)};
}

Comparison FloorAsked::over_texels(const experiments::Method& method, int texels,
                                   std::uint64_t paths) const {
    const double area = std::pow(2 * half_ / side, 2);
    const auto anywhere = [](const Vec3d&, std::size_t) { return true; };
    std::vector<FloorCells> light, truth, difference;
    for (int k = 0; k < seeds; ++k) {
        RunOptions options;
        options.seed = seed_ + 3 + static_cast<std::uint64_t>(k);
        light.push_back(means_of_grid(answers_at_grid(method, texels, options), texels));
        truth.push_back(
            same_particles(options.seed, Stage::illumination_map, paths, area, anywhere));
        difference.push_back(minus(light.back(), truth.back()));
    }
    return {.light = mean_of(light), .truth = mean_of(truth), .difference = mean_of(difference)};
}

}  // namespace caustics::cruel
