#include "experiments/sweep_outputs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/error.h"
#include "experiments/csv.h"
#include "experiments/files.h"
#include "experiments/metrics.h"
#include "experiments/pictures.h"
#include "experiments/progress.h"
#include "experiments/record.h"

namespace caustics {

namespace {

using nlohmann::json;
namespace fs = std::filesystem;

bool is_done(const json& record) { return record.value("status", "") == "done"; }

std::optional<double> number(const json& record, const char* pointer) {
    const json::json_pointer place(pointer);
    if (!record.contains(place) || !record.at(place).is_number()) return {};
    return record.at(place).get<double>();
}

/// Mean over reached pixels and channels of the sample variance over the pictures.
std::optional<double> mean_variance(const std::vector<Film>& films) {
    if (films.size() < 2) return {};
    PixelMask reached = reached_pixels(films[0], films[0]);
    double sum = 0;
    std::size_t values = 0;
    for (std::size_t i = 0; i < reached.size(); ++i) {
        if (!reached[i]) continue;
        SpectrumSum mean = SpectrumSum::Zero();
        SpectrumSum squares = SpectrumSum::Zero();
        for (const Film& film : films) mean += film.rgb("caustic", i).cast<double>();
        mean /= static_cast<double>(films.size());
        for (const Film& film : films) {
            const SpectrumSum difference = film.rgb("caustic", i).cast<double>() - mean;
            squares += difference.square();
        }
        sum += squares.sum() / static_cast<double>(films.size() - 1);
        values += 3;
    }
    if (values == 0) return {};
    return sum / static_cast<double>(values);
}

/// Of each cell with several seeds; repeats show the same picture again and are left out.
std::map<std::string, double> variances(const SweepPlan& plan, const JobStore& store,
                                        const std::map<std::string, json>& records) {
    std::map<std::string, std::map<std::uint64_t, std::string>> cells;
    for (const Trial& trial : plan.trials) {
        const auto record = records.find(trial.id);
        if (record != records.end() && is_done(record->second))
            cells[trial.cell].emplace(trial.request.seed, trial.id);
    }
    std::map<std::string, double> result;
    for (const auto& [cell, seeds] : cells) {
        if (seeds.size() < 2) continue;
        std::vector<Film> films;
        for (const auto& [seed, id] : seeds) films.push_back(read_exr(store.image_of(id)));
        if (const auto variance = mean_variance(films)) result[cell] = *variance;
    }
    return result;
}

std::map<std::string, json> by_id(const std::vector<json>& records) {
    std::map<std::string, json> all;
    for (const json& record : records) all[record.at("trial").get<std::string>()] = record;
    return all;
}

/// "scene 0.0123 (photonmap, photons 10000, nearest 50)" for the lowest error of each scene.
std::string best_of_scenes(const std::vector<json>& records) {
    std::map<std::string, const json*> best;
    for (const json& record : records) {
        const std::optional<double> rmse = number(record, "/metrics/rmse");
        if (!rmse) continue;
        const json*& so_far = best[record.at("scene").at("name").get<std::string>()];
        if (so_far == nullptr || *rmse < *number(*so_far, "/metrics/rmse")) so_far = &record;
    }
    std::vector<std::string> parts;
    for (const auto& [scene, record] : best) {
        std::string words = record->at("method").at("name").get<std::string>();
        for (const auto& [key, value] : record->at("swept").items())
            words += fmt::format(", {} {}", key,
                                 value.is_string() ? value.get<std::string>() : value.dump());
        parts.push_back(
            fmt::format("{} {:.4g} ({})", scene, *number(*record, "/metrics/rmse"), words));
    }
    return parts.empty() ? "-" : fmt::format("{}", fmt::join(parts, "; "));
}

/// The records of methods that make a caustic.
std::vector<json> with_caustic(const std::vector<json>& records) {
    std::vector<json> all;
    for (const json& record : records)
        if (record.at("method").at("name") != "none") all.push_back(record);
    return all;
}

/// "0.98 to 1.02", or "-" when no record has the number.
std::string range_of(const std::vector<json>& records, const char* pointer) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const json& record : records)
        if (const std::optional<double> value = number(record, pointer)) {
            low = std::min(low, *value);
            high = std::max(high, *value);
        }
    return low > high ? "-" : fmt::format("{:.4g} to {:.4g}", low, high);
}

}  // namespace

void write_records_csv(const SweepPlan& plan, const JobStore& store,
                       const std::vector<json>& records, const fs::path& file) {
    const std::map<std::string, json> known = by_id(records);
    const std::map<std::string, double> variance = variances(plan, store, known);
    const std::vector<std::string> columns = record_columns(plan.swept);
    std::string text = csv_line(columns);
    for (const Trial& trial : plan.trials) {
        const auto found = known.find(trial.id);
        if (found == known.end()) continue;
        json record = found->second;
        const auto of_cell = variance.find(trial.cell);
        if (of_cell != variance.end() && is_done(record)) record["variance"] = of_cell->second;
        text += csv_line(record_row(record, columns));
    }
    write_whole_file(file, text);
}

void write_figures(const SweepPlan& plan, const JobStore& store, const std::vector<json>& records,
                   const std::set<std::string>& fresh, ReferenceCache& references,
                   const RunOptions& options, const fs::path& folder) {
    const std::map<std::string, json> known = by_id(records);
    std::set<std::string> cells;
    for (const Trial& trial : plan.trials) {
        const auto record = known.find(trial.id);
        if (!trial.reference || record == known.end() || !is_done(record->second)) continue;
        if (!cells.insert(trial.cell).second) continue;
        const fs::path file = folder / (trial.id + ".png");
        if (fs::exists(file) && !fresh.contains(trial.id)) continue;
        const auto reference = references.get(*trial.reference, options);
        write_png(strip(read_exr(store.image_of(trial.id)), reference->film, "caustic"), file);
    }
}

std::string summary(const std::vector<json>& records, std::size_t planned, std::size_t ran,
                    double seconds) {
    std::map<std::string, std::size_t> statuses;
    for (const json& record : records) ++statuses[record.at("status").get<std::string>()];
    std::string counts;
    for (const auto& [status, count] : statuses)
        counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", count, status);
    return fmt::format(
        "trials     {} planned: {}; {} run now in {}\n"
        "best RMSE  {}\n"
        "energy     mean(caustic) / mean(reference) from {}\n"
        "time       a trial takes {} s, peak memory {} bytes\n"
        "references standard error a pixel {} of the mean\n",
        planned, counts.empty() ? "none" : counts, ran, clock_text(seconds),
        best_of_scenes(records), range_of(with_caustic(records), "/metrics/mean_ratio"),
        range_of(records, "/seconds/total/wall"), range_of(records, "/memory/peak_rss_bytes"),
        range_of(records, "/reference/stderr"));
}

}  // namespace caustics
