#include "experiments/run/probe.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/math/coordinate_limit.h"
#include "experiments/run/counted_rays.h"
#include "experiments/run/mesh_notes.h"
#include "experiments/run/notes.h"

namespace caustics::experiments {

namespace {

constexpr float receiver_tolerance = 1e-4F;  // of the scene's diameter
constexpr std::size_t points_per_batch = 64;

[[noreturn]] void fail_at(const ProbeList& list, std::size_t row, const std::string& reason) {
    throw InputError(fmt::format("{}: row {}: {}", list.file.string(), row + 1, reason));
}

Vec3d vector_at(const ProbeList& list, std::size_t row, const std::array<const char*, 3>& names) {
    Vec3d v;
    for (int i = 0; i < 3; ++i)
        v[i] = list.table.rows[row][list.table.column(names[static_cast<std::size_t>(i)])];
    return v;
}

Vec3 direction_at(const ProbeList& list, std::size_t row, const std::array<const char*, 3>& names,
                  const char* what) {
    const Vec3d v = vector_at(list, row, names);
    if (!(v.norm() > 0)) fail_at(list, row, fmt::format("the {} is zero", what));
    return v.normalized().cast<float>();
}

/// The first receiver along a short ray, passing through casters.
std::optional<SurfacePoint> receiver_along(const Scene& scene, Ray ray, const Vec3& target) {
    for (int casters = 0; casters < 16; ++casters) {
        const std::optional<SurfacePoint> hit = scene.intersect(ray);
        if (!hit) return {};
        if (is_receiver(scene.shape_at(*hit).bsdf)) {
            SurfacePoint found = *hit;
            found.distance = (found.position - target).norm();
            return found;
        }
        ray.origin =
            offset_origin({hit->position, hit->geometric_normal, hit->offset}, ray.direction);
        ray.max_distance -= hit->distance;
        if (!(ray.max_distance > 0)) return {};
    }
    return {};
}

/// The receiver within the tolerance of a point: across the surface first, where a point near an
/// edge belongs to the face its normal names, then along the axes.
std::optional<SurfacePoint> find_receiver(const Scene& scene, const ProbePoint& point) {
    const float tolerance = receiver_tolerance * scene.diameter();
    const Vec3 position = Vec3d(point.position - scene.origin()).cast<float>();
    const auto nearest_along = [&](const std::vector<Vec3>& lines) {
        std::optional<SurfacePoint> nearest;
        for (const Vec3& line : lines)
            for (const float sign : {1.0F, -1.0F}) {
                const Vec3 direction = sign * line;
                const Ray ray{position - tolerance * direction, direction, 2 * tolerance};
                const std::optional<SurfacePoint> hit = receiver_along(scene, ray, position);
                if (hit && (!nearest || hit->distance < nearest->distance)) nearest = hit;
            }
        return nearest;
    };
    std::optional<SurfacePoint> found = nearest_along({point.normal});
    if (!found) found = nearest_along({Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()});
    return found;
}

/// The points a method is asked at, and the rows they belong to; rows on black sides are left out.
struct Questions {
    std::vector<ReceiverPoint> points;
    std::vector<std::size_t> rows;
};

template <class Estimator>
Questions questions(const Scene& scene, const MethodOf<Estimator>& method, const ProbeList& list) {
    // Methods that gather over a disc round each point need its radius.
    const bool needs_radius =
        method.facts().gathers_over_discs && method.configured->disc_radius() == 0;
    Questions asked;
    for (std::size_t row = 0; row < list.points.size(); ++row) {
        const ProbePoint& point = list.points[row];
        if (needs_radius && point.radius == 0)
            fail_at(
                list, row,
                fmt::format(
                    "{} gathers over a disc round the point: give a column radius or {} "
                    "radius=metres",
                    method.name,
                    std::is_same_v<Estimator, CausticEstimator> ? "--param" : "--indirect-param"));
        const std::optional<SurfacePoint> surface = find_receiver(scene, point);
        if (!surface)
            fail_at(
                list, row,
                fmt::format("the point ({}, {}, {}) is farther than 1e-4 of the scene's diameter "
                            "({} m) from every receiver",
                            point.position.x(), point.position.y(), point.position.z(),
                            receiver_tolerance * scene.diameter()));
        std::optional<ReceiverPoint> receiver = receiver_point(scene, *surface, point.normal);
        if (!receiver) continue;
        receiver->wo = point.wo;
        receiver->id = row;
        receiver->radius = point.radius;
        receiver->medium =
            scene.medium_before({receiver->position, receiver->geometric_normal, receiver->offset});
        asked.points.push_back(*receiver);
        asked.rows.push_back(row);
    }
    return asked;
}

using Query = void (PointEstimator::*)(std::span<const ReceiverPoint>, std::span<Estimate>,
                                       QueryContext&) const;

/// A built method and the points it is asked at.
struct Ask {
    const PointEstimator& method;
    const Questions& asked;
    bool at_once;  ///< all points in one batch, on the method's own threads
    int threads;

