#include "core/renderer.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/direct_light.h"
#include "core/eye_path.h"
#include "core/parallel.h"
#include "core/rng.h"

namespace caustics {
namespace {

constexpr int tile_size = 16;

struct Tile {
    int x0, y0, x1, y1;
};

// A receiver point's place in the picture.
struct PointOwner {
    std::size_t pixel;
    int sample;
    Spectrum weight;
};

// A thread's scratch, reused from tile to tile.
struct Worker {
    std::unique_ptr<QueryContext> context;
    std::vector<WeightedPoint> found;
    std::vector<ReceiverPoint> points;
    std::vector<PointOwner> owners;
    std::vector<Estimate> estimates;
    std::uint64_t camera_rays = 0;
};

struct PixelSums {
    SpectrumSum direct = SpectrumSum::Zero();
    SpectrumSum emitted = SpectrumSum::Zero();
    SpectrumSum caustic = SpectrumSum::Zero();
    SpectrumSum caustic_squares = SpectrumSum::Zero();
    SpectrumSum own_variance = SpectrumSum::Zero();  ///< of single-sample pixels
    SpectrumSum albedo = SpectrumSum::Zero();
    Vec3d normal = Vec3d::Zero();
    double depth = 0;
    int hits = 0;
    int through_caster = 0;
};

class EyePass {
public:
    EyePass(const Scene& scene, const CausticEstimator& estimator, const RunOptions& options)
        : scene_(scene), estimator_(estimator), options_(options) {}

    Rendering run() {
        const Camera& camera = scene_.camera();
        Rendering rendering{Film(camera.width, camera.height), {}};
        const auto layer = estimator_.camera_layer(options_);
        make_planes(rendering.film, layer.has_value());
        render_tiles(rendering, !layer.has_value());
        if (layer) insert(*layer, rendering.film);
        if (layer)
            for (const auto& [name, count] : layer->counters)
                rendering.report.counters[name] += count;
        sum_beauty(rendering.film);
        return rendering;
    }

private:
    void make_planes(Film& film, bool camera_layer) const {
        for (const char* layer : {"", "direct", "caustic", "specular", "albedo"})
            film.set_rgb(layer, 0, black());
        for (const char* channel : {"normal.X", "normal.Y", "normal.Z", "depth.Z"})
            film.plane(channel);
        if (camera_layer) film.plane("unreached.Y");
        if (estimator_.is_statistical()) film.set_rgb("stderr", 0, black());
    }

