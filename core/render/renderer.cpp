#include "core/render/renderer.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/interrupt.h"
#include "core/base/parallel.h"
#include "core/math/rng.h"
#include "core/math/sampling.h"
#include "core/render/direct_light.h"
#include "core/render/eye_path.h"
#include "core/render/film_layers.h"
#include "core/scene/eye_medium.h"

namespace caustics {
namespace {

constexpr int tile_size = 16;

struct Tile {
    int x0, y0, x1, y1;
};

// Whose sample a receiver point belongs to, and with which weight.
struct PointOwner {
    std::size_t pixel;  ///< in the tile
    std::size_t value;  ///< index of the sample's value
    Spectrum weight;
};

// A thread's scratch, reused from tile to tile.
struct Worker {
    std::unique_ptr<QueryContext> context;
    std::vector<std::size_t> pixels;
    std::vector<WeightedPoint> found;
    std::vector<ReceiverPoint> points;
    std::vector<PointOwner> owners;
    std::vector<Estimate> estimates;
    std::vector<SpectrumSum> values;  ///< of the samples of a round
    std::uint64_t camera_rays = 0;
    std::uint64_t receiver_points = 0;
    std::uint64_t lit_points = 0;
};

class EyePass {
public:
    EyePass(const Scene& scene, const RunOptions& options)
        : scene_(scene),
          options_(options),
          eye_absorption_(eye_medium(scene).absorption),
          disperses_(disperses(scene)),
          adaptive_(options.adaptive && scene.sampling().max_sample_count > 0),
          most_samples_(adaptive_ ? scene.sampling().max_sample_count : options.samples_per_pixel),
          tiles_(all_tiles()),
          workers_(static_cast<std::size_t>(std::max(1, options.threads))) {}

    Rendering run(const CausticEstimator& estimator) {
        const Camera& camera = scene_.camera();
        Rendering rendering{Film(camera.width, camera.height), {}};
        estimator_ = &estimator;
        const auto layer = estimator.camera_layer(options_);
        with_caustic_ = !layer.has_value();
        FilmLayers layers(rendering.film, {.unreached = layer.has_value(),
                                           .standard_error = layer || estimator.is_statistical(),
                                           .samples = adaptive_,
                                           .ambient = !is_black(scene_.ambient())});
        if (adaptive_)
            sample_adaptively(layers);
        else
            for_each_tile(0, 1, [&](const Tile& tile, std::size_t, Worker& worker) {
                std::vector<PixelSums> sums(pixel_count(tile));
                sample_all(tile, sums, worker);
                write(tile, sums, layers);
            });
        if (layer)
            for (std::size_t pixel = 0; pixel < rendering.film.pixel_count(); ++pixel)
                layers.write_caustic(pixel, layer->radiance[pixel], layer->standard_error[pixel]);
        layers.sum_beauty();
        take_counters(rendering.report.counters);
        if (layer)
            for (const auto& [name, count] : layer->counters)
                rendering.report.counters[name] += count;
        return rendering;
    }