    /// Adds the answers to those of the points' rows.
    void add(Query query, std::vector<Estimate>& rows) const {
        std::vector<Estimate> answers(asked.points.size());
        const std::size_t batch =
            at_once ? std::max<std::size_t>(answers.size(), 1) : points_per_batch;
        const int workers = at_once ? 1 : threads;
        std::vector<std::unique_ptr<QueryContext>> contexts;
        for (int i = 0; i < workers; ++i) contexts.push_back(method.make_context());
        const std::size_t batches = (answers.size() + batch - 1) / batch;
        parallel_for(workers, batches, [&](std::size_t index, std::size_t worker) {
            const std::size_t first = index * batch;
            const std::size_t count = std::min(batch, answers.size() - first);
            (method.*query)(std::span(asked.points).subspan(first, count),
                            std::span(answers).subspan(first, count), *contexts[worker]);
        });
        for (std::size_t i = 0; i < answers.size(); ++i) {
            rows[asked.rows[i]].value += answers[i].value;
            rows[asked.rows[i]].standard_error += answers[i].standard_error;
        }
    }
};

void append_colour(std::string& line, const Spectrum& value) {
    for (int c = 0; c < 3; ++c) line += ',' + shortest(value[c]);
}

void require_finite_answers(const ProbeList& list, const std::vector<Estimate>& answers) {
    for (std::size_t row = 0; row < answers.size(); ++row)
        if (!is_finite(answers[row].value) || !is_finite(answers[row].standard_error))
            throw std::runtime_error(fmt::format("{}: row {}: the method's answer is not finite",
                                                 list.file.string(), row + 1));
}

}  // namespace

ProbeList read_probe_list(const std::filesystem::path& file) {
    ProbeList list;
    list.file = file == "-" ? "standard input" : file;
    list.table =
        read_numbers(file, {"x", "y", "z", "nx", "ny", "nz"}, {"wx", "wy", "wz", "radius"});
    const NumberTable& table = list.table;
    const std::size_t none = table.header.size();
    const std::array<bool, 3> viewer = {table.column("wx") != none, table.column("wy") != none,
                                        table.column("wz") != none};
    list.has_viewer = viewer[0];
    if (viewer[1] != viewer[0] || viewer[2] != viewer[0])
        throw InputError(
            fmt::format("{}: give all of the columns wx, wy, wz or none", list.file.string()));
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
        ProbePoint point;
        point.position = vector_at(list, row, {"x", "y", "z"});
        if (!within_limit(point.position))
            fail_at(
                list, row,
                fmt::format("x, y, z reach beyond {:g} m from the origin", farthest_coordinate));
        point.normal = direction_at(list, row, {"nx", "ny", "nz"}, "normal");
        point.wo = list.has_viewer ? direction_at(list, row, {"wx", "wy", "wz"}, "viewer direction")
                                   : point.normal;
        if (!(point.wo.dot(point.normal) > 0))
            fail_at(list, row, "the viewer direction lies below the surface its normal names");
        if (table.column("radius") != none) {
            point.radius = static_cast<float>(table.rows[row][table.column("radius")]);
            if (!(point.radius > 0 && static_cast<double>(point.radius) <= farthest_coordinate))
                fail_at(list, row,
                        fmt::format("the radius must be above 0, and {:g} m at most",
                                    farthest_coordinate));
        }
        list.points.push_back(point);
    }
    return list;
}

