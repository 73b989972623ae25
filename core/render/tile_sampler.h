#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/caustic_estimator.h"
#include "core/indirect_estimator.h"
#include "core/render/camera_samples.h"
#include "core/render/eye_path.h"
#include "core/render/film_layers.h"

namespace caustics {

/// A rectangle of pixels, x0 <= x < x1, y0 <= y < y1.
struct Tile {
    int x0, y0, x1, y1;

    int width() const { return x1 - x0; }
    std::size_t pixel_count() const {
        return static_cast<std::size_t>(x1 - x0) * static_cast<std::size_t>(y1 - y0);
    }
    int x(std::size_t pixel) const { return x0 + static_cast<int>(pixel) % width(); }
    int y(std::size_t pixel) const { return y0 + static_cast<int>(pixel) / width(); }
};

/// The tiles of a picture, row by row.
std::vector<Tile> tiles_of(const Camera& camera);

/// A thread's scratch and counts, reused from tile to tile.
struct TileWorker {
    /// Whose sample a receiver point belongs to, and with which weight.
    struct PointOwner {
        std::size_t pixel;  ///< in the tile
        std::size_t value;  ///< index of the sample's value
        Spectrum weight;
    };

    std::unique_ptr<QueryContext> context;
    std::unique_ptr<QueryContext> indirect_context;
    std::vector<std::size_t> pixels;  ///< that are sampled next, numbered in their tile
    std::vector<WeightedPoint> found;
    std::vector<ReceiverPoint> points;
    std::vector<std::optional<PixelCell>>
        cells;  ///< of the points; none where the method asks for none
    std::vector<PointOwner> owners;
    std::vector<Estimate> estimates;
    std::vector<SpectrumSum> values;  ///< of the samples of a round
    ShadowRays shadow_rays;
    std::uint64_t camera_rays = 0;
    std::uint64_t receiver_points = 0;
    std::uint64_t lit_points = 0;
};

/// Camera samples of a tile's pixels: their paths, direct light, and the method's caustic at the receiver points
/// that they find.
class TileSampler {
public:
    /// The layers that samples add to.
    struct Parts {
        bool caustic = true;
        bool others = true;
    };

    TileSampler(const Scene& scene, const CameraSamples& samples, const RunOptions& options);
    void ask(const CausticEstimator& estimator, Parts parts) {
        estimator_ = &estimator;
        parts_ = parts;
    }
    /// For the indirect layer, with the others; nullptr: none.
    void ask_indirect(const IndirectEstimator* estimator) { indirect_ = estimator; }
    const CausticEstimator& estimator() const { return *estimator_; }
    const IndirectEstimator* indirect() const { return indirect_; }
    bool has_caustic() const { return parts_.caustic; }

    /// Takes samples first .. first + count of the worker's pixels. One batch for the method; a
    /// sample's points are together, so that their sum is one sample's value.
    void sample(const Tile& tile, int first, int count, std::vector<PixelSums>& sums,
                TileWorker& worker) const;

private:
    bool asks_for_cells() const { return parts_.caustic && estimator_->asks_for_cells(); }
    SpectrumSum trace(int x, int y, int sample, std::size_t pixel, PixelSums& sums,
                      TileWorker& worker) const;
    /// The sample's part of its pixel on the point's receiver; none where it reaches beyond it.
    std::optional<PixelCell> cell_of(int x, int y, int sample, const ReceiverPoint& point) const;
    SpectrumSum add_eye_path(const EyePath& path, Rng& rng, PixelSums& sums,
                             TileWorker& worker) const;
    Spectrum direct(const ReceiverPoint& point, Rng& rng, TileWorker& worker) const;
    void add_caustic(TileWorker& worker, std::vector<PixelSums>& sums) const;
    void add_indirect(TileWorker& worker, std::vector<PixelSums>& sums) const;

    const Scene& scene_;
    const CameraSamples& samples_;
    std::uint64_t seed_;
    Spectrum eye_absorption_;  ///< of the medium that camera rays start in
    const CausticEstimator* estimator_ = nullptr;
    const IndirectEstimator* indirect_ = nullptr;
    Parts parts_;
};

}  // namespace caustics