    Rendering run(const Passes& passes) {
        if (adaptive_)
            throw InputError(
                "a method of several passes cannot be sampled adaptively, because no pass knows "
                "how the picture scatters: choose the sampler independent or stratified");
        const Camera& camera = scene_.camera();
        Rendering rendering{Film(camera.width, camera.height), {}};
        FilmLayers layers(rendering.film, {.ambient = !is_black(scene_.ambient())});
        std::vector<std::vector<PixelSums>> sums(tiles_.size());
        const double share = 1.0 / passes.count;
        for (int pass = 0; pass < passes.count; ++pass) {
            const std::unique_ptr<const CausticEstimator> estimator = passes.build(pass);
            estimator_ = estimator.get();
            caustic_only_ = pass > 0;
            for_each_tile(pass * share, (pass + 1) * share,
                          [&](const Tile& tile, std::size_t i, Worker& worker) {
                              sums[i].resize(pixel_count(tile));
                              sample_all(tile, sums[i], worker);
                          });
            take_counters(rendering.report.counters);
        }
        for (std::size_t i = 0; i < tiles_.size(); ++i) {
            for (PixelSums& pixel : sums[i]) pixel.caustic *= share;
            write(tiles_[i], sums[i], layers);
        }
        layers.sum_beauty();
        return rendering;
    }

private:
    // Calls body(tile, index, worker) for every tile; the progress goes from `from` to `to`.
    template <typename Body>
    void for_each_tile(double from, double to, const Body& body) {
        std::atomic<std::size_t> done{0};
        parallel_for(options_.threads, tiles_.size(), [&](std::size_t i, std::size_t w) {
            Worker& worker = workers_[w];
            if (!worker.context) worker.context = estimator_->make_context();
            body(tiles_[i], i, worker);
            const double share = static_cast<double>(++done) / static_cast<double>(tiles_.size());
            options_.report(from + share * (to - from));
        });
    }

    // Adds what was counted with the current estimator, and makes the workers ready for another.
    void take_counters(Counters& counters) {
        for (Worker& worker : workers_) {
            if (worker.context) worker.context->add_to(counters);
            counters["camera_rays"] += worker.camera_rays;
            counters["receiver_points"] += worker.receiver_points;
            if (with_caustic_) counters["lit_points"] += worker.lit_points;
            worker.context.reset();
            worker.camera_rays = worker.receiver_points = worker.lit_points = 0;
        }
    }

    std::vector<Tile> all_tiles() const {
        const Camera& camera = scene_.camera();
        std::vector<Tile> tiles;
        for (int y = 0; y < camera.height; y += tile_size)
            for (int x = 0; x < camera.width; x += tile_size)
                tiles.push_back({x, y, std::min(x + tile_size, camera.width),
                                 std::min(y + tile_size, camera.height)});
        return tiles;
    }

    static std::size_t pixel_count(const Tile& tile) {
        return static_cast<std::size_t>(tile.x1 - tile.x0) *
               static_cast<std::size_t>(tile.y1 - tile.y0);
    }

    // The base samples of the whole picture first: how bright it is decides what is dark.
    void sample_adaptively(FilmLayers& layers) {
        std::vector<std::vector<PixelSums>> sums(tiles_.size());
        for_each_tile(0, 0.5, [&](const Tile& tile, std::size_t i, Worker& worker) {
            sums[i].resize(pixel_count(tile));
            sample_all(tile, sums[i], worker);
        });
        SpectrumSum brightness = SpectrumSum::Zero();
        for (const std::vector<PixelSums>& tile : sums)
            for (const PixelSums& pixel : tile) brightness += pixel.beauty() / pixel.samples;
        const Camera& camera = scene_.camera();
        const SpectrumSum mean = brightness / (double{1} * camera.width * camera.height);
        for_each_tile(0.5, 1, [&](const Tile& tile, std::size_t i, Worker& worker) {
            refine(tile, mean, sums[i], worker);
            write(tile, sums[i], layers);
            sums[i] = {};
        });
    }

    // Doubles the samples of the pixels whose error is too large, until none is or none may have
    // more.
    void refine(const Tile& tile, const SpectrumSum& mean, std::vector<PixelSums>& sums,
                Worker& worker) const {
        for (int samples = options_.samples_per_pixel; samples < most_samples_;) {
            worker.pixels.clear();
            for (std::size_t pixel = 0; pixel < sums.size(); ++pixel)
                if (sums[pixel].samples == samples && needs_more(sums[pixel], mean))
                    worker.pixels.push_back(pixel);
            if (worker.pixels.empty()) return;
            const int more = std::min(samples, most_samples_ - samples);
            sample(tile, samples, more, sums, worker);
            samples += more;
        }
    }