namespace {

std::vector<std::string> notes_of_built(const Scene& scene, const Method& method,
                                        const CausticEstimator& built, int threads) {
    const BuildReport report = built.build_report();
    const std::optional<CausticLedger> ledger = caustic_ledger(scene, method, report);
    std::vector<std::string> all = notes(scene, method, report, ledger);
    const auto rays = counted_rays(scene, built, bounce_limit_of(method, report), threads);
    if (rays && ledger) std::ranges::copy(notes_on(*rays, *ledger), std::back_inserter(all));
    return all;
}

/// Whether means over pixels are asked for by name, and not by the method's default.
template <class Estimator>
bool asks_for_pixels(const MethodOf<Estimator>& method) {
    const std::string key = "pixel_footprint";
    nlohmann::json others = describe(method);
    if (!others.value(key, false)) return false;
    others.erase(key);
    const auto usual = method.description->configure(JsonNode::parse_text(others.dump(), key));
    const auto values = usual->values();
    return std::ranges::find(values, std::pair(key, ParameterValue(true))) == values.end();
}

template <class Estimator>
ProbeAnswers probe_by(const Scene& scene, const MethodOf<Estimator>& method, const ProbeList& list,
                      const RunOptions& options) {
    if (asks_for_pixels(method))
        throw InputError(method.facts().name +
                         ": pixel_footprint is of a camera's pixels, and points have none: leave "
                         "it out, or give a footprint in metres");
    const Questions asked = questions(scene, method, list);
    ProbeAnswers answers;
    answers.irradiance.resize(list.points.size());
    if (list.has_viewer) answers.radiance.resize(list.points.size());
    const int passes = method.configured->pass_count();
    for (int pass = 0; pass < passes; ++pass) {
        const auto built = method.configured->build(scene, options, pass);
        answers.has_standard_errors = built->is_statistical();
        if (pass == 0) {
            if constexpr (std::is_same_v<Estimator, CausticEstimator>)
                answers.notes = notes_of_built(scene, method, *built, options.threads);
            else
                answers.notes = notes_on_indirect(scene);
            std::ranges::copy(mesh_notes(scene), std::back_inserter(answers.notes));
            std::ranges::copy(notes_on(scene), std::back_inserter(answers.notes));
        }
        const Ask ask{*built, asked, method.facts().gathers_over_discs, options.threads};
        ask.add(&PointEstimator::irradiance, answers.irradiance);
        if (list.has_viewer) ask.add(&PointEstimator::radiance, answers.radiance);
    }
    for (std::vector<Estimate>* const all : {&answers.irradiance, &answers.radiance}) {
        for (Estimate& mean : *all) mean.value /= static_cast<float>(passes);
        require_finite_answers(list, *all);
    }
    return answers;
}

}  // namespace

ProbeAnswers probe(const Scene& scene, const Method& method, const ProbeList& list,
                   const RunOptions& options) {
    return probe_by(scene, method, list, options);
}

ProbeAnswers probe(const Scene& scene, const IndirectMethod& method, const ProbeList& list,
                   const RunOptions& options) {
    return probe_by(scene, method, list, options);
}

std::string probe_table(const ProbeList& list, const ProbeAnswers& answers) {
    const bool errors = answers.has_standard_errors;
    std::string text =
        fmt::format("{},irradiance_r,irradiance_g,irradiance_b", fmt::join(list.table.header, ","));
    if (list.has_viewer) text += ",radiance_r,radiance_g,radiance_b";
    if (errors) text += ",stderr_r,stderr_g,stderr_b";
    if (errors && list.has_viewer) text += ",stderr_radiance_r,stderr_radiance_g,stderr_radiance_b";
    text += '\n';
    for (std::size_t row = 0; row < list.points.size(); ++row) {
        std::string line = list.table.lines[row];
        append_colour(line, answers.irradiance[row].value);
        if (list.has_viewer) append_colour(line, answers.radiance[row].value);
        if (errors) append_colour(line, answers.irradiance[row].standard_error);
        if (errors && list.has_viewer) append_colour(line, answers.radiance[row].standard_error);
        text += line + '\n';
    }
    return text;
}

}  // namespace caustics::experiments
