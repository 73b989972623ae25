#include "experiments/sweep_summary.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "experiments/progress.h"

namespace caustics {

namespace {

using nlohmann::json;

std::optional<double> number(const json& record, const char* pointer) {
    const json::json_pointer place(pointer);
    if (!record.contains(place) || !record.at(place).is_number()) return {};
    return record.at(place).get<double>();
}

std::string words_of(const json& record) {
    std::string words = record.at("method").at("name").get<std::string>();
    for (const auto& [key, value] : record.at("swept").items())
        words += fmt::format(", {} {}", key,
                             value.is_string() ? value.get<std::string>() : value.dump());
    return words;
}

}  // namespace

void SweepSummary::widen(Range& range, const json& record, const char* pointer) const {
    const std::optional<double> value = number(record, pointer);
    if (!value) return;
    range.low = std::min(range.low, *value);
    range.high = std::max(range.high, *value);
}

void SweepSummary::add(const json& record) {
    ++statuses_[record.at("status").get<std::string>()];
    widen(seconds_, record, "/seconds/total/wall");
    widen(memory_, record, "/memory/peak_rss_bytes");
    widen(reference_error_, record, "/reference/stderr");
    if (record.at("method").at("name") != "none") widen(energy_, record, "/metrics/mean_ratio");
    const std::optional<double> rmse = number(record, "/metrics/rmse");
    if (!rmse) return;
    Best& best = best_of_scene_[record.at("scene").at("name").get<std::string>()];
    if (*rmse < best.rmse) best = {*rmse, words_of(record)};
}

std::string SweepSummary::Range::text() const {
    return low > high ? "-" : fmt::format("{:.4g} to {:.4g}", low, high);
}

std::string SweepSummary::statuses_text() const {
    std::vector<std::string> parts;
    for (const auto& [status, count] : statuses_)
        parts.push_back(fmt::format("{} {}", count, status));
    return parts.empty() ? "none" : fmt::format("{}", fmt::join(parts, ", "));
}

/// "scene 0.0123 (photonmap, photons 10000, nearest 50)" for the lowest error of each scene.
std::string SweepSummary::best_text() const {
    std::vector<std::string> parts;
    for (const auto& [scene, best] : best_of_scene_)
        parts.push_back(fmt::format("{} {:.4g} ({})", scene, best.rmse, best.words));
    return parts.empty() ? "-" : fmt::format("{}", fmt::join(parts, "; "));
}

std::string SweepSummary::text(std::size_t planned, std::size_t ran, double seconds) const {
    return fmt::format(
        "trials     {} planned: {}; {} run now in {}\n"
        "best RMSE  {}\n"
        "energy     mean(caustic) / mean(reference) from {}\n"
        "time       a trial takes {} s, peak memory {} bytes\n"
        "references standard error a pixel {} of the mean\n",
        planned, statuses_text(), ran, clock_text(seconds), best_text(), energy_.text(),
        seconds_.text(), memory_.text(), reference_error_.text());
}

}  // namespace caustics
