#include "core/render/tile_sampler.h"

#include <algorithm>

#include "core/base/interrupt.h"
#include "core/render/direct_light.h"
#include "core/render/pixel_cells.h"
#include "core/scene/eye_medium.h"

namespace caustics {
namespace {

constexpr int tile_size = 16;

}  // namespace

std::vector<Tile> tiles_of(const Camera& camera) {
    std::vector<Tile> tiles;
    for (int y = 0; y < camera.height; y += tile_size)
        for (int x = 0; x < camera.width; x += tile_size)
            tiles.push_back({x, y, std::min(x + tile_size, camera.width),
                             std::min(y + tile_size, camera.height)});
    return tiles;
}

TileSampler::TileSampler(const Scene& scene, const CameraSamples& samples,
                         const RunOptions& options)
    : scene_(scene),
      samples_(samples),
      seed_(options.seed),
      eye_absorption_(eye_medium(scene).absorption) {}

void TileSampler::sample(const Tile& tile, int first, int count, std::vector<PixelSums>& sums,
                         TileWorker& worker) const {
    worker.points.clear();
    worker.cells.clear();
    worker.owners.clear();
    worker.values.clear();
    for (const std::size_t pixel : worker.pixels)
        for (int i = first; i < first + count; ++i) {
            throw_if_interrupted();
            worker.values.push_back(
                trace(tile.x(pixel), tile.y(pixel), i, pixel, sums[pixel], worker));
        }
    for (std::size_t i = 0; i < worker.cells.size(); ++i)
        if (worker.cells[i]) worker.points[i].cell = &*worker.cells[i];
    worker.receiver_points += worker.points.size();
    if (parts_.caustic) add_caustic(worker, sums);
    if (!parts_.others) return;
    if (indirect_ != nullptr) add_indirect(worker, sums);
    for (std::size_t i = 0; i < worker.values.size(); ++i) {
        PixelSums& pixel = sums[worker.pixels[i / static_cast<std::size_t>(count)]];
        pixel.beauty_squares += worker.values[i].square();
        ++pixel.samples;
    }
}

// Gives the sample's radiance without caustics; in later passes its receiver points only.
SpectrumSum TileSampler::trace(int x, int y, int sample, std::size_t pixel, PixelSums& sums,
                               TileWorker& worker) const {
    const std::uint64_t id = samples_.id(x, y, sample);
    Rng rng(seed_, Stage::eye, id);
    const Vec2d at = samples_.film_point(x, y, sample, rng);
    const Camera& camera = scene_.camera();
    const Ray ray = spawn_ray({camera.position()}, camera.direction(at.x(), at.y()));
    worker.found.clear();
    const EyePath path = trace_eye_path(scene_, ray, eye_absorption_, rng, worker.found,
                                        samples_.wavelength_choice(x, y, sample));
    ++worker.camera_rays;
    std::uint64_t branch = 0;
    for (WeightedPoint& found : worker.found) {
        found.point.id = id << 8U | (branch++ & 0xFFU);
        worker.points.push_back(found.point);
        if (asks_for_cells())
            worker.cells.push_back(found.seen_directly ? cell_of(x, y, sample, found.point)
                                                       : std::nullopt);
        worker.owners.push_back({pixel, worker.values.size(), found.weight});
    }
    if (!parts_.others) return SpectrumSum::Zero();
    return add_eye_path(path, rng, sums, worker);
}

std::optional<PixelCell> TileSampler::cell_of(int x, int y, int sample,
                                              const ReceiverPoint& point) const {
    const auto cell = pixel_cell(scene_.camera(), samples_.film_cell(x, y, sample), point);
    return cell && lies_on_receiver(scene_, point, *cell) ? cell : std::nullopt;
}

SpectrumSum TileSampler::add_eye_path(const EyePath& path, Rng& rng, PixelSums& sums,
                                      TileWorker& worker) const {
    const SpectrumSum emitted = path.emitted.cast<double>();
    sums.emitted += emitted;
    sums.albedo += path.first.albedo.cast<double>();
    sums.normal += path.first.normal.cast<double>();
    sums.depth += static_cast<double>(path.first.depth);
    sums.hits += path.first.depth > 0 ? 1 : 0;
    sums.through_caster += path.first.caster ? 1 : 0;
    SpectrumSum direct = SpectrumSum::Zero();
    SpectrumSum ambient = SpectrumSum::Zero();
    for (const WeightedPoint& found : worker.found) {
        direct += (found.weight * this->direct(found.point, rng, worker)).cast<double>();
        ambient += (found.weight * albedo(*found.point.bsdf, found.point.uv) * scene_.ambient())
                       .cast<double>();
    }
    sums.direct += direct;
    sums.ambient += ambient;
    return emitted + direct + ambient;
}

Spectrum TileSampler::direct(const ReceiverPoint& point, Rng& rng, TileWorker& worker) const {
    if (worker.shadow_rays.known != nullptr)
        return direct_radiance(scene_, point, rng, worker.shadow_rays);
    return direct_radiance(scene_, point, rng, estimator_->shadows());
}

void TileSampler::add_caustic(TileWorker& worker, std::vector<PixelSums>& sums) const {
    worker.estimates.assign(worker.points.size(), Estimate{});
    estimator_->radiance(worker.points, worker.estimates, *worker.context);
    for (const Estimate& estimate : worker.estimates)
        worker.lit_points += is_black(estimate.value) ? 0 : 1;
    for (std::size_t i = 0; i < worker.points.size();) {
        const TileWorker::PointOwner& owner = worker.owners[i];
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

void TileSampler::add_indirect(TileWorker& worker, std::vector<PixelSums>& sums) const {
    worker.estimates.assign(worker.points.size(), Estimate{});
    indirect_->radiance(worker.points, worker.estimates, *worker.indirect_context);
    for (std::size_t i = 0; i < worker.points.size();) {
        const TileWorker::PointOwner& owner = worker.owners[i];
        SpectrumSum value = SpectrumSum::Zero();
        SpectrumSum variance = SpectrumSum::Zero();
        for (; i < worker.points.size() && worker.owners[i].value == owner.value; ++i) {
            const SpectrumSum weight = worker.owners[i].weight.cast<double>();
            value += (worker.owners[i].weight * worker.estimates[i].value).cast<double>();
            variance += (weight * worker.estimates[i].standard_error.cast<double>()).square();
        }
        worker.values[owner.value] += value;
        sums[owner.pixel].indirect += value;
        sums[owner.pixel].indirect_squares += value.square();
        sums[owner.pixel].indirect_own_variance += variance;
    }
}

}  // namespace caustics