    // A standard error above the allowed share of the pixel's own brightness, or of a tenth of the
    // picture's for pixels darker than that.
    bool needs_more(const PixelSums& sums, const SpectrumSum& mean) const {
        const SpectrumSum beauty = sums.beauty();
        const SpectrumSum allowed = static_cast<double>(scene_.sampling().max_error) *
                                    (beauty / sums.samples).max(0.1 * mean);
        return (sums.variance_of_mean(beauty, sums.beauty_squares) > allowed.square()).any();
    }

    // The film point of a sample, in pixels (Mitsuba's samplers; [C11] with two numbers an axis).
    Vec2d film_point(int x, int y, int sample, Rng& rng) const {
        double u = static_cast<double>(rng.next());
        double v = static_cast<double>(rng.next());
        const PixelSampling& sampling = scene_.sampling();
        if (sampling.stratified) {
            const int n = static_cast<int>(std::lround(std::sqrt(options_.samples_per_pixel)));
            if (!sampling.jitter) u = v = 0.5;
            u = (sample % n + u) / n;
            v = (sample / n + v) / n;
        }
        return {x + u, y + v};
    }

    // Spread over the pixel's samples (van der Corput), and by chance over the pixels: few samples have all
    // colours.
    double wavelength_choice(int x, int y, int sample) const {
        Rng rng(options_.seed, Stage::wavelength, pixel_number(x, y));
        return radical_inverse<2>(static_cast<std::uint64_t>(sample), rng.next_fine());
    }

    void sample_all(const Tile& tile, std::vector<PixelSums>& sums, Worker& worker) const {
        worker.pixels.resize(sums.size());
        std::iota(worker.pixels.begin(), worker.pixels.end(), std::size_t{0});
        sample(tile, 0, options_.samples_per_pixel, sums, worker);
    }

    // Takes samples first .. first + count of the worker's pixels. One batch for the method; a
    // sample's points stand together, so that their sum is one sample's value.
    void sample(const Tile& tile, int first, int count, std::vector<PixelSums>& sums,
                Worker& worker) const {
        worker.points.clear();
        worker.owners.clear();
        worker.values.clear();
        const int width = tile.x1 - tile.x0;
        for (const std::size_t pixel : worker.pixels)
            for (int i = first; i < first + count; ++i) {
                throw_if_interrupted();
                const int x = tile.x0 + static_cast<int>(pixel) % width;
                const int y = tile.y0 + static_cast<int>(pixel) / width;
                worker.values.push_back(trace_sample(x, y, i, pixel, sums[pixel], worker));
            }
        worker.receiver_points += worker.points.size();
        if (with_caustic_) add_caustic(worker, sums);
        if (caustic_only_) return;
        for (std::size_t i = 0; i < worker.values.size(); ++i) {
            PixelSums& pixel = sums[worker.pixels[i / static_cast<std::size_t>(count)]];
            pixel.beauty_squares += worker.values[i].square();
            ++pixel.samples;
        }
    }

    std::uint64_t pixel_number(int x, int y) const {
        return static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(scene_.camera().width) +
               static_cast<std::uint64_t>(x);
    }

    std::uint64_t sample_id(int x, int y, int sample) const {
        return pixel_number(x, y) * static_cast<std::uint64_t>(most_samples_) +
               static_cast<std::uint64_t>(sample);
    }

    // Gives the sample's radiance without caustics; in later passes its receiver points only.
    SpectrumSum trace_sample(int x, int y, int sample, std::size_t pixel, PixelSums& sums,
                             Worker& worker) const {
        const std::uint64_t id = sample_id(x, y, sample);
        Rng rng(options_.seed, Stage::eye, id);
        const Vec2d at = film_point(x, y, sample, rng);
        const Camera& camera = scene_.camera();
        const Ray ray = spawn_ray({camera.position()}, camera.direction(at.x(), at.y()));
        worker.found.clear();
        std::optional<double> wavelength;
        if (disperses_) wavelength = wavelength_choice(x, y, sample);
        const EyePath path =
            trace_eye_path(scene_, ray, eye_absorption_, rng, worker.found, wavelength);
        ++worker.camera_rays;
        std::uint64_t branch = 0;
        for (WeightedPoint& found : worker.found) {
            found.point.id = id << 8U | (branch++ & 0xFFU);
            worker.points.push_back(found.point);
            worker.owners.push_back({pixel, worker.values.size(), found.weight});
        }
        if (caustic_only_) return SpectrumSum::Zero();
        return add_eye_path(path, rng, sums, worker);
    }

