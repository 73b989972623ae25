#include "experiments/sweep_summary.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "experiments/progress.h"

namespace caustics {

std::string SweepSummary::words_of(const TableRow& row) const {
    std::string words = row.text("method");
    for (const std::string& key : swept_)
        if (const std::string& value = row.text(key); !value.empty())
            words += fmt::format(", {} {}", key, value);
    return words;
}

void SweepSummary::Range::take_in(std::optional<double> value) {
    if (!value) return;
    low = std::min(low, *value);
    high = std::max(high, *value);
}

void SweepSummary::add(const TableRow& row) {
    ++statuses_[row.text("status")];
    seconds_.take_in(row.number("total_s"));
    memory_.take_in(row.number("peak_rss_bytes"));
    reference_error_.take_in(row.number("reference_stderr"));
    if (row.text("method") != "none") energy_.take_in(row.number("mean_ratio"));
    const std::optional<double> rmse = row.number("rmse");
    if (!rmse) return;
    Best& best = best_of_scene_[row.text("scene")];
    if (*rmse < best.rmse) best = {*rmse, words_of(row)};
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
