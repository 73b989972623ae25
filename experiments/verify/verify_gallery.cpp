#include "experiments/verify/verify_gallery.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <stdexcept>

#include "core/base/error.h"
#include "experiments/run/method.h"

namespace caustics::experiments {

namespace {

ReceiverPoint receiver_at(const Scene& scene, const KnownPoint& known, std::uint64_t id,
                          double radius) {
    const float lift = 1e-4F * scene.diameter();
    const Vec3 normal = known.normal.cast<float>();
    const Ray ray{known.position.cast<float>() + lift * normal, -normal, 2 * lift};
    const std::optional<SurfacePoint> hit = scene.intersect(ray);
    const Vec3 wo = known.wo.isZero(0) ? normal : Vec3(known.wo.cast<float>());
    std::optional<ReceiverPoint> point;
    if (hit) point = receiver_point(scene, *hit, wo);
    if (!point)
        throw std::logic_error(fmt::format("gallery: no receiver at ({}, {}, {})",
                                           known.position.x(), known.position.y(),
                                           known.position.z()));
    point->id = id;
    point->radius = static_cast<float>(radius);
    return *point;
}

std::unique_ptr<const PointEstimator> build_of(const Series& series, const Effort& effort,
                                               const Scene& scene, const RunOptions& options) {
    const JsonNode parameters = parameters_node(effort.parameters);
    if (series.indirect)
        return parse_indirect(series.method, parameters)->configured->build(scene, options, 0);
    return build(scene, parse_method(series.method, parameters), options);
}

/// Error and mean of a method's answers, relative to the truth.
struct Score {
    double error, mean;
};

Score score(const GalleryScene& gallery, const Series& series, const Effort& effort,
            const RunOptions& options) {
    const Scene scene(gallery.make(effort.resolution));
    const auto built = build_of(series, effort, scene, options);
    const std::vector<ReceiverPoint> points = receiver_points(scene, gallery, series.radius);
    const auto context = built->make_context();
    const std::vector<Estimate> found = answers(*built, gallery, points, *context);
    double squares = 0, sum = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const double miss =
            static_cast<double>(found[i].value.mean()) / gallery.points[i].truth - 1;
        squares += miss * miss;
        sum += miss;
    }
    const auto n = static_cast<double>(found.size());
    return {std::sqrt(squares / n), 1 + sum / n};
}

}  // namespace

std::vector<ReceiverPoint> receiver_points(const Scene& scene, const GalleryScene& gallery,
                                           double radius) {
    std::vector<ReceiverPoint> points;
    for (const KnownPoint& known : gallery.points)
        points.push_back(receiver_at(scene, known, points.size(), radius));
    return points;
}

std::vector<Estimate> answers(const PointEstimator& method, const GalleryScene& gallery,
                              const std::vector<ReceiverPoint>& points, QueryContext& context) {
    std::vector<Estimate> found(points.size());
    if (gallery.points.front().wo.isZero(0))
        method.irradiance(points, found, context);
    else
        method.radiance(points, found, context);
    return found;
}

double SeriesOutcome::fall() const {
    return std::pow(errors.front() / errors.back(), 1.0 / static_cast<double>(errors.size() - 1));
}

bool SeriesOutcome::is_small_enough() const { return errors.back() <= tolerance; }

bool SeriesOutcome::is_balanced() const {
    return std::abs(mean - 1) <= 0.005 + 4 * errors.back() / std::sqrt(static_cast<double>(points));
}

bool SeriesOutcome::falls_fast_enough() const {
    return errors.back() <= rounding || fall() >= std::pow(factor, 0.7);
}

bool SeriesOutcome::holds() const {
    return !refusal.empty() || (is_small_enough() && is_balanced() && falls_fast_enough());
}

SeriesOutcome run_series(const GalleryScene& scene, const Series& series,
                         const RunOptions& options) {
    SeriesOutcome outcome;
    outcome.scene = scene.name;
    outcome.method = series.method + (series.indirect ? ", indirect" : "") +
                     (series.variant.empty() ? "" : ", " + series.variant);
    outcome.factor = series.factor;
    outcome.tolerance = series.tolerance;
    outcome.points = scene.points.size();
    try {
        for (const Effort& effort : series.efforts) {
            const Score found = score(scene, series, effort, options);
            outcome.errors.push_back(found.error);
            outcome.mean = found.mean;
        }
    } catch (const UnsupportedScene& refused) {
        outcome.refusal = refused.what();
    }
    return outcome;
}

std::string gallery_table(const std::vector<GalleryScene>& scenes,
                          const std::vector<SeriesOutcome>& outcomes) {
    std::string text =
        "| scene | truth | method | error at growing effort | tolerance | falls by | expected | "
        "mean | |\n"
        "|---|---|---|---|---|---|---|---|---|\n";
    for (const GalleryScene& scene : scenes)
        for (const SeriesOutcome& each : outcomes) {
            if (each.scene != scene.name) continue;
            text += fmt::format("| {} | {} | {} | ", scene.name, scene.answer, each.method);
            if (!each.refusal.empty()) {
                text += fmt::format("– | – | – | – | – | cannot serve it: {} |\n", each.refusal);
                continue;
            }
            std::vector<std::string> errors;
            for (const double error : each.errors) errors.push_back(fmt::format("{:.2g}", error));
            text += fmt::format("{} | {:.2g} | {} | {:.3g} | {:.4f} | {} |\n",
                                fmt::join(errors, ", "), each.tolerance,
                                each.errors.back() <= SeriesOutcome::rounding
                                    ? std::string("to rounding")
                                    : fmt::format("{:.2f}", each.fall()),
                                each.factor, each.mean,
                                !each.is_small_enough()     ? "**too large**"
                                : !each.is_balanced()       ? "**mean is off**"
                                : !each.falls_fast_enough() ? "**falls too slowly**"
                                                            : "holds");
        }
    return text;
}

}  // namespace caustics::experiments