    void render_tiles(Rendering& rendering, bool with_caustic) {
        const std::vector<Tile> tiles = all_tiles();
        std::vector<Worker> workers(static_cast<std::size_t>(std::max(1, options_.threads)));
        std::atomic<std::size_t> done{0};
        parallel_for(options_.threads, tiles.size(), [&](std::size_t i, std::size_t w) {
            Worker& worker = workers[w];
            if (!worker.context) worker.context = estimator_.make_context();
            render_tile(tiles[i], with_caustic, worker, rendering.film);
            options_.report(static_cast<double>(++done) / static_cast<double>(tiles.size()));
        });
        std::uint64_t camera_rays = 0;
        for (const Worker& worker : workers) {
            if (worker.context) worker.context->add_to(rendering.report.counters);
            camera_rays += worker.camera_rays;
        }
        rendering.report.counters["camera_rays"] = camera_rays;
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

    void render_tile(const Tile& tile, bool with_caustic, Worker& worker, Film& film) const {
        const auto width = static_cast<std::size_t>(tile.x1 - tile.x0);
        std::vector<PixelSums> sums(width * static_cast<std::size_t>(tile.y1 - tile.y0));
        worker.points.clear();
        worker.owners.clear();
        for (int y = tile.y0; y < tile.y1; ++y)
            for (int x = tile.x0; x < tile.x1; ++x)
                for (int sample = 0; sample < options_.samples_per_pixel; ++sample) {
                    const std::size_t pixel = static_cast<std::size_t>(y - tile.y0) * width +
                                              static_cast<std::size_t>(x - tile.x0);
                    trace_sample(x, y, sample, pixel, sums[pixel], worker);
                }
        if (with_caustic) add_caustic(worker, sums);
        for (std::size_t pixel = 0; pixel < sums.size(); ++pixel)
            write_pixel(tile.x0 + static_cast<int>(pixel % width),
                        tile.y0 + static_cast<int>(pixel / width), sums[pixel], film);
    }

    std::uint64_t sample_id(int x, int y, int sample) const {
        const auto pixel =
            static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(scene_.camera().width) +
            static_cast<std::uint64_t>(x);
        return pixel * static_cast<std::uint64_t>(options_.samples_per_pixel) +
               static_cast<std::uint64_t>(sample);
    }

    void trace_sample(int x, int y, int sample, std::size_t pixel, PixelSums& sums,
                      Worker& worker) const {
        const std::uint64_t id = sample_id(x, y, sample);
        Rng rng(options_.seed, Stage::eye, id);
        const Vec2d at = film_point(x, y, sample, rng);
        const Camera& camera = scene_.camera();
        const Ray ray = spawn_ray({camera.position()}, camera.direction(at.x(), at.y()));
        worker.found.clear();
        const EyePath path = trace_eye_path(scene_, ray, rng, worker.found);
        ++worker.camera_rays;
        sums.emitted += path.emitted.cast<double>();
        sums.albedo += path.first.albedo.cast<double>();
        sums.normal += path.first.normal.cast<double>();
        sums.depth += static_cast<double>(path.first.depth);
        sums.hits += path.first.depth > 0 ? 1 : 0;
        sums.through_caster += path.first.caster ? 1 : 0;
        std::uint64_t branch = 0;
        for (WeightedPoint& found : worker.found) {
            sums.direct +=
                (found.weight * direct_radiance(scene_, found.point, rng)).cast<double>();
            found.point.id = id << 8U | (branch++ & 0xFFU);
            worker.points.push_back(found.point);
            worker.owners.push_back({pixel, sample, found.weight});
        }
    }

    // One batch a tile; a sample's points stand together, so that its sum is one sample's value.
    void add_caustic(Worker& worker, std::vector<PixelSums>& sums) const {
        worker.estimates.assign(worker.points.size(), Estimate{});
        estimator_.radiance(worker.points, worker.estimates, *worker.context);
        for (std::size_t i = 0; i < worker.points.size();) {
            const PointOwner& owner = worker.owners[i];
            SpectrumSum value = SpectrumSum::Zero();
            SpectrumSum variance = SpectrumSum::Zero();
            for (; i < worker.points.size() && worker.owners[i].pixel == owner.pixel &&
                   worker.owners[i].sample == owner.sample;
                 ++i) {
                const SpectrumSum weight = worker.owners[i].weight.cast<double>();
                value += weight * worker.estimates[i].value.cast<double>();
                variance += (weight * worker.estimates[i].standard_error.cast<double>()).square();
            }
            sums[owner.pixel].caustic += value;
            sums[owner.pixel].caustic_squares += value.square();
            sums[owner.pixel].own_variance += variance;
        }
    }

    void write_pixel(int x, int y, const PixelSums& sums, Film& film) const {
        const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(film.width()) +
                           static_cast<std::size_t>(x);
        const double n = options_.samples_per_pixel;
        const auto put = [&](const char* layer, const SpectrumSum& sum) {
            put_finite(layer, pixel, (sum / n).cast<float>(), film);
        };
        put("direct", sums.direct);
        put("specular", sums.emitted);
        put("caustic", sums.caustic);
        put("albedo", sums.albedo);
        const Vec3d normal = sums.normal / n;
        film.plane("normal.X")[pixel] = static_cast<float>(normal.x());
        film.plane("normal.Y")[pixel] = static_cast<float>(normal.y());
        film.plane("normal.Z")[pixel] = static_cast<float>(normal.z());
        if (sums.hits > 0)
            film.plane("depth.Z")[pixel] = static_cast<float>(sums.depth / sums.hits);
        if (film.find("unreached.Y") != nullptr)
            film.plane("unreached.Y")[pixel] = static_cast<float>(sums.through_caster / n);
        if (!estimator_.is_statistical()) return;
        // Several samples tell the error by their scatter, a single one only by its own paths'.
        const SpectrumSum variance =
            n > 1 ? SpectrumSum((sums.caustic_squares / n - (sums.caustic / n).square()).max(0) /
                                (n - 1))
                  : sums.own_variance;
        put("stderr", variance.sqrt() * n);
    }

    static void put_finite(const char* layer, std::size_t pixel, const Spectrum& value,
                           Film& film) {
        const auto width = static_cast<std::size_t>(film.width());
        if (!is_finite(value))
            throw std::runtime_error("pixel (" + std::to_string(pixel % width) + ", " +
                                     std::to_string(pixel / width) + "): layer " + layer +
                                     " is not finite");
        film.set_rgb(layer, pixel, value);
    }

    static void insert(const CameraLayer& layer, Film& film) {
        for (std::size_t pixel = 0; pixel < film.pixel_count(); ++pixel) {
            put_finite("caustic", pixel, layer.radiance[pixel], film);
            put_finite("stderr", pixel, layer.standard_error[pixel], film);
        }
    }

    static void sum_beauty(Film& film) {
        for (std::size_t pixel = 0; pixel < film.pixel_count(); ++pixel)
            film.set_rgb("", pixel,
                         film.rgb("direct", pixel) + film.rgb("caustic", pixel) +
                             film.rgb("specular", pixel));
    }

    const Scene& scene_;
    const CausticEstimator& estimator_;
    RunOptions options_;
};

}  // namespace

Rendering render(const Scene& scene, const CausticEstimator& estimator, const RunOptions& options) {
    return EyePass(scene, estimator, options).run();
}

}  // namespace caustics