    SpectrumSum add_eye_path(const EyePath& path, Rng& rng, PixelSums& sums,
                             const Worker& worker) const {
        const SpectrumSum emitted = path.emitted.cast<double>();
        sums.emitted += emitted;
        sums.albedo += path.first.albedo.cast<double>();
        sums.normal += path.first.normal.cast<double>();
        sums.depth += static_cast<double>(path.first.depth);
        sums.hits += path.first.depth > 0 ? 1 : 0;
        sums.through_caster += path.first.caster ? 1 : 0;
        SpectrumSum direct = SpectrumSum::Zero();
        SpectrumSum ambient = SpectrumSum::Zero();
        const Shadows shadows = estimator_->shadows();
        for (const WeightedPoint& found : worker.found) {
            direct +=
                (found.weight * direct_radiance(scene_, found.point, rng, shadows)).cast<double>();
            ambient += (found.weight * albedo(*found.point.bsdf, found.point.uv) * scene_.ambient())
                           .cast<double>();
        }
        sums.direct += direct;
        sums.ambient += ambient;
        return emitted + direct + ambient;
    }

    void add_caustic(Worker& worker, std::vector<PixelSums>& sums) const {
        worker.estimates.assign(worker.points.size(), Estimate{});
        estimator_->radiance(worker.points, worker.estimates, *worker.context);
        for (const Estimate& estimate : worker.estimates)
            worker.lit_points += is_black(estimate.value) ? 0 : 1;
        for (std::size_t i = 0; i < worker.points.size();) {
            const PointOwner& owner = worker.owners[i];
            SpectrumSum value = SpectrumSum::Zero();
            SpectrumSum variance = SpectrumSum::Zero();
            for (; i < worker.points.size() && worker.owners[i].value == owner.value; ++i) {
                const SpectrumSum weight = worker.owners[i].weight.cast<double>();
                value += weight * worker.estimates[i].value.cast<double>();
                variance += (weight * worker.estimates[i].standard_error.cast<double>()).square();
            }
            worker.values[owner.value] += value;
            sums[owner.pixel].caustic += value;
            sums[owner.pixel].caustic_squares += value.square();
            sums[owner.pixel].own_variance += variance;
        }
    }

    void write(const Tile& tile, const std::vector<PixelSums>& sums, FilmLayers& layers) const {
        const int width = tile.x1 - tile.x0;
        for (std::size_t pixel = 0; pixel < sums.size(); ++pixel) {
            const int x = tile.x0 + static_cast<int>(pixel) % width;
            const int y = tile.y0 + static_cast<int>(pixel) / width;
            layers.write(pixel_number(x, y), sums[pixel]);
        }
    }

    const Scene& scene_;
    const CausticEstimator* estimator_ = nullptr;
    RunOptions options_;
    Spectrum eye_absorption_;  ///< of the medium that camera rays start in
    bool disperses_;
    bool adaptive_;
    int most_samples_;
    bool with_caustic_ = true;
    bool caustic_only_ = false;  ///< the other layers are there from the first pass
    std::vector<Tile> tiles_;
    std::vector<Worker> workers_;
};

}  // namespace

Rendering render(const Scene& scene, const CausticEstimator& estimator, const RunOptions& options) {
    return EyePass(scene, options).run(estimator);
}

Rendering render(const Scene& scene, const Passes& passes, const RunOptions& options) {
    if (passes.count == 1) return render(scene, *passes.build(0), options);
    return EyePass(scene, options).run(passes);
}

}  // namespace caustics
