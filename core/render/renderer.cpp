#include "core/render/renderer.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/math/rng.h"
#include "core/render/tile_sampler.h"

namespace caustics {
namespace {

/// Adaptive sampling: up to so many times the first samples a pixel takes more where a neighbour does.
constexpr int followed_samples = 4;

/// The three ways to take a picture's samples: a fixed number a pixel, adaptively, or pass by pass.
class EyePass {
public:
    EyePass(const Scene& scene, const RunOptions& options, const IndirectEstimator* indirect,
            int pixel_step)
        : scene_(scene),
          options_(options),
          pixel_step_(static_cast<std::size_t>(pixel_step)),
          adaptive_(options.adaptive && scene.sampling().max_sample_count > 0),
          samples_(scene, options,
                   adaptive_ ? scene.sampling().max_sample_count : options.samples_per_pixel),
          sampler_(scene, samples_, options),
          tiles_(tiles_of(scene.camera())),
          workers_(static_cast<std::size_t>(std::max(1, options.threads))),
          caustic_error_(static_cast<std::size_t>(scene.camera().width) *
                         static_cast<std::size_t>(scene.camera().height)) {
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
        if (!layer && options_.samples_per_pixel > 1)
            rendering.caustic_error = std::move(caustic_error_);
        if (layer) {
            rendering.report.light = layer->light;
            for (const auto& [name, count] : layer->counters)
                rendering.report.counters[name] += count;
        }
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

    // The base samples of the whole picture first: how bright it is decides what is dark. Then doubles the samples of
    // the pixels that need more, until none does or none may have more.
    void sample_adaptively(FilmLayers& layers) {
        std::vector<std::vector<PixelSums>> sums(tiles_.size());
        for_each_tile(0, 0.5, [&](const Tile& tile, std::size_t i, TileWorker& worker) {
            sums[i].resize(tile.pixel_count());
            sample_all(tile, sums[i], worker);
        });
        const SpectrumSum mean = mean_beauty(sums);
        double done = 0.5;
        for (int samples = options_.samples_per_pixel; samples < samples_.most();) {
            const std::vector<bool> uneven = uneven_pixels(sums, samples, mean);
            if (std::ranges::find(uneven, true) == uneven.end()) break;
            const int more = std::min(samples, samples_.most() - samples);
            const double next = done + (1 - done) / 2;
            for_each_tile(done, next, [&](const Tile& tile, std::size_t i, TileWorker& worker) {
                choose_pixels(tile, sums[i], samples, uneven, worker);
                sampler_.sample(tile, samples, more, sums[i], worker);
            });
            samples += more;
            done = next;
        }
        for (std::size_t i = 0; i < tiles_.size(); ++i) write(tiles_[i], sums[i], layers);
    }

    SpectrumSum mean_beauty(const std::vector<std::vector<PixelSums>>& sums) const {
        SpectrumSum brightness = SpectrumSum::Zero();
        for (const std::vector<PixelSums>& tile : sums)
            for (const PixelSums& pixel : tile) brightness += pixel.beauty() / pixel.samples;
        const Camera& camera = scene_.camera();
        return brightness / (double{1} * camera.width * camera.height);
    }

    // Of the picture's pixels that have so many samples, those whose error is too large.
    std::vector<bool> uneven_pixels(const std::vector<std::vector<PixelSums>>& sums, int samples,
                                    const SpectrumSum& mean) const {
        const Camera& camera = scene_.camera();
        std::vector<bool> uneven(static_cast<std::size_t>(camera.width) *
                                 static_cast<std::size_t>(camera.height));
        for (std::size_t i = 0; i < tiles_.size(); ++i)
            for (std::size_t pixel = 0; pixel < sums[i].size(); ++pixel)
                uneven[samples_.pixel_number(tiles_[i].x(pixel), tiles_[i].y(pixel))] =
                    sums[i][pixel].samples == samples && needs_more(sums[i][pixel], mean);
        return uneven;
    }

    // The tile's pixels that take more samples. While they are few, a pixel may have missed what its neighbours met.
    void choose_pixels(const Tile& tile, const std::vector<PixelSums>& sums, int samples,
                       const std::vector<bool>& uneven, TileWorker& worker) const {
        const int reach = samples < followed_samples * options_.samples_per_pixel ? 1 : 0;
        worker.pixels.clear();
        for (std::size_t pixel = 0; pixel < sums.size(); ++pixel)
            if (sums[pixel].samples == samples &&
                any_around(uneven, tile.x(pixel), tile.y(pixel), reach))
                worker.pixels.push_back(pixel);
    }

    bool any_around(const std::vector<bool>& uneven, int x, int y, int reach) const {
        const Camera& camera = scene_.camera();
        for (int at_y = std::max(0, y - reach); at_y <= std::min(camera.height - 1, y + reach);
             ++at_y)
            for (int at_x = std::max(0, x - reach); at_x <= std::min(camera.width - 1, x + reach);
                 ++at_x)
                if (uneven[samples_.pixel_number(at_x, at_y)]) return true;
        return false;
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
        if (pixel_step_ > 1)
            std::erase_if(worker.pixels,
                          [&](std::size_t pixel) { return is_left_out(tile, pixel); });
        sampler_.sample(tile, 0, options_.samples_per_pixel, sums, worker);
    }

    // Scattered by chance, so that no row or column of the picture is preferred.
    bool is_left_out(const Tile& tile, std::size_t pixel) const {
        const auto number =
            static_cast<std::uint32_t>(samples_.pixel_number(tile.x(pixel), tile.y(pixel)));
        return philox4x32({number, 0, 0, 0}, {})[0] % pixel_step_ != 0;
    }

    void write(const Tile& tile, const std::vector<PixelSums>& sums, FilmLayers& layers) {
        for (std::size_t i = 0; i < sums.size(); ++i) {
            if (sums[i].samples == 0) continue;
            const std::size_t pixel = samples_.pixel_number(tile.x(i), tile.y(i));
            layers.write(pixel, sums[i]);
            caustic_error_[pixel] = static_cast<float>(std::sqrt(
                sums[i].variance_of_mean(sums[i].caustic, sums[i].caustic_squares).mean()));
        }
    }

    const Scene& scene_;
    RunOptions options_;
    std::size_t pixel_step_;
    bool adaptive_;
    std::optional<CameraLayer> indirect_layer_;
    CameraSamples samples_;
    TileSampler sampler_;
    std::vector<Tile> tiles_;
    std::vector<TileWorker> workers_;
    std::vector<float> caustic_error_;
};

}  // namespace

Rendering render(const Scene& scene, const CausticEstimator& estimator, const RunOptions& options,
                 const IndirectEstimator* indirect) {
    return EyePass(scene, options, indirect, 1).run(estimator);
}

Rendering render(const Scene& scene, const Passes& passes, const RunOptions& options,
                 const IndirectEstimator* indirect) {
    const std::unique_ptr<const CausticEstimator> only =
        passes.count == 1 ? passes.build(0) : nullptr;
    EyePass eye(scene, options, indirect, passes.pixel_step);
    return only ? eye.run(*only) : eye.run(passes);
}

}  // namespace caustics
