#include "core/render/renderer.h"

#include <algorithm>
#include <atomic>
#include <numeric>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/render/tile_sampler.h"

namespace caustics {
namespace {

/// The three ways to take a picture's samples: a fixed number a pixel, adaptively, or pass by pass.
class EyePass {
public:
    EyePass(const Scene& scene, const RunOptions& options, const IndirectEstimator* indirect)
        : scene_(scene),
          options_(options),
          adaptive_(options.adaptive && scene.sampling().max_sample_count > 0),
          samples_(scene, options,
                   adaptive_ ? scene.sampling().max_sample_count : options.samples_per_pixel),
          sampler_(scene, samples_, options),
          tiles_(tiles_of(scene.camera())),
          workers_(static_cast<std::size_t>(std::max(1, options.threads))) {
        if (indirect == nullptr) return;
        indirect_layer_ = indirect->camera_layer(options_);
        if (!indirect_layer_) sampler_.ask_indirect(indirect);
    }

    Rendering run(const CausticEstimator& estimator) {
        if (sampler_.indirect() != nullptr && sampler_.indirect()->known_shadows() != nullptr &&
            estimator.shadows() != Shadows::opaque)
            throw InputError(
                "shadow_photons know opaque shadows, and the caustic's method asks for "
                "transparent ones: leave shadow_photons out, or make its shadows opaque");
        const Camera& camera = scene_.camera();
        Rendering rendering{Film(camera.width, camera.height), {}};
        const auto layer = estimator.camera_layer(options_);
        sampler_.ask(estimator, {.caustic = !layer});
        FilmLayers layers(rendering.film, {.unreached = layer || indirect_layer_,
                                           .standard_error = layer || estimator.is_statistical(),
                                           .samples = adaptive_,
                                           .ambient = !is_black(scene_.ambient()),
                                           .indirect = has_indirect(),
                                           .indirect_error = has_indirect_error()});
        if (adaptive_)
            sample_adaptively(layers);
        else
            for_each_tile(0, 1, [&](const Tile& tile, std::size_t, TileWorker& worker) {
                std::vector<PixelSums> sums(tile.pixel_count());
                sample_all(tile, sums, worker);
                write(tile, sums, layers);
            });
        if (layer)
            for (std::size_t pixel = 0; pixel < rendering.film.pixel_count(); ++pixel)
                layers.write_caustic(pixel, layer->radiance[pixel], layer->standard_error[pixel]);
        finish(rendering, layers);
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
        FilmLayers layers(rendering.film, {.unreached = indirect_layer_.has_value(),
                                           .ambient = !is_black(scene_.ambient()),
                                           .indirect = has_indirect(),
                                           .indirect_error = has_indirect_error()});
        std::vector<std::vector<PixelSums>> sums(tiles_.size());
        const double share = 1.0 / passes.count;
        for (int pass = 0; pass < passes.count; ++pass) {
            const std::unique_ptr<const CausticEstimator> estimator = passes.build(pass);
            // The other layers are there from the first pass.
            sampler_.ask(*estimator, {.others = pass == 0});
            for_each_tile(pass * share, (pass + 1) * share,
                          [&](const Tile& tile, std::size_t i, TileWorker& worker) {
                              sums[i].resize(tile.pixel_count());
                              sample_all(tile, sums[i], worker);
                          });
            take_counters(rendering.report.counters);
        }
        for (std::size_t i = 0; i < tiles_.size(); ++i) {
            for (PixelSums& pixel : sums[i]) pixel.caustic *= share;
            write(tiles_[i], sums[i], layers);
        }
        finish(rendering, layers);
        return rendering;
    }

private:
    // What connects to the camera is there at once; then the sum.
    void finish(Rendering& rendering, FilmLayers& layers) const {
        if (indirect_layer_) {
            for (std::size_t pixel = 0; pixel < rendering.film.pixel_count(); ++pixel)
                layers.write_indirect(pixel, indirect_layer_->radiance[pixel],
                                      indirect_layer_->standard_error[pixel]);
            add_under("indirect_", indirect_layer_->counters, rendering.report.counters);
        }
        layers.sum_beauty();
    }
    bool has_indirect_error() const {
        return indirect_layer_ ||
               (sampler_.indirect() != nullptr && sampler_.indirect()->is_statistical());
    }
    bool has_indirect() const { return indirect_layer_ || sampler_.indirect() != nullptr; }

