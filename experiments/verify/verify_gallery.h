#pragma once

#include <string>
#include <vector>

#include "core/caustic_estimator.h"
#include "experiments/gallery/gallery.h"

namespace caustics::experiments {

/// What a series of the gallery came to.
struct SeriesOutcome {
    std::string scene;
    std::string method;  ///< with its variant
    std::vector<double>
        errors;            ///< of each step: sqrt(mean ((x - truth) / truth)^2) over the points
    double mean = 1;       ///< of the last step's values, of the truth's
    double factor = 2;     ///< by which the error should fall from step to step
    double tolerance = 0;  ///< of the last error
    std::string refusal;   ///< why the method cannot serve the scene

    /// By how much it fell from step to step, as a geometric mean.
    double fall() const;
    /// An error below this is rounding: it need not fall any further.
    static constexpr double rounding = 1e-5;
    bool is_small_enough() const;
    /// The mean of n points is off by no more than four times error / sqrt(n) and half a per cent.
    bool is_balanced() const;
    std::size_t points = 0;  ///< that errors and mean are of
    /// As fast as factor^0.7, which leaves room for chance; or down to rounding.
    bool falls_fast_enough() const;
    bool holds() const;
};

/// A gallery's points on its scene as methods are asked at them; `radius` as in Series.
std::vector<ReceiverPoint> receiver_points(const Scene& scene, const GalleryScene& gallery,
                                           double radius);

/// What a built method answers at those points: the irradiance, or where the gallery names viewers the
/// radiance.
std::vector<Estimate> answers(const PointEstimator& method, const GalleryScene& gallery,
                              const std::vector<ReceiverPoint>& points, QueryContext& context);

/// Runs one method on one scene at growing effort. What it refuses (UnsupportedScene) is reported.
SeriesOutcome run_series(const GalleryScene& scene, const Series& series,
                         const RunOptions& options);

/// A Markdown table, one row a series, with what each scene's truth is.
std::string gallery_table(const std::vector<GalleryScene>& scenes,
                          const std::vector<SeriesOutcome>& outcomes);

}  // namespace caustics::experiments