    // Calls body(tile, index, worker) for every tile; the progress goes from `from` to `to`.
    template <typename Body>
    void for_each_tile(double from, double to, const Body& body) {
        std::atomic<std::size_t> done{0};
        parallel_for(options_.threads, tiles_.size(), [&](std::size_t i, std::size_t w) {
            TileWorker& worker = workers_[w];
            if (!worker.context) worker.context = sampler_.estimator().make_context();
            if (sampler_.indirect() != nullptr && !worker.indirect_context) {
                worker.indirect_context = sampler_.indirect()->make_context();
                worker.shadow_rays = {sampler_.indirect()->known_shadows(),
                                      worker.indirect_context.get()};
            }
            body(tiles_[i], i, worker);
            const double share = static_cast<double>(++done) / static_cast<double>(tiles_.size());
            options_.report(from + share * (to - from));
        });
    }

    // Adds what was counted with the current estimator, and makes the workers ready for another.
    void take_counters(Counters& counters) {
        for (TileWorker& worker : workers_) {
            if (worker.context) worker.context->add_to(counters);
            counters["camera_rays"] += worker.camera_rays;
            counters["receiver_points"] += worker.receiver_points;
            if (sampler_.has_caustic()) counters["lit_points"] += worker.lit_points;
            worker.context.reset();
            if (worker.indirect_context) {
                Counters own;
                worker.indirect_context->add_to(own);
                add_under("indirect_", own, counters);
                worker.indirect_context.reset();
            }
            if (worker.shadow_rays.known != nullptr) {
                counters["shadow_rays"] += worker.shadow_rays.traced;
                counters["shadow_rays_saved"] += worker.shadow_rays.spared;
            }
            worker.shadow_rays = {};
            worker.camera_rays = worker.receiver_points = worker.lit_points = 0;
        }
    }

    // The base samples of the whole picture first: how bright it is decides what is dark.
    void sample_adaptively(FilmLayers& layers) {
        std::vector<std::vector<PixelSums>> sums(tiles_.size());
        for_each_tile(0, 0.5, [&](const Tile& tile, std::size_t i, TileWorker& worker) {
            sums[i].resize(tile.pixel_count());
            sample_all(tile, sums[i], worker);
        });
        SpectrumSum brightness = SpectrumSum::Zero();
        for (const std::vector<PixelSums>& tile : sums)
            for (const PixelSums& pixel : tile) brightness += pixel.beauty() / pixel.samples;
        const Camera& camera = scene_.camera();
        const SpectrumSum mean = brightness / (double{1} * camera.width * camera.height);
        for_each_tile(0.5, 1, [&](const Tile& tile, std::size_t i, TileWorker& worker) {
            refine(tile, mean, sums[i], worker);
            write(tile, sums[i], layers);
            sums[i] = {};
        });
    }

    // Doubles the samples of the pixels whose error is too large, until none is or none may have
    // more.
    void refine(const Tile& tile, const SpectrumSum& mean, std::vector<PixelSums>& sums,
                TileWorker& worker) const {
        for (int samples = options_.samples_per_pixel; samples < samples_.most();) {
            worker.pixels.clear();
            for (std::size_t pixel = 0; pixel < sums.size(); ++pixel)
                if (sums[pixel].samples == samples && needs_more(sums[pixel], mean))
                    worker.pixels.push_back(pixel);
            if (worker.pixels.empty()) return;
            const int more = std::min(samples, samples_.most() - samples);
            sampler_.sample(tile, samples, more, sums, worker);
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

    void sample_all(const Tile& tile, std::vector<PixelSums>& sums, TileWorker& worker) const {
        worker.pixels.resize(sums.size());
        std::iota(worker.pixels.begin(), worker.pixels.end(), std::size_t{0});
        sampler_.sample(tile, 0, options_.samples_per_pixel, sums, worker);
    }

    void write(const Tile& tile, const std::vector<PixelSums>& sums, FilmLayers& layers) const {
        for (std::size_t pixel = 0; pixel < sums.size(); ++pixel)
            layers.write(samples_.pixel_number(tile.x(pixel), tile.y(pixel)), sums[pixel]);
    }

    const Scene& scene_;
    RunOptions options_;
    bool adaptive_;
    std::optional<CameraLayer> indirect_layer_;
    CameraSamples samples_;
    TileSampler sampler_;
    std::vector<Tile> tiles_;
    std::vector<TileWorker> workers_;
};

}  // namespace

Rendering render(const Scene& scene, const CausticEstimator& estimator, const RunOptions& options,
                 const IndirectEstimator* indirect) {
    return EyePass(scene, options, indirect).run(estimator);
}

Rendering render(const Scene& scene, const Passes& passes, const RunOptions& options,
                 const IndirectEstimator* indirect) {
    if (passes.count == 1) return render(scene, *passes.build(0), options, indirect);
    return EyePass(scene, options, indirect).run(passes);
}

}  // namespace caustics
